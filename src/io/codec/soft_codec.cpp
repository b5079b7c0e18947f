#include "io/codec/soft_codec.h"

#include "io/codec/command_codec.h"
#include "io/codec/record_codec.h"
#include "soft/store/soft_builder.h"

namespace gyre {

namespace {

template <class T>
void write_array(ByteWriter& out, const Array<T>& array) {
  out.put(std::uint64_t(array.size()));
  std::byte* to = out.grow(layout_of<T>().bytes * array.size());
  for (const T& record : array) to = write_record(to, record);
}

template <class T>
bool read_array(ByteReader& in, Array<T>& array) {
  const std::size_t bytes = layout_of<T>().bytes;
  array.resize(in.get_count(bytes));
  const std::span<const std::byte> data = in.get_bytes(bytes * array.size());
  if (in.failed()) return false;
  bool good = true;
  for (std::size_t i = 0; i < array.size(); ++i) good = read_record(data.data() + i * bytes, array[i]) && good;
  return good;
}

// The arrays of particles are as long as those that were built, or empty where they may be.
bool fits(const SoftEntry& entry) {
  const std::size_t rows = entry.body.particles.mass.size();
  const Particles& p = entry.body.particles;
  bool good = true;
  for (const Array<double>* column : {&p.x, &p.y, &p.z}) good = good && column->size() == rows;
  for (const Array<float>* column : {&p.vx, &p.vy, &p.vz}) good = good && column->size() == rows;
  for (const Array<float>& column : entry.body.pull) good = good && (column.empty() || column.size() == rows);
  for (const Array<double>& column : entry.body.moved) good = good && (column.empty() || column.size() == rows);
  return good && entry.rest.size() == 1 && entry.body.chain.tension.size() == entry.body.chain.rest_length.size();
}

}  // namespace

void write_soft(ByteWriter& out, const SoftStore& soft) {
  out.put_all(soft.ids.generations());
  soft.for_each([&](const SoftEntry& entry) {
    write_soft_def(out, *entry.def);
    for_each_soft_array(entry, [&](const auto& array) { write_array(out, array); });
  });
}

bool read_soft(ByteReader& in, SoftStore& soft) {
  const std::vector<std::uint32_t> generations = in.get_all<std::uint32_t>();
  if (in.failed() || !soft.ids.restore(generations)) return false;
  soft.entries.clear();
  soft.entries.resize(generations.size());
  for (std::uint32_t slot = 0; slot < generations.size(); ++slot) {
    if (!soft.ids.live(slot)) continue;
    std::shared_ptr<const SoftDef> def = read_soft_def(in);
    if (in.failed() || std::visit([](const auto& one) { return check_soft(one); }, *def)) return false;
    SoftEntry& entry = soft.entries[slot] = build_soft(std::move(def));
    bool good = true;
    for_each_soft_array(entry, [&](auto& array) { good = good && read_array(in, array); });
    if (!good || !fits(entry)) return false;
  }
  return true;
}

}  // namespace gyre
