// Commands on couplings, and readings of them. See joint_commands.h and gyre/coupling.h.
#include "world/joint_commands.h"

#include "rigid/articulation/joint_space.h"
#include "rigid/sleep/island.h"
#include "world/joint_reading.h"
#include "world/refusal.h"
#include "world/world_state.h"

namespace gyre {

namespace {

constexpr std::size_t kMaxCouplings = 65536;
constexpr float kMaxCoefficient = 1.0e6f;  // 1, m or 1/m, by the axes that are coupled

CouplingId coupling_id(const WorldState& s, std::uint32_t slot) {
  return {slot, std::uint16_t(s.rigid.couplings[slot].generation), s.number};
}

bool can_couple(const RigidWorld& w, std::uint32_t slot, JointAxis axis) {
  const JointRecord& joint = w.joints.records[slot];
  if (joint.kind == JointKind::ball || joint.kind == JointKind::cone) return false;
  return int(axis) < kJointAxisCount && is_coordinate(joint, detail_of(w.joints, slot), axis);
}

bool is_number(float value, float largest) { return is_finite(value) && absolute(value) <= largest; }

void wake_coupled(WorldState& s, const CouplingRecord& coupling) {
  for_each_body_of_coupling(s.rigid, coupling, [&](std::uint32_t body) { wake(s.rigid, body); });
}

// The sum of coefficient times position.
float sum_of(const RigidWorld& w, const CouplingRecord& coupling) {
  float sum = 0.0f;
  for (std::uint32_t i = 0; i < coupling.count; ++i)
    sum += coupling.coefficients[i] * read_joint_axis(w, coupling.joints[i], coupling.axes[i]).position;
  return sum;
}

}  // namespace

bool is_coupling(const WorldState& s, CouplingId id) {
  const Array<CouplingRecord>& couplings = s.rigid.couplings;
  return id && id.world == s.number && id.index < couplings.size() && couplings[id.index].is_live() &&
         couplings[id.index].generation == id.generation;
}

Error check(const WorldState& s, const AddCoupling& c) {
  const std::vector<CouplingTerm>& terms = c.def.terms;
  if (terms.size() < 2 || terms.size() > std::size_t(kMaxCouplingTerms))
    return refuse("coupling.terms has %d terms; it must have 2 to %d", int(terms.size()), kMaxCouplingTerms);
  if (s.rigid.couplings.size() >= kMaxCouplings)
    return refuse("add_coupling: a world has at most %d couplings", int(kMaxCouplings));
  const IdPool& ids = s.rigid.joints.ids;
  JointSpace space;
  for (std::size_t i = 0; i < terms.size(); ++i) {
    const CouplingTerm& term = terms[i];
    const JointId id = term.joint;
    if (!id || id.world != s.number || !ids.live(id.index) ||
        std::uint16_t(ids.generation(id.index)) != id.generation)
      return make_error(ErrorCode::stale_id,
                        "coupling.terms[%d]: joint %u (generation %u) does not exist in this world", int(i),
                        id.index, unsigned(id.generation));
    if (!can_couple(s.rigid, id.index, term.axis))
      return refuse("coupling.terms[%d]: a %s joint has no %s to couple", int(i),
                    to_string(s.rigid.joints.records[id.index].kind), to_string(term.axis));
    if (!is_number(term.coefficient, kMaxCoefficient) || term.coefficient == 0.0f)
      return refuse("coupling.terms[%d].coefficient is %g; it must not be 0, and lie within -1e6 and 1e6",
                    int(i), double(term.coefficient));
    for (std::size_t j = 0; j < i; ++j)
      if (terms[j].joint == id && terms[j].axis == term.axis)
        return refuse("coupling.terms[%d] has the axis of terms[%d]", int(i), int(j));
    const JointRecord& joint = s.rigid.joints.records[id.index];
    for (const std::int32_t body : {joint.body_b, joint.body_a}) {
      if (body == kNoBody || !is_movable(s.rigid.bodies.flags[std::size_t(body)])) continue;
      if (!find_joint_space(s.rigid, std::uint32_t(body), space))
        return refuse("coupling.terms[%d]: its mechanism has more than %d axes", int(i),
                      int(kMaxJointCoordinates));
      break;
    }
  }
  if (c.def.offset && !is_number(*c.def.offset, 1.0e9f))
    return refuse("coupling.offset is %g; it must lie within -1e9 and 1e9", double(*c.def.offset));
  return {};
}
Error check(const WorldState& s, const RemoveCoupling& c) {
  if (is_coupling(s, c.coupling)) return {};
  return make_error(ErrorCode::stale_id,
                    "remove_coupling: coupling %u (generation %u) does not exist in this world",
                    c.coupling.index, unsigned(c.coupling.generation));
}

CommandResult execute(WorldState& s, const AddCoupling& c) {
  Array<CouplingRecord>& couplings = s.rigid.couplings;
  constexpr std::uint32_t kLastGeneration = 0xffff;
  std::uint32_t slot = 0;
  // A slot that has used up its generations is never used again.
  while (slot < couplings.size() &&
         (couplings[slot].is_live() || couplings[slot].generation >= kLastGeneration))
    ++slot;
  if (slot == couplings.size()) couplings.push_back({});
  CouplingRecord record;
  record.generation = couplings[slot].generation + 1;
  record.count = std::uint32_t(c.def.terms.size());
  for (std::uint32_t i = 0; i < record.count; ++i) {
    record.joints[i] = c.def.terms[i].joint.index;
    record.axes[i] = c.def.terms[i].axis;
    record.coefficients[i] = c.def.terms[i].coefficient;
  }
  record.offset = c.def.offset ? *c.def.offset : sum_of(s.rigid, record);
  couplings[slot] = record;
  wake_coupled(s, record);
  CommandResult out;
  out.done = true;
  out.coupling = coupling_id(s, slot);
  return out;
}
CommandResult execute(WorldState& s, const RemoveCoupling& c) {
  CouplingRecord& coupling = s.rigid.couplings[c.coupling.index];
  wake_coupled(s, coupling);
  const std::uint32_t generation = coupling.generation + 1;
  coupling = {};
  coupling.generation = generation;
  return {true, {}, {}, {}};
}

const char* fault_in_couplings(const RigidWorld& w) {
  if (w.couplings.size() > kMaxCouplings) return "too many couplings";
  for (const CouplingRecord& coupling : w.couplings) {
    if (coupling.generation > 0x10000) return "a coupling whose generation is too large";
    if (!coupling.is_live()) continue;
    if (coupling.count < 2 || coupling.count > std::uint32_t(kMaxCouplingTerms))
      return "a coupling of so many terms";
    for (std::uint32_t i = 0; i < coupling.count; ++i) {
      const std::uint32_t joint = coupling.joints[i];
      if (!w.joints.ids.live(joint)) return "a coupling of a joint that does not exist";
      if (!can_couple(w, joint, coupling.axes[i])) return "a coupling of an axis that is none";
      if (!is_number(coupling.coefficients[i], kMaxCoefficient))
        return "a coupling that could not have been added";
    }
    if (!is_number(coupling.offset, 1.0e9f) || !is_finite(coupling.impulse) || !is_finite(coupling.total))
      return "a coupling that is not finite";
  }
  return nullptr;
}

CouplingId World::add_coupling(const CouplingDef& coupling) {
  return submit(*state_, AddCoupling{coupling}).coupling;
}
bool World::remove_coupling(CouplingId coupling) { return submit(*state_, RemoveCoupling{coupling}).done; }
bool World::exists(CouplingId coupling) const { return is_coupling(*state_, coupling); }
std::size_t World::couplings(std::span<CouplingId> out) const {
  const Array<CouplingRecord>& couplings = state_->rigid.couplings;
  std::size_t count = 0;
  for (std::uint32_t slot = 0; slot < couplings.size(); ++slot) {
    if (!couplings[slot].is_live()) continue;
    if (count < out.size()) out[count] = coupling_id(*state_, slot);
    ++count;
  }
  return count;
}
CouplingDef World::coupling(CouplingId id) const {
  CouplingDef def;
  if (!exists(id)) return def;
  const CouplingRecord& record = state_->rigid.couplings[id.index];
  for (std::uint32_t i = 0; i < record.count; ++i)
    def.terms.push_back({joint_id(state_->rigid, record.joints[i]), record.axes[i], record.coefficients[i]});
  def.offset = record.offset;
  return def;
}
CouplingState World::coupling_state(CouplingId id) const {
  if (!exists(id)) return {};
  const CouplingRecord& record = state_->rigid.couplings[id.index];
  const float seconds = state_->rigid.settings.last_step;
  return {sum_of(state_->rigid, record) - record.offset, seconds > 0.0f ? record.total / seconds : 0.0f};
}

}  // namespace gyre
