// Each body, joint and island is in one batch, few small islands join a large one, and large batches are marked.
#include "dynamics/island_batches.h"

#include <gtest/gtest.h>

#include <vector>

namespace gyre::island_batches_test {
namespace {

class ChainsInBatches : public ::testing::Test {
 protected:
  // Adds bodies that are adjacent in memory, each joined to the next: 5 quarters a body, less 4.
  void add_chain(std::uint32_t bodies) {
    for (std::uint32_t i = 0; i < bodies; ++i) {
      const std::uint32_t body = add_body_slot(w_.bodies).index;
      w_.bodies.flags[body].type = BodyType::dynamic;
      w_.bodies.flags[body].awake = 1;
      w_.bodies.awake.push_back(body);
      chain_of_.push_back(chains_);
      if (i == 0) continue;
      const std::uint32_t slot = w_.joints.ids.acquire().index;
      w_.joints.records.resize(slot + 1);
      activate_joint(w_, slot);
      w_.joints.records[slot].body_a = std::int32_t(body) - 1;
      w_.joints.records[slot].body_b = std::int32_t(body);
    }
    ++chains_;
  }

  struct Found {
    std::vector<std::uint32_t> batch_of_chain;
    std::vector<bool> is_small;  // by batch
  };
  Found find(BatchSize size) {
    arena_.reset();
    const IslandBatches all = find_batches(w_, {}, arena_, tasks_, size);
    Found found{std::vector<std::uint32_t>(chains_, kNone), {}};
    std::size_t bodies = 0, joints = 0;
    for (std::uint32_t n = 0; n < all.batches.size(); ++n) {
      const IslandBatch& batch = all.batches[n];
      found.is_small.push_back(batch.is_small);
      bodies += batch.bodies.size();
      joints += batch.joints.size();
      for (std::uint32_t i = 0; i < batch.bodies.size(); ++i) {
        const std::uint32_t body = batch.bodies[i];
        EXPECT_EQ(all.local_index[body], i);
        EXPECT_TRUE(i == 0 || batch.bodies[i - 1] < body) << "ascending";
        std::uint32_t& of_chain = found.batch_of_chain[chain_of_[body]];
        EXPECT_TRUE(of_chain == kNone || of_chain == n) << "a chain is an island";
        of_chain = n;
      }
      for (std::uint32_t i = 0; i < batch.joints.size(); ++i) {
        EXPECT_TRUE(i == 0 || batch.joints[i - 1] < batch.joints[i]) << "ascending";
        const JointRecord& joint = w_.joints.records[batch.joints[i]];
        EXPECT_EQ(found.batch_of_chain[chain_of_[std::size_t(joint.body_a)]], n);
      }
    }
    EXPECT_EQ(bodies, w_.bodies.awake.size());
    EXPECT_EQ(joints, w_.joints.records.size());
    return found;
  }

  static constexpr std::uint32_t kNone = 0xffffffffu;
  RigidWorld w_;
  std::uint32_t chains_ = 0;
  std::vector<std::uint32_t> chain_of_;  // by body
  TaskSystem tasks_{1};
  Arena arena_;
};

TEST_F(ChainsInBatches, AreFilledInTheirOrder) {
  for (int i = 0; i < 40; ++i) add_chain(17);  // 81 quarters each
  const Found found = find({.most = 64, .shares = 1, .fewest = 2});
  // Three of them weigh 243 of 256; four would exceed it.
  for (std::uint32_t chain = 0; chain < 40; ++chain) EXPECT_EQ(found.batch_of_chain[chain], chain / 3);
  for (const bool is_small : found.is_small) EXPECT_TRUE(is_small);
}

TEST_F(ChainsInBatches, EndWhereLanesAreFull) {
  for (int i = 0; i < 100; ++i) add_chain(2);  // 6 quarters each
  const Found found = find({.most = 64, .shares = 1, .fewest = 2});
  // Forty-two of them would weigh 252 of 256, but the last two would be alone in their lanes.
  for (std::uint32_t chain = 0; chain < 100; ++chain) EXPECT_EQ(found.batch_of_chain[chain], chain / 40);
}

TEST_F(ChainsInBatches, FewGoAlongWithTheLargest) {
  add_chain(17);
  add_chain(100);
  add_chain(17);
  add_chain(200);
  add_chain(17);
  const BatchSize few{.most = 64, .shares = 1, .fewest = 2};
  Found found = find(few);
  EXPECT_EQ(found.batch_of_chain, (std::vector<std::uint32_t>{1, 0, 1, 1, 1}));
  EXPECT_EQ(found.is_small, (std::vector<bool>{false, false}));
  // Small islands get a batch of their own if any number of batches is enough.
  found = find({.most = 64, .shares = 1, .fewest = 1});
  EXPECT_EQ(found.batch_of_chain, (std::vector<std::uint32_t>{0, 1, 0, 2, 0}));
  EXPECT_EQ(found.is_small, (std::vector<bool>{true, false, false}));
  // They also do if there are more batches of them.
  for (int i = 0; i < 3; ++i) add_chain(17);
  found = find(few);
  EXPECT_EQ(found.is_small, (std::vector<bool>{true, false, false, true}));
  EXPECT_EQ(find({.most = 64, .shares = 1, .fewest = 3}).is_small, (std::vector<bool>{false, false}));
}

TEST_F(ChainsInBatches, AreOneWhereOneIslandIsLargeAndLittleElseIs) {
  add_chain(17);
  add_chain(300);
  const Found found = find({.most = 64, .shares = 1, .fewest = 2});
  EXPECT_EQ(found.batch_of_chain, (std::vector<std::uint32_t>{0, 0}));
}

}  // namespace
}  // namespace gyre::island_batches_test
