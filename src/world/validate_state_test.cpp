// State validation accepts valid worlds after any stage of any step, and finds every rule that is broken on purpose.
#include "world/validate_state.h"
#include "determinism/random_world.h"
#include "determinism/scenes.h"
#include "world/world_access.h"
#include "world/world_state.h"

#include <gyre/replay.h>

#include <gtest/gtest.h>

#include <cstring>
#include <string>

namespace gyre::validate_state_test {
namespace {

// Validates a world after each stage of its steps, and keeps the first fault.
class StageValidator {
 public:
  explicit StageValidator(World& world) : state_(state_of(world)) {
    state_.stage_hook = {
        [](void* user, const char* stage) { static_cast<StageValidator*>(user)->validate(stage); }, this};
  }
  ~StageValidator() { state_.stage_hook = {}; }
  StageValidator(const StageValidator&) = delete;
  StageValidator& operator=(const StageValidator&) = delete;
  const std::string& fault() const { return fault_; }
  int validations() const { return validations_; }

 private:
  void validate(const char* name) {
    int stage = 0;
    while (stage < kStageCount - 1 && std::strcmp(kStageNames[stage], name) != 0) ++stage;
    const Error error = validate_state(state_, StageName(stage));
    ++validations_;
    if (error.ok() || !fault_.empty()) return;
    fault_ = "step " + std::to_string(state_.step_count) + ", after " + name + ": " + error.message;
  }

  WorldState& state_;
  std::string fault_;
  int validations_ = 0;
};

class ValidateScenes : public testing::TestWithParam<int> {};
TEST_P(ValidateScenes, FindsNothingWrong) {
  const scenes::Scene& scene = scenes::kScenes[GetParam()];
  Result<World> world = World::create();
  ASSERT_TRUE(world);
  scene.build(*world);
  StageValidator validator(*world);
  for (int step = 0; step < scenes::kSteps; ++step) {
    if (scene.drive != nullptr) scene.drive(*world, step);
    if (step % 10 == 0) {
      const Error between = validate_state(state_of(*world));
      ASSERT_EQ(between.code, ErrorCode::none) << "before step " << step << ": " << between.message;
    }
    world->step(scenes::kStepSeconds);
    ASSERT_EQ(validator.fault(), "");
  }
  EXPECT_EQ(validator.validations(), scenes::kSteps * kStageCount);
}
INSTANTIATE_TEST_SUITE_P(All, ValidateScenes, testing::Range(0, int(std::size(scenes::kScenes))),
                         [](const testing::TestParamInfo<int>& which) {
                           return std::string(scenes::kScenes[which.param].name);
                         });

// Random worlds with every kind of command, and with snapshots saved and restored in between.
void validate_random_worlds(std::uint32_t first, std::uint32_t count, int steps) {
  for (std::uint32_t number = first; number < first + count; ++number) {
    scenes::RandomWorld random(number);
    Result<World> world = World::create(random.def());
    ASSERT_TRUE(world) << number;
    random.build(*world);
    StageValidator validator(*world);
    std::vector<std::byte> snapshot;
    for (int step = 0; step < steps; ++step) {
      random.drive(*world, step);
      if (step == steps / 2) snapshot = save_snapshot(*world);
      if (step == steps / 2 + 7) {
        ASSERT_EQ(restore_snapshot(*world, snapshot).code, ErrorCode::none);
      }
      Error between = validate_state(state_of(*world));
      ASSERT_EQ(between.code, ErrorCode::none)
          << "world " << number << ", before step " << step << ": " << between.message;
      world->step(scenes::kStepSeconds);
      ASSERT_EQ(validator.fault(), "") << "world " << number;
      between = validate_state(state_of(*world));
      ASSERT_EQ(between.code, ErrorCode::none)
          << "world " << number << ", after step " << step << ": " << between.message;
    }
  }
}
TEST(ValidateRandomWorlds, FindsNothingWrong) { validate_random_worlds(1, 12, 60); }
TEST(LongValidateRandomWorlds, FindsNothingWrong) { validate_random_worlds(100, 400, 120); }

// ---------------------------------------------------------------------------------------------------- rules that fail

// Two sleeping stacks, one pushed stack, two joined bodies that swing, a far ball.
World make_busy_world() {
  Result<World> world = World::create();
  scenes::add_fixed(*world, {0, -1, 0}, Box{{50, 1, 50}});
  for (int i = 0; i < 6; ++i) scenes::add_moving(*world, {4.0 * (i % 3), 0.5 + i / 3, 0}, Box{});
  const BodyId a = scenes::add_moving(*world, {0, 8, 8}, Sphere{0.5f});
  const BodyId b = scenes::add_moving(*world, {1, 8, 8}, Sphere{0.5f});
  // Springs are iterative; joints that are solved directly have no colours.
  world->add_joint(DistanceDef{.b = a, .anchor = {0, 9, 8}, .stiffness = 1.0e4f});
  world->add_joint(DistanceDef{.a = a, .b = b, .anchor = {0, 8, 8}, .stiffness = 1.0e4f});
  for (int i = 0; i < 120; ++i) world->step(scenes::kStepSeconds);
  world->set_velocity(scenes::body_number(*world, 6), {1, 0, 0}, {});
  world->step(scenes::kStepSeconds);
  return std::move(*world);
}

// The message of the validation of that world after `spoil`.
template <class Spoil>
std::string fault_after(Spoil&& spoil, std::optional<StageName> stage = {}) {
  World world = make_busy_world();
  const Error before = validate_state(state_of(world), stage);
  if (before) return std::string("before: ") + before.message;
  spoil(state_of(world));
  return validate_state(state_of(world), stage).message;
}
testing::AssertionResult tells(const std::string& fault, const char* words) {
  if (fault.find(words) != std::string::npos) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "validation says \"" << fault << "\", not \"" << words << "\"";
}
// The first contact of two awake bodies that touch.
Contact& awake_contact(WorldState& s) {
  for (Contact& contact : s.rigid.contacts.contacts) {
    if (contact.manifold_room != 0 && contact.manifold_count > 0 &&
        s.rigid.bodies.flags[contact.body_b].awake != 0)
      return contact;
  }
  ADD_FAILURE() << "nothing touches";
  return s.rigid.contacts.contacts[0];
}
void acquire_manifolds(WorldState& s, Contact& contact) {
  for (Manifold& manifold : manifolds_of(s.rigid.contacts, contact)) manifold = {};
  contact.manifold_count = 0;
}

TEST(ValidateState, FindsListsThatDisagree) {
  EXPECT_TRUE(tells(fault_after([](WorldState& s) { s.rigid.bodies.shapes[1].clear(); }),
                    "a shape is not in the list of its body"));
  EXPECT_TRUE(tells(fault_after([](WorldState& s) { s.rigid.bodies.shapes[2] = s.rigid.bodies.shapes[1]; }),
                    "body 2 lists shape 1, which is not its own"));
  EXPECT_TRUE(tells(fault_after([](WorldState& s) { s.rigid.bodies.joints[7].clear(); }),
                    "a joint is not in the list of its body"));
  EXPECT_TRUE(tells(fault_after([](WorldState& s) { s.rigid.bodies.joints[7].push_back(7); }),
                    "body 7 lists joint 7, which was removed"));
  EXPECT_TRUE(tells(fault_after([](WorldState& s) { s.rigid.bodies.joints[1].push_back(1); }),
                    "body 1 lists joint 1, which is between others"));
  EXPECT_TRUE(tells(fault_after([](WorldState& s) { s.rigid.bodies.awake.pop_back(); }),
                    "body 8 is awake but is not listed so"));
  EXPECT_TRUE(
      tells(fault_after([](WorldState& s) { ++s.rigid.bodies.sleeping_count; }), "4 bodies sleep, not 5"));
  EXPECT_TRUE(tells(fault_after([](WorldState& s) { s.rigid.active_constraints.contacts.reset_all(); }),
                    "has an awake body, but nobody asks it"));
  EXPECT_TRUE(tells(fault_after([](WorldState& s) { s.rigid.active_constraints.joints.reset_all(); }),
                    "joint 0 has an awake body, but nobody asks it"));
  EXPECT_TRUE(tells(fault_after([](WorldState& s) { s.rigid.joints.blocked.clear(); }),
                    "joint 1 keeps its bodies from colliding, but they are not known"));
}

TEST(ValidateState, FindsInvalidColumns) {
  EXPECT_TRUE(tells(fault_after([](WorldState& s) { s.rigid.bodies.flags[1].awake ^= 1; }),
                    "the state does not hang together"));
  EXPECT_TRUE(tells(fault_after([](WorldState& s) { s.rigid.bodies.motion.pop_back(); }),
                    "the body columns differ in length"));
}

TEST(ValidateState, FindsPosesThatDisagree) {
  EXPECT_TRUE(tells(fault_after([](WorldState& s) { s.rigid.bodies.orientations[3].x += 1e-6f; }),
                    "body 3 has two orientations"));
}

TEST(ValidateState, FindsBoxesThatDoNotContainTheirShapes) {
  EXPECT_TRUE(tells(fault_after([](WorldState& s) { s.rigid.shapes.proxies[4].fat_box.high.x -= 0.2f; }),
                    "the fat box of shape 4 does not contain the shape"));
  // The box is larger than the tree's copy, but it still contains the shape.
  EXPECT_TRUE(tells(fault_after([](WorldState& s) { s.rigid.shapes.proxies[4].fat_box.high.y += 0.01f; }),
                    "broad phase: a tree knows a proxy by another box than its own"));
  EXPECT_TRUE(
      tells(fault_after([](WorldState& s) { s.rigid.broadphase = make_broadphase(BroadPhaseKind::bvh); }),
            "broad phase: "));
}

TEST(ValidateState, FindsContactsWithoutPairsAndPairsWithoutContacts) {
  EXPECT_TRUE(tells(fault_after([](WorldState& s) {
                      const Contact contact = awake_contact(s);
                      remove_contact(
                          s.rigid.contacts,
                          find_contact(s.rigid.contacts, pair_key(contact.shape_a, contact.shape_b)));
                    }),
                    "overlap, but they have no contact"));
  EXPECT_TRUE(tells(fault_after([](WorldState& s) {
                      add_contact(s.rigid.contacts, pair_key(1, 3), {.body_a = 1, .body_b = 3});
                    }),
                    "whose fat boxes are apart"));
  EXPECT_TRUE(tells(fault_after([](WorldState& s) {
                      add_contact(s.rigid.contacts, pair_key(7, 8), {.body_a = 7, .body_b = 8});
                    }),
                    "which a joint keeps from colliding"));
  EXPECT_TRUE(tells(fault_after([](WorldState& s) { s.rigid.shapes.proxies[0].filter.collides_with = 0; }),
                    "which may not touch"));
  EXPECT_TRUE(tells(fault_after([](WorldState& s) { s.rigid.contacts.slot_of_pair.clear(); }), "contacts: "));
}

TEST(ValidateState, FindsColorsWithABodyTwice) {
  EXPECT_TRUE(tells(fault_after([](WorldState& s) {
                      ASSERT_GE(s.solve.together.contacts.pairs.size(), 2u);
                      // Both have colour 0, as if the second had not seen the first.
                      s.solve.together.contacts.pairs[1] = s.solve.together.contacts.pairs[0];
                      s.solve.together.contact_colors.color[1] = s.solve.together.contact_colors.color[0];
                    }),
                    "a group of contacts has a moving body twice"));
  EXPECT_TRUE(tells(fault_after([](WorldState& s) {
                      ASSERT_EQ(s.solve.together.joints.pairs.size(), 2u);
                      s.solve.together.joints.pairs[1] = s.solve.together.joints.pairs[0];
                      s.solve.together.joint_colors.color[1] = s.solve.together.joint_colors.color[0];
                    }),
                    "a group of joints has a moving body twice"));
}

TEST(ValidateState, FindsConstraintsThatTheSolverMissed) {
  // Right after the step nothing has changed since its stage `solve`.
  constexpr StageName kSolve = StageName::solve;
  EXPECT_TRUE(tells(fault_after([](WorldState& s) { --s.solve.counts.manifolds; }, kSolve),
                    "the solver has other manifolds"));
  EXPECT_TRUE(tells(fault_after([](WorldState& s) { acquire_manifolds(s, awake_contact(s)); }, kSolve),
                    "the solver has other manifolds than those that touch"));
  EXPECT_TRUE(tells(fault_after([](WorldState& s) { ++s.solve.counts.joints; }, kSolve),
                    "the solver has other joints"));
  EXPECT_TRUE(tells(fault_after([](WorldState& s) { remove_joint_now(s, 1); }, kSolve),
                    "the solver has other joints than those that act"));
}

TEST(ValidateState, FindsGroupsThatAreNotConnected) {
  // The sleeping stacks of bodies 1 and 4, and of 2 and 5, as one group.
  const auto join_groups = [](WorldState& s) {
    Array<BodySleep>& sleep = s.rigid.bodies.sleep;
    ASSERT_EQ(sleep[1].group, 1u);
    ASSERT_EQ(sleep[2].group, 2u);
    sleep[2].group = sleep[5].group = 1;
    sleep[1].next_in_group = 2;
    sleep[2].next_in_group = 5;
    sleep[5].next_in_group = 4;
    sleep[4].next_in_group = 1;
  };
  EXPECT_TRUE(
      tells(fault_after(join_groups), "body 2 sleeps in the group of body 1, but nothing links them"));
  const auto wake_one = [](WorldState& s) {
    BodySleep& low = s.rigid.bodies.sleep[1];
    low = {};
    s.rigid.bodies.flags[1].awake = 1;
    s.rigid.bodies.sleep[4] = {0.5f, 4, 4};
    s.rigid.bodies.awake_stale = true;
  };
  EXPECT_TRUE(tells(fault_after(wake_one, StageName::link_islands),
                    "body 4 sleeps, although body 1 beside it moves"));
}

}  // namespace
}  // namespace gyre::validate_state_test
