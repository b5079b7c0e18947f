#include "io/codec/soft_codec.h"

#include "io/codec/array_codec.h"
#include "io/codec/command_codec.h"
#include "soft/store/soft_builder.h"
#include "soft/store/soft_damage.h"

namespace gyre {

namespace {

// The arrays of particles are as long as those that were built, or empty where they may be.
bool fits(const SoftEntry& entry) {
  const std::size_t rows = entry.body.particles.mass.size();
  const Particles& p = entry.body.particles;
  bool good = true;
  for (const Array<double>* column : {&p.x, &p.y, &p.z}) good = good && column->size() == rows;
  for (const Array<float>* column : {&p.vx, &p.vy, &p.vz}) good = good && column->size() == rows;
  for (const Array<float>& column : entry.body.pull) good = good && (column.empty() || column.size() == rows);
  for (const Array<double>& column : entry.body.moved)
    good = good && (column.empty() || column.size() == rows);
  return good && entry.rest.size() == 1 &&
         entry.body.chain.tension.size() == entry.body.chain.rest_length.size();
}

}  // namespace

void write_soft(ByteWriter& out, const SoftStore& soft) {
  out.put_all(soft.ids.generations());
  soft.for_each([&](const SoftEntry& entry) {
    write_soft_def(out, *entry.def);
    for_each_damage_array(entry, [&](const auto& array) { write_array(out, array); });
    for_each_soft_array(entry, [&](const auto& array) { write_array(out, array); });
  });
  // By slot, up to the last part that one of them has.
  int parts = 0;
  soft.for_each([&](const SoftEntry& entry) {
    parts = max(parts, has_rare_state(entry) ? 1 : 0);
    parts = max(parts, entry.faces.empty() ? 0 : 2);
    parts = max(parts, entry.points.empty() ? 0 : 3);
  });
  soft.for_each([&](const SoftEntry& entry) {
    if (parts >= 1) for_each_rare_array(entry, [&](const auto& array) { write_array(out, array); });
  });
  soft.for_each([&](const SoftEntry& entry) {
    if (parts >= 2) write_array(out, entry.faces);
  });
  soft.for_each([&](const SoftEntry& entry) {
    if (parts >= 3) write_array(out, entry.points);
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
    for_each_damage_array(entry, [&](auto& array) { good = good && read_array(in, array); });
    if (!good || !rebuild_damaged(entry)) return false;
    for_each_soft_array(entry, [&](auto& array) { good = good && read_array(in, array); });
    if (!good || !fits(entry)) return false;
  }
  bool good = true;
  if (in.left() == 0) return good;
  soft.for_each([&](SoftEntry& entry) {
    for_each_rare_array(entry, [&](auto& array) { good = good && read_array(in, array); });
  });
  if (!good || in.left() == 0) return good;
  soft.for_each([&](SoftEntry& entry) { good = good && read_array(in, entry.faces); });
  if (!good || in.left() == 0) return good;
  soft.for_each([&](SoftEntry& entry) { good = good && read_array(in, entry.points); });
  return good;
}

}  // namespace gyre
