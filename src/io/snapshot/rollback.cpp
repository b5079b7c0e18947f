// A ring of state copies in memory.
#include "io/snapshot/state_copy.h"
#include "world/world_access.h"

#include <gyre/replay.h>

namespace gyre {

Result<World> clone(const World& world) {
  const WorldState& from = state_of(world);
  if (from.stepping) return make_error(ErrorCode::busy, "the world is in the middle of a step");
  std::unique_ptr<WorldState> state = make_world_state(world.def());
  // The same number, so that ids of one name the same objects in the other.
  state->number = from.number;
  state->rigid.world_number = from.number;
  StateCopy copy;
  copy.save(from);
  copy.restore(*state);
  return WorldAccess::make(std::move(state));
}

struct Rollback::Ring {
  struct Slot {
    bool used = false;
    StateCopy state;
  };
  std::vector<Slot> slots;
  std::size_t next = 0;  // the slot that is written next
};

Rollback::Rollback(int capacity) : ring_(std::make_unique<Ring>()) {
  ring_->slots.resize(capacity > 0 ? std::size_t(capacity) : 1);
}
Rollback::~Rollback() = default;
Rollback::Rollback(Rollback&&) noexcept = default;

void Rollback::save(const World& world) {
  const std::uint64_t step = world.step_count();
  std::vector<Ring::Slot>& slots = ring_->slots;
  // After a rewind, the new state of a step replaces the saved one, and saved states of later steps are dropped.
  std::size_t index = ring_->next;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (!slots[i].used || slots[i].state.step_count() < step) continue;
    if (slots[i].state.step_count() == step) index = i;
    slots[i].used = false;
  }
  slots[index].state.save(state_of(world));
  slots[index].used = true;
  ring_->next = (index + 1) % slots.size();
}

bool Rollback::restore(World& world, std::uint64_t step) const {
  for (const Ring::Slot& slot : ring_->slots) {
    if (!slot.used || slot.state.step_count() != step) continue;
    slot.state.restore(state_of(world));
    return true;
  }
  return false;
}

std::uint64_t Rollback::oldest() const {
  std::uint64_t step = UINT64_MAX;
  for (const Ring::Slot& slot : ring_->slots) {
    if (slot.used && slot.state.step_count() < step) step = slot.state.step_count();
  }
  return step;
}

std::uint64_t Rollback::newest() const {
  std::uint64_t step = 0;
  bool any = false;
  for (const Ring::Slot& slot : ring_->slots) {
    if (!slot.used || (any && slot.state.step_count() <= step)) continue;
    step = slot.state.step_count();
    any = true;
  }
  return any ? step : UINT64_MAX;
}

}  // namespace gyre
