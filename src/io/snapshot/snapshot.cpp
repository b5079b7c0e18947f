// Saves and loads snapshots. See snapshot.h for the format.
#include "io/snapshot/snapshot.h"

#include "base/hash.h"
#include "io/codec/record_codec.h"
#include "io/codec/fluid_codec.h"
#include "io/codec/soft_codec.h"
#include "world/world_access.h"

#include <gyre/replay.h>

#include <cstring>
#include <string_view>

namespace gyre {

namespace {

constexpr char kSnapshotMagic[9] = "GYRESNAP";
constexpr std::size_t kSnapshotHeaderBytes = 8 + 4 + 4 + 8 + 8;
constexpr std::size_t kBodyLengthOffset = 16;
constexpr std::size_t kBodyChecksumOffset = 24;

Error bad_snapshot(const char* what) { return make_error(ErrorCode::invalid_data, "snapshot: %s", what); }

// -------------------------------------------------------------------------------------------------------- the columns

// The layout of each kind of column. Ids are stored as generations; shapes have a layout of their own.
constexpr std::uint64_t kShapeLayout = hash_text("shape 1");

constexpr std::uint64_t kSoftLayout = hash_text("soft 1");
constexpr std::uint64_t kFluidLayout = hash_text("fluid 1");

template <class Column>
struct ColumnLayout {  // a single record
  static RecordLayout get() { return layout_of<Column>(); }
};
template <class T>
struct ColumnLayout<Array<T>> {
  static RecordLayout get() { return layout_of<T>(); }
};
template <IsColumn Column>
struct ColumnLayout<Column> {
  static RecordLayout get() { return layout_of<RecordOf<Column>>(); }
};
template <>
struct ColumnLayout<IdPool> {
  static RecordLayout get() { return layout_of<std::uint32_t>(); }
};
template <>
struct ColumnLayout<std::vector<AnyShape>> {
  static RecordLayout get() { return {1, kShapeLayout}; }
};

template <>
struct ColumnLayout<SoftStore> {
  static RecordLayout get() { return {1, kSoftLayout}; }
};
template <>
struct ColumnLayout<FluidStore> {
  static RecordLayout get() { return {1, kFluidLayout}; }
};

// An empty later column is not written, and a missing one is read as empty, so older snapshots can be read. Soft matter and fluids that were
// removed leave the generations of their ids behind.
template <class Column>
bool is_left_out(const Column& column) {
  if constexpr (std::is_same_v<Column, SoftStore> || std::is_same_v<Column, FluidStore>) {
    return column.entries.empty();
  } else if constexpr (is_later_column<Column>) {
    return column.empty();
  } else {
    return false;
  }
}

class ColumnWriter {
 public:
  explicit ColumnWriter(ByteWriter& out) : out_(out) {}

  template <class Column>
  void operator()(const char* name, const Column& column) {
    if (is_left_out(column)) return;
    const std::string_view text(name);
    out_.put(std::uint8_t(text.size()));
    out_.put_bytes(std::as_bytes(std::span<const char>(text)));
    out_.put(ColumnLayout<Column>::get().hash);
    write(column);
    ++count;
  }
  std::uint32_t count = 0;

 private:
  template <class Record>
  void write_records(std::span<const Record> records) {
    const std::size_t bytes = layout_of<Record>().bytes * records.size();
    out_.put(std::uint64_t(records.size()));
    out_.put(std::uint64_t(bytes));
    std::byte* to = out_.grow(bytes);
    for (const Record& record : records) to = write_record(to, record);
  }
  template <class T>
  void write(const Array<T>& column) {
    write_records(column.view());
  }
  template <IsColumn T>
  void write(const T& column) {
    Array<RecordOf<T>> records;
    records.reserve(column.size());
    for (std::size_t i = 0; i < column.size(); ++i) records.push_back(column[i]);
    write(records);
  }
  void write(const IdPool& ids) { write_records(ids.generations()); }
  void write(const std::vector<AnyShape>& shapes) {
    ByteWriter payload;
    for (const AnyShape& shape : shapes) write_shape(payload, shape);
    out_.put(std::uint64_t(shapes.size()));
    out_.put(std::uint64_t(payload.size()));
    out_.put_bytes(payload.view());
  }
  void write(const SoftStore& soft) {
    ByteWriter payload;
    write_soft(payload, soft);
    out_.put(std::uint64_t(soft.ids.size()));
    out_.put(std::uint64_t(payload.size()));
    out_.put_bytes(payload.view());
  }
  void write(const FluidStore& fluids) {
    ByteWriter payload;
    write_fluids(payload, fluids);
    out_.put(std::uint64_t(fluids.ids.size()));
    out_.put(std::uint64_t(payload.size()));
    out_.put_bytes(payload.view());
  }
  template <class Record>
  void write(const Record& record) {
    write_records(std::span<const Record>(&record, 1));
  }

  ByteWriter& out_;
};

// One column in the bytes.
struct StoredColumn {
  std::string_view name;
  std::uint64_t layout = 0;
  std::uint64_t count = 0;
  std::span<const std::byte> payload;
  bool used = false;
};

Error list_columns(ByteReader& in, std::vector<StoredColumn>& columns) {
  const auto count = in.get<std::uint32_t>();
  constexpr std::uint32_t kMaxColumns = 1024;
  if (in.failed() || count > kMaxColumns) return bad_snapshot("it ends before its columns");
  for (std::uint32_t i = 0; i < count; ++i) {
    StoredColumn column;
    const std::span<const std::byte> name = in.get_bytes(in.get<std::uint8_t>());
    column.name = {reinterpret_cast<const char*>(name.data()), name.size()};
    column.layout = in.get<std::uint64_t>();
    column.count = in.get<std::uint64_t>();
    column.payload = in.get_bytes(in.get<std::uint64_t>());
    if (in.failed()) return bad_snapshot("it ends within a column");
    columns.push_back(column);
  }
  return in.finished() ? Error{} : bad_snapshot("there is more than its columns take");
}

class ColumnReader {
 public:
  ColumnReader(std::vector<StoredColumn>& stored, const GeometryTable& geometry)
      : stored_(stored), geometry_(geometry) {}

  template <class Column>
  void operator()(const char* name, Column& column) {
    if (error_) return;
    StoredColumn* const found = find(name);
    if constexpr (is_later_column<Column>) {
      if (found == nullptr) return column.clear();
    }
    if (found == nullptr) {
      error_ = make_error(ErrorCode::invalid_data, "snapshot: column '%s' is missing", name);
    } else if (found->used) {
      error_ = make_error(ErrorCode::invalid_data, "snapshot: column '%s' is there twice", name);
    } else if (found->layout != ColumnLayout<Column>::get().hash) {
      error_ = make_error(ErrorCode::unsupported,
                          "snapshot: column '%s' has other fields than this version knows", name);
    } else if (!read(*found, column)) {
      error_ = make_error(ErrorCode::invalid_data, "snapshot: column '%s' holds what it cannot", name);
    }
    if (found != nullptr) found->used = true;
  }
  const Error& error() const { return error_; }

 private:
  StoredColumn* find(std::string_view name) {
    StoredColumn* found = nullptr;
    for (StoredColumn& column : stored_) {
      if (column.name != name) continue;
      if (found != nullptr) column.used = found->used = true;  // twice
      found = &column;
    }
    return found;
  }

  template <class Record>
  static bool size_fits(const StoredColumn& stored) {
    const std::size_t bytes = layout_of<Record>().bytes;
    return stored.count <= stored.payload.size() / bytes && stored.count * bytes == stored.payload.size();
  }
  template <class Record>
  static bool read_records(const StoredColumn& stored, std::span<Record> records) {
    const std::size_t bytes = layout_of<Record>().bytes;
    const std::byte* from = stored.payload.data();
    bool good = true;
    for (Record& record : records) {
      good = read_record(from, record) && good;
      from += bytes;
    }
    return good;
  }
  template <class T>
  bool read(const StoredColumn& stored, Array<T>& column) {
    if (!size_fits<T>(stored)) return false;
    column.resize(std::size_t(stored.count));
    return read_records(stored, column.view());
  }
  template <IsColumn T>
  bool read(const StoredColumn& stored, T& column) {
    Array<RecordOf<T>> records;
    if (!read(stored, records)) return false;
    column.resize(records.size());
    for (std::size_t i = 0; i < records.size(); ++i) column.set(i, records[i]);
    return true;
  }
  bool read(const StoredColumn& stored, IdPool& ids) {
    Array<std::uint32_t> generations;
    return read(stored, generations) && ids.restore(generations);
  }
  bool read(const StoredColumn& stored, std::vector<AnyShape>& shapes) {
    ByteReader in(stored.payload);
    if (stored.count > in.left()) return false;
    shapes.resize(std::size_t(stored.count));
    for (AnyShape& shape : shapes) shape = read_shape(in, geometry_);
    return in.finished();
  }
  bool read(const StoredColumn& stored, SoftStore& soft) {
    ByteReader in(stored.payload);
    return read_soft(in, soft) && in.finished() && soft.ids.size() == stored.count;
  }
  bool read(const StoredColumn& stored, FluidStore& fluids) {
    ByteReader in(stored.payload);
    return read_fluids(in, fluids) && in.finished() && fluids.ids.size() == stored.count;
  }
  template <class Record>
  bool read(const StoredColumn& stored, Record& record) {
    return stored.count == 1 && size_fits<Record>(stored) &&
           read_records(stored, std::span<Record>(&record, 1));
  }

  std::vector<StoredColumn>& stored_;
  const GeometryTable& geometry_;
  Error error_;
};

Error read_columns(ByteReader& in, const GeometryTable& geometry, StateColumns& columns) {
  std::vector<StoredColumn> stored;
  const Error e = list_columns(in, stored);
  if (e) return e;
  ColumnReader reader(stored, geometry);
  for_each_column(columns, reader);
  if (reader.error()) return reader.error();
  for (const StoredColumn& column : stored) {
    if (column.used) continue;
    return make_error(ErrorCode::unsupported, "snapshot: column '%.*s' is not known to this version",
                      int(column.name.size()), column.name.data());
  }
  return {};
}

// Bytes of the caller behind a snapshot: a magic word, their number, their hash, and they themselves.
constexpr char kUserMagic[] = "GYREUSER";

bool read_user_bytes(ByteReader& in, std::span<const std::byte>& bytes) {
  const std::span<const std::byte> magic = in.get_bytes(sizeof kUserMagic - 1);
  if (in.failed() || std::memcmp(magic.data(), kUserMagic, magic.size()) != 0) return false;
  const auto count = in.get<std::uint64_t>();
  const auto hash = in.get<std::uint64_t>();
  if (in.failed() || count != in.left()) return false;
  bytes = in.get_bytes(count);
  return !in.failed() && hash_bytes(bytes.data(), bytes.size()) == hash;
}

Error read_header(ByteReader& in, std::span<const std::byte>& body) {
  const std::span<const std::byte> magic = in.get_bytes(sizeof kSnapshotMagic - 1);
  if (in.failed() || std::memcmp(magic.data(), kSnapshotMagic, magic.size()) != 0)
    return bad_snapshot("these bytes are none");
  const auto version = in.get<std::uint32_t>();
  in.get<std::uint32_t>();
  const auto length = in.get<std::uint64_t>();
  const auto checksum = in.get<std::uint64_t>();
  if (in.failed()) return bad_snapshot("it ends within its header");
  if (version != kSnapshotVersion) {
    return make_error(ErrorCode::unsupported, "snapshot: it is of format %u; this version reads format %u",
                      version, kSnapshotVersion);
  }
  if (length > in.left()) return bad_snapshot("it is not as long as it says");
  body = in.get_bytes(length);
  std::span<const std::byte> user_bytes;
  if (in.left() > 0 && !read_user_bytes(in, user_bytes)) return bad_snapshot("it is not as long as it says");
  if (hash_bytes(body.data(), body.size()) != checksum)
    return bad_snapshot("it is damaged: the checksum differs");
  return {};
}

}  // namespace

void collect_geometry(const WorldState& state, GeometryTable& geometry) {
  for (const AnyShape& shape : state.rigid.shapes.geometry) geometry.add(shape);
}

void write_snapshot(ByteWriter& out, const WorldState& state, GeometryTable& geometry) {
  const std::size_t start = out.size();
  out.put_bytes(std::as_bytes(std::span<const char>(kSnapshotMagic, sizeof kSnapshotMagic - 1)));
  out.put(kSnapshotVersion);
  out.put(std::uint32_t(0));
  out.put(std::uint64_t(0));
  out.put(std::uint64_t(0));
  GeometryTable own;
  collect_geometry(state, own);
  for (const Geometry& item : own.items()) geometry.add(item);
  write_geometry_table(out, own);
  const std::size_t count_offset = out.size();
  out.put(std::uint32_t(0));
  ColumnWriter writer(out);
  for_each_column(state, writer);
  out.patch(count_offset, writer.count);
  const std::span<const std::byte> body = out.view().subspan(start + kSnapshotHeaderBytes);
  out.patch(start + kBodyLengthOffset, std::uint64_t(body.size()));
  out.patch(start + kBodyChecksumOffset, hash_bytes(body.data(), body.size()));
}

Error read_snapshot(std::span<const std::byte> bytes, std::uint16_t world_number, GeometryTable& geometry,
                    StateColumns& columns) {
  ByteReader in(bytes);
  std::span<const std::byte> body;
  Error e = read_header(in, body);
  if (e) return e;
  ByteReader content(body);
  e = read_geometry_table(content, geometry);
  if (e.ok()) e = read_columns(content, geometry, columns);
  if (e) return e;
  columns.rigid.world_number = world_number;
  e = rebuild_derived(columns.rigid);
  if (e.ok()) e = check_soft_columns(columns.rigid, columns.soft);
  return e ? e : check_fluid_columns(columns.rigid, columns.fluids);
}

std::uint64_t state_layout() {
  std::uint64_t hash = 0;
  const StateColumns columns;
  for_each_column(columns, [&]<class Column>(const char* name, const Column&) {
    // Soft matter and fluids have their own layouts, which readers compare: recordings without any stay readable when those change.
    // So do sleep speeds and ignored pairs, which are younger than the first recordings.
    if constexpr (std::is_same_v<Column, SoftStore> || std::is_same_v<Column, FluidStore>) return;
    if constexpr (std::is_same_v<Column, Array<SleepSettings>> || std::is_same_v<Column, Array<BodySleepSpeed>> ||
                  std::is_same_v<Column, Array<IgnoredPair>>) {
      return;
    }
    hash = mix_bits(hash + ColumnLayout<Column>::get().hash);
    hash = mix_bits(hash + hash_text(name));
  });
  return hash;
}

void reseal_snapshot(std::span<std::byte> bytes) {
  if (bytes.size() < kSnapshotHeaderBytes) return;
  const std::span<std::byte> body = bytes.subspan(kSnapshotHeaderBytes);
  store_little(bytes.data() + kBodyLengthOffset, std::uint64_t(body.size()));
  store_little(bytes.data() + kBodyChecksumOffset, hash_bytes(body.data(), body.size()));
}

std::vector<std::byte> save_snapshot(const World& world) {
  ByteWriter out;
  GeometryTable geometry;
  write_snapshot(out, state_of(world), geometry);
  return out.take();
}

std::vector<std::byte> save_snapshot_with(const World& world, std::span<const std::byte> user_bytes) {
  ByteWriter out;
  GeometryTable geometry;
  write_snapshot(out, state_of(world), geometry);
  out.put_bytes(std::as_bytes(std::span<const char>(kUserMagic, sizeof kUserMagic - 1)));
  out.put(std::uint64_t(user_bytes.size()));
  out.put(hash_bytes(user_bytes.data(), user_bytes.size()));
  out.put_bytes(user_bytes);
  return out.take();
}

std::vector<std::byte> snapshot_user_bytes(std::span<const std::byte> snapshot) {
  std::span<const std::byte> found;
  if (snapshot.size() < kSnapshotHeaderBytes) return {};
  ByteReader in(snapshot.subspan(kBodyLengthOffset));
  const auto length = in.get<std::uint64_t>();
  const std::span<const std::byte> rest = snapshot.subspan(kSnapshotHeaderBytes);
  if (length >= rest.size()) return {};
  ByteReader behind(rest.subspan(std::size_t(length)));
  if (!read_user_bytes(behind, found)) return {};
  return {found.begin(), found.end()};
}

Result<World> load_snapshot(std::span<const std::byte> bytes, const WorldDef& def) {
  Error e = check_world_def(def);
  if (e) return e;
  std::unique_ptr<WorldState> state = make_world_state(def);
  GeometryTable geometry;
  StateColumns columns;
  e = read_snapshot(bytes, state->number, geometry, columns);
  if (e) return e;
  adopt_columns(*state, std::move(columns));
  return WorldAccess::make(std::move(state));
}

Error restore_snapshot(World& world, std::span<const std::byte> bytes) {
  WorldState& state = state_of(world);
  if (state.stepping) return make_error(ErrorCode::busy, "the world is in the middle of a step");
  GeometryTable geometry;
  collect_geometry(state, geometry);
  StateColumns columns;
  const Error e = read_snapshot(bytes, state.number, geometry, columns);
  if (e.ok()) adopt_columns(state, std::move(columns));
  return e;
}

}  // namespace gyre
