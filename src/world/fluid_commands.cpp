#include "world/fluid_commands.h"

#include "dynamics/fluid/fluid_solids.h"
#include "dynamics/fluid/fluid_visitors.h"
#include "fluid/store/fluid_builder.h"
#include "fluid/store/fluid_motion.h"
#include "rigid/sleep/island.h"
#include "world/refusal.h"
#include "world/world_state.h"

namespace gyre {

namespace {

constexpr std::size_t kMaxFluids = 1u << 12;

Error check_id(const WorldState& s, FluidId id, const char* what) {
  if (is_fluid(s, id)) return {};
  return make_error(ErrorCode::stale_id, "%s: fluid %u (generation %u) does not exist in this world", what,
                    id.index, unsigned(id.generation));
}

}  // namespace

bool is_fluid(const WorldState& s, FluidId id) {
  return id && id.world == s.number && s.fluids.ids.live(id.index) &&
         std::uint16_t(s.fluids.ids.generation(id.index)) == id.generation;
}

Error check(const WorldState& s, const AddFluid& c) {
  if (s.fluids.ids.size() >= kMaxFluids) return refuse("a world has at most %d fluids", int(kMaxFluids));
  return std::visit([](const auto& def) { return check_fluid(def); }, *c.def);
}
Error check(const WorldState& s, const RemoveFluid& c) { return check_id(s, c.fluid, "remove_fluid"); }
Error check(const WorldState& s, const SetEmitters& c) {
  const Error e = check_id(s, c.fluid, "set_emitters");
  if (e) return e;
  const FluidEntry& entry = s.fluids.entries[c.fluid.index];
  return std::visit([&](const auto& def) { return check_emitters(c.emitters, def.lower, def.upper); },
                    *entry.def);
}

Error check(const WorldState& s, const SetFluidPose& c) {
  const Error e = check_id(s, c.fluid, "set_fluid_pose");
  return e ? e : check_frame(c.pose, {}, {});
}
Error check(const WorldState& s, const SetFluidVelocity& c) {
  const Error e = check_id(s, c.fluid, "set_fluid_velocity");
  return e ? e : check_frame({}, c.linear, c.angular);
}

CommandResult execute(WorldState& s, const AddFluid& c) {
  const IdPool::Slot slot = s.fluids.ids.acquire();
  if (s.fluids.entries.size() < s.fluids.ids.capacity()) s.fluids.entries.resize(s.fluids.ids.capacity());
  FluidEntry& entry = s.fluids.entries[slot.index] = build_fluid(c.def);
  if (slot.index < s.fluid_scratch.size()) s.fluid_scratch[slot.index] = {};
  if (entry.is_liquid()) {
    FluidSolids solids;
    const auto cut = [&](const FluidWindow& window) {
      cut_fluid_cells(s.rigid, entry, window, *s.tasks, solids);
    };
    find_near_shapes(s.rigid, entry, solids);
    cut(whole_window(entry.box()));
    fill_liquid(entry, solids.solids, cut);
  }
  CommandResult out;
  out.done = true;
  out.fluid = {slot.index, std::uint16_t(slot.generation), s.number};
  return out;
}
CommandResult execute(WorldState& s, const RemoveFluid& c) {
  end_fluid_touches(s.rigid, s.fluids, c.fluid.index);
  // Bodies that the fluid held may fall.
  for (const FluidPush& push : s.fluids.entries[c.fluid.index].pushes)
    if (s.rigid.bodies.ids.live(push.body)) wake(s.rigid, push.body);
  s.fluids.entries[c.fluid.index] = {};
  s.fluids.ids.release(c.fluid.index);
  if (c.fluid.index < s.fluid_scratch.size()) s.fluid_scratch[c.fluid.index] = {};
  return {true, {}, {}, {}};
}
CommandResult execute(WorldState& s, const SetEmitters& c) {
  set_emitters(s.fluids.entries[c.fluid.index], c.emitters);
  return {true, {}, {}, {}};
}

CommandResult execute(WorldState& s, const SetFluidPose& c) {
  FluidEntry& entry = s.fluids.entries[c.fluid.index];
  FluidFrame frame = entry.frame() != nullptr ? *entry.frame() : FluidFrame{};
  frame.pose = {c.pose.position, normalized(c.pose.orientation)};
  set_frame(entry, frame);
  return {true, {}, {}, {}};
}
CommandResult execute(WorldState& s, const SetFluidVelocity& c) {
  FluidEntry& entry = s.fluids.entries[c.fluid.index];
  FluidFrame frame = entry.frame() != nullptr ? *entry.frame() : FluidFrame{};
  change_frame_velocity(entry, c.linear - frame.velocity, c.angular - frame.angular_velocity);
  // The solids are those of the window before.
  if (entry.is_adaptive() && c.fluid.index < s.fluid_scratch.size()) s.fluid_scratch[c.fluid.index] = {};
  return {true, {}, {}, {}};
}

// ------------------------------------------------------------------------------------------------------ loaded columns

Error check_fluid_columns(const RigidWorld& w, const FluidStore& fluids) {
  const auto bad = [](const char* what) {
    return make_error(ErrorCode::invalid_data, "the state does not hang together: %s", what);
  };
  if (fluids.ids.capacity() != fluids.entries.size())
    return bad("ids and entries of fluids differ in length");
  for (std::uint32_t slot = 0; slot < fluids.entries.size(); ++slot) {
    const FluidEntry& entry = fluids.entries[slot];
    if (fluids.ids.live(slot) != (entry.def != nullptr)) return bad("a fluid without an id");
    if (entry.def == nullptr) continue;
    for (const FluidPush& push : entry.pushes) {
      if (push.body >= w.bodies.ids.capacity()) return bad("a fluid pushes a body that is not there");
      if (!is_finite(push.force) || !is_finite(push.torque))
        return bad("the force of a fluid that is not finite");
    }
    if (entry.frames.size() > 1) return bad("a fluid with two frames");
    for (const FluidFrame& frame : entry.frames) {
      if (!is_finite(frame.pose) || !is_finite(frame.velocity) || !is_finite(frame.angular_velocity))
        return bad("the frame of a fluid that is not finite");
    }
    const std::vector<FluidEmitter> emitters = emitter_defs(entry);
    const Error e = std::visit(
        [&](const auto& def) { return check_emitters(emitters, def.lower, def.upper); }, *entry.def);
    if (e) return bad("an emitter out of range");
  }
  return {};
}

}  // namespace gyre
