// How a call crosses from JavaScript: arguments and results are rows of doubles in two buffers, so that nothing is allocated
// per call and no object has to be freed. Call reads the arguments, Answer writes the results.
//
// Numbers, booleans and enumerators are one double each. Vectors and quaternions are their parts in a row. An id is one whole
// number, index + 2^32 (generation + 2^16 (world mod 32)), exact in a double; 0 is null. 64-bit numbers are two doubles, the low
// and the high half. A struct is a set of bits, which of its fields were given, and then those; the others keep the defaults
// that C++ gives them. A list is its length and its elements. Bytes are an address and a length; the callee frees them.
//
// Results go the same way, without the bits. Arrays are a length and the address of each column: of the engine's own memory where
// that has the form of a typed array already, else of a copy that is kept until the next call of the same function.
#pragma once

#include <gyre/gyre.h>

#include <array>
#include <cstddef>
#include <cstring>
#include <deque>
#include <memory>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

namespace gyre::web {

struct WorldHost;

// Columns that were copied for one function, and a table that it keeps.
struct Store {
  std::deque<std::vector<double>> blocks;
  std::size_t used = 0;
  std::shared_ptr<void> kept;

  void* take(std::size_t bytes) {
    if (used == blocks.size()) blocks.emplace_back();
    std::vector<double>& block = blocks[used++];
    if (block.size() * sizeof(double) < bytes) block.resize((bytes + sizeof(double) - 1) / sizeof(double));
    return block.data();
  }
};

// What JavaScript holds a handle of.
struct Host {
  virtual ~Host() = default;
  std::uint16_t world_number = 0;  // of the ids that it gave out
  std::unique_ptr<WorldHost> borrowed;  // the world of a replay
  std::vector<std::unique_ptr<Store>> stores;  // by function
};
template <class T>
struct ObjectHost : Host {
  explicit ObjectHost(T object) : value(std::move(object)) {}
  T value;
};
// A world, whoever owns it: itself, a scene or a replay.
struct WorldHost : Host {
  virtual World& world() = 0;
  std::unique_ptr<Host> recorder;  // goes before the world does
};

// The object behind a handle.
template <class T>
T& object(Host* host) {
  if constexpr (std::is_same_v<T, World>) {
    return static_cast<WorldHost*>(host)->world();
  } else {
    return static_cast<ObjectHost<T>*>(host)->value;
  }
}

Host* find_host(double handle);
std::uint16_t world_number_of(int low_bits);
void remember_world_number(std::uint16_t number);

// ---------------------------------------------------------------------------------------------------------- arguments

class Call {
 public:
  explicit Call(Host* host);
  ~Call();
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;

  double next() { return *at_++; }
  bool given() { return next() != 0.0; }
  std::span<const std::byte> bytes();  // valid until the call ends
  template <class T>
  T& object() {
    return web::object<T>(find_host(next()));
  }
  // An array that lives until the call ends.
  template <class T>
  std::span<T> array(std::size_t count) {
    auto kept = std::make_shared<std::vector<T>>(count);
    arrays_.push_back(kept);
    return {kept->data(), count};
  }
  Host* host() const { return host_; }

 private:
  Host* host_;
  const double* at_;
  std::vector<std::shared_ptr<void>> arrays_;
  std::vector<void*> bytes_;
};

// Which fields of a struct were given.
class Given {
 public:
  explicit Given(Call& call) : bits_(static_cast<std::uint64_t>(call.next())) {}
  bool operator[](int field) const { return (bits_ >> field & 1) != 0; }

 private:
  std::uint64_t bits_;
};

template <class T>
  requires(std::is_arithmetic_v<T> || std::is_enum_v<T>)
void get(Call& call, T& out) {
  if constexpr (std::is_same_v<T, bool>) {
    out = call.next() != 0.0;
  } else {
    out = static_cast<T>(call.next());
  }
}
inline void get_long(Call& call, std::uint64_t& out) {
  const double low = call.next();
  out = static_cast<std::uint64_t>(low) | static_cast<std::uint64_t>(call.next()) << 32;
}
template <class Tag>
void get(Call& call, Id<Tag>& out) {
  const std::uint64_t bits = static_cast<std::uint64_t>(call.next());
  out.index = static_cast<std::uint32_t>(bits);
  out.generation = static_cast<std::uint16_t>(bits >> 32);
  const int low = static_cast<int>(bits >> 48) & 31;
  const std::uint16_t own = call.host() != nullptr ? call.host()->world_number : std::uint16_t(0);
  out.world = own != 0 && (own & 31) == low ? own : world_number_of(low);
  if (out.generation == 0) out = {};
}
inline void get(Call& call, Vec3& out) { get(call, out.x), get(call, out.y), get(call, out.z); }
inline void get(Call& call, DVec3& out) { get(call, out.x), get(call, out.y), get(call, out.z); }
inline void get(Call& call, Quat& out) { get(call, out.x), get(call, out.y), get(call, out.z), get(call, out.w); }
inline void get(Call& call, Sym3& out) {
  get(call, out.xx), get(call, out.yy), get(call, out.zz), get(call, out.xy), get(call, out.xz), get(call, out.yz);
}
inline void get(Call& call, Mat3& out) { get(call, out.x), get(call, out.y), get(call, out.z); }
inline void get(Call& call, Geometry& out) {
  Host* const host = find_host(call.next());
  out = host != nullptr ? object<Geometry>(host) : Geometry();
}
inline void get(Call& call, std::span<const std::byte>& out) { out = call.bytes(); }
inline void get(Call& call, std::vector<std::byte>& out) {
  const std::span<const std::byte> bytes = call.bytes();
  out.assign(bytes.begin(), bytes.end());
}
inline void get(Call& call, std::string_view& out) {
  const std::span<const std::byte> bytes = call.bytes();
  out = {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}
template <class T, std::size_t N>
void get(Call& call, T (&out)[N]) {
  for (T& part : out) get(call, part);
}
template <class T, std::size_t N>
void get(Call& call, std::array<T, N>& out) {
  for (T& part : out) get(call, part);
}
template <class T>
void get_optional(Call& call, std::optional<T>& out) {
  T value{};
  get(call, value);
  out = value;
}
template <class T>
void get(Call& call, std::span<const T>& out) {
  const std::span<T> rows = call.array<T>(static_cast<std::size_t>(call.next()));
  for (T& row : rows) get(call, row);
  out = rows;
}

template <class T>
void get(Call& call, std::vector<T>& out) {
  out.resize(static_cast<std::size_t>(call.next()));
  for (T& row : out) get(call, row);
}

// ------------------------------------------------------------------------------------------------------------ results

double handle_of(std::uint32_t index, std::uint16_t generation, std::uint16_t world);

class Answer {
 public:
  // `function` is its number among all functions.
  Answer(Host* host, int function);

  void number(double value);
  void pointer(const void* memory) { number(double(reinterpret_cast<std::uintptr_t>(memory))); }
  void bytes(std::vector<std::byte> bytes);  // kept until the next bytes
  void text(const char* begin, std::size_t size) { pointer(begin), number(double(size)); }
  // A copied column of so many bytes.
  void* column(std::size_t bytes) { return store_->take(bytes); }
  // A T of this function and host that lives on between calls.
  template <class T>
  T& kept() {
    if (store_->kept == nullptr) store_->kept = std::make_shared<T>();
    return *static_cast<T*>(store_->kept.get());
  }
  template <class T>
  const T& keep(T value) {
    return kept<T>() = std::move(value);
  }
  void saw_world(std::uint16_t number);

  // The answer's address, or 0: then error() tells why.
  int done();
  int checked(const Error& error);
  template <class Value>
  int command(World& world, Value value) {
    return value ? (give(value), done()) : refused(world);
  }
  template <class T>
  int made(T value) {
    pointer(make_host(std::move(value)));
    return done();
  }
  template <class T>
  int made_or_refused(Result<T> result) {
    return result ? made(*std::move(result)) : checked(result.error());
  }
  void borrowed(World& world);

  template <class T>
  static Host* make_host(T value) {
    return new ObjectHost<T>(std::move(value));
  }
  static Host* make_host(World world);

 private:
  static void give(bool) {}
  template <class Tag>
  void give(Id<Tag> id) {
    saw_world(id.world);
    number(handle_of(id.index, id.generation, id.world));
  }
  int refused(World& world);

  Host* host_;
  Store* store_;
};

template <class T>
  requires(std::is_arithmetic_v<T> || std::is_enum_v<T>)
void put(Answer& answer, T value) {
  answer.number(static_cast<double>(value));
}
inline void put_long(Answer& answer, std::uint64_t value) {
  answer.number(static_cast<double>(value & 0xffffffffu));
  answer.number(static_cast<double>(value >> 32));
}
template <class Tag>
void put(Answer& answer, Id<Tag> id) {
  answer.saw_world(id.world);
  answer.number(handle_of(id.index, id.generation, id.world));
}
inline void put(Answer& answer, Vec3 v) { put(answer, v.x), put(answer, v.y), put(answer, v.z); }
inline void put(Answer& answer, DVec3 v) { put(answer, v.x), put(answer, v.y), put(answer, v.z); }
inline void put(Answer& answer, Quat q) { put(answer, q.x), put(answer, q.y), put(answer, q.z), put(answer, q.w); }
inline void put(Answer& answer, const Sym3& m) {
  put(answer, m.xx), put(answer, m.yy), put(answer, m.zz), put(answer, m.xy), put(answer, m.xz), put(answer, m.yz);
}
inline void put(Answer& answer, const Mat3& m) { put(answer, m.x), put(answer, m.y), put(answer, m.z); }
inline void put(Answer& answer, const Mat4& m) {
  for (const float element : m.elements) put(answer, element);
}
inline void put(Answer& answer, const Geometry& geometry) {
  answer.pointer(geometry ? Answer::make_host(geometry) : nullptr);
  answer.number(geometry ? double(geometry.kind()) : 0.0);
}
template <class T>
void put(Answer& answer, const std::optional<T>& value) {
  answer.number(value.has_value());
  if (value) put(answer, *value);
}
inline void put_text(Answer& answer, const char* text) {
  answer.text(text, text != nullptr ? std::strlen(text) : 0);
}
inline void put_text(Answer& answer, std::string_view text) { answer.text(text.data(), text.size()); }

// How a column looks in JavaScript: its element, and how many of them a row has.
template <class T>
struct Column {
  static constexpr bool kAsItIs = false;
};
template <class T>
  requires(std::is_arithmetic_v<T> && sizeof(T) <= 8 && !std::is_same_v<T, std::uint64_t>)
struct Column<T> {
  using Element = T;
  static constexpr bool kAsItIs = true;
};
template <class T>
  requires(std::is_enum_v<T> && sizeof(T) == 1)
struct Column<T> {
  using Element = std::uint8_t;
  static constexpr bool kAsItIs = true;
};
template <class T, std::size_t N>
struct Column<std::array<T, N>> : Column<T> {};
template <>
struct Column<Vec3> {
  using Element = float;
  static constexpr bool kAsItIs = true;
};
template <>
struct Column<Quat> : Column<Vec3> {};
template <>
struct Column<Sym3> : Column<Vec3> {};
template <>
struct Column<DVec3> {
  using Element = double;
  static constexpr bool kAsItIs = true;
};
static_assert(sizeof(Vec3) == 12 && sizeof(Quat) == 16 && sizeof(Sym3) == 24 && sizeof(DVec3) == 24);

template <class Tag>
double column_value(Answer& answer, Id<Tag> id) {
  answer.saw_world(id.world);
  return handle_of(id.index, id.generation, id.world);
}
// The largest stands for "none".
inline double column_value(Answer&, std::uint64_t count) {
  return count == UINT64_MAX ? __builtin_inf() : double(count);
}

template <class Row, class Member>
void put_column(Answer& answer, std::span<const Row> rows, Member member) {
  using Value = std::remove_cvref_t<decltype(member(rows[0]))>;
  if constexpr (std::is_array_v<Value> || Column<Value>::kAsItIs) {
    std::byte* to = static_cast<std::byte*>(answer.column(rows.size() * sizeof(Value)));
    answer.pointer(to);
    for (const Row& row : rows) {
      std::memcpy(to, &member(row), sizeof(Value));
      to += sizeof(Value);
    }
  } else {
    double* to = static_cast<double*>(answer.column(rows.size() * sizeof(double)));
    answer.pointer(to);
    for (const Row& row : rows) *to++ = column_value(answer, member(row));
  }
}

// An array of values, without a struct around them. Of poses: two columns.
template <class T, std::size_t N>
void put_array(Answer& answer, std::span<T, N> values) {
  using Value = std::remove_const_t<T>;
  const std::span<const Value> rows(values.data(), values.size());
  answer.number(double(rows.size()));
  if constexpr (Column<Value>::kAsItIs) {
    answer.pointer(rows.data());
  } else {
    put_column(answer, rows, [](const Value& row) -> const Value& { return row; });
  }
}

template <class T, class Put>
void put_list(Answer& answer, std::span<const T> values, Put put_one) {
  answer.number(double(values.size()));
  for (const T& value : values) put_one(value);
}

}  // namespace gyre::web
