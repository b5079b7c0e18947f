#include "io/codec/fluid_codec.h"

#include "fluid/store/fluid_builder.h"
#include "io/codec/array_codec.h"
#include "io/codec/command_codec.h"

namespace gyre {

void write_fluids(ByteWriter& out, const FluidStore& fluids) {
  out.put_all(fluids.ids.generations());
  fluids.for_each([&](const FluidEntry& entry) {
    write_fluid_def(out, *entry.def);
    for_each_fluid_array(entry, [&](const auto& array) { write_array(out, array); });
  });
  // Later additions stand behind all fluids, and only where there are any.
  bool any = false;
  fluids.for_each([&](const FluidEntry& entry) {
    for_each_later_fluid_array(entry, [&](const auto& array) { any = any || !array.empty(); });
  });
  if (!any) return;
  fluids.for_each([&](const FluidEntry& entry) {
    for_each_later_fluid_array(entry, [&](const auto& array) { write_array(out, array); });
  });
}

bool read_fluids(ByteReader& in, FluidStore& fluids) {
  const std::vector<std::uint32_t> generations = in.get_all<std::uint32_t>();
  if (in.failed() || !fluids.ids.restore(generations)) return false;
  fluids.entries.clear();
  fluids.entries.resize(generations.size());
  for (std::uint32_t slot = 0; slot < generations.size(); ++slot) {
    if (!fluids.ids.live(slot)) continue;
    std::shared_ptr<const FluidDef> def = read_fluid_def(in);
    if (in.failed() || std::visit([](const auto& one) { return check_fluid(one); }, *def)) return false;
    // Each cell has several numbers of four bytes: what claims more cells than there are bytes takes no memory.
    const auto* const gas = std::get_if<GasDef>(def.get());
    const bool is_adaptive = gas != nullptr && gas->adaptive_domain.has_value();
    if (!is_adaptive && std::size_t(count_cells(*def)) > in.left()) return false;
    FluidEntry& entry = fluids.entries[slot] = build_fluid(std::move(def), FluidStart::rest);
    bool good = true;
    for_each_fluid_array(entry, [&](auto& array) { good = good && read_array(in, array); });
    if (!good || !restore_window(entry) || !fits_definition(entry)) return false;
  }
  if (in.left() == 0) return true;
  for (FluidEntry& entry : fluids.entries) {
    if (entry.def == nullptr) continue;
    bool good = true;
    for_each_later_fluid_array(entry, [&](auto& array) { good = good && read_array(in, array); });
    if (!good || !fits_definition(entry)) return false;
  }
  return true;
}

}  // namespace gyre
