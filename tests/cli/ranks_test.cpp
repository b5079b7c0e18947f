// gyre-mpi simulate: results that do not depend on the number of ranks to the bit, bounds for those that do, sleep across borders, checkpoints,
// dead ranks. The division of space is tested without MPI.
#include "mpi/space_blocks.h"
#include "run_program.h"
#include "scene/json_document.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

namespace gyre::ranks_test {
namespace {

namespace fs = std::filesystem;

TEST(SpaceBlocks, CellsAreDividedByWeightAndEveryPlaceHasAnOwner) {
  SpaceBlocks blocks(2.0, 4);
  std::map<std::uint64_t, double> weights;
  for (int x = -8; x < 8; ++x) {
    for (int z = -8; z < 8; ++z) weights[blocks.key_of({2.0 * x + 1, 0.5, 2.0 * z + 1})] += 1;
  }
  ASSERT_EQ(weights.size(), 256u);
  blocks.divide(weights);
  std::vector<int> cells(4);
  for (const auto& [key, weight] : weights) ++cells[std::size_t(blocks.owner_of_key(key))];
  EXPECT_EQ(cells, std::vector<int>(4, 64));
  // A quarter of the plane each: blocks, not scattered cells.
  EXPECT_EQ(blocks.owner_of({-15, 0, -15}), blocks.owner_of({-1, 0, -1}));
  EXPECT_NE(blocks.owner_of({-1, 0, -1}), blocks.owner_of({1, 0, 1}));
  for (const DVec3 far : {DVec3{1e9, 1e9, 1e9}, DVec3{-1e9, 0, 1e9}})
    EXPECT_TRUE(blocks.owner_of(far) >= 0 && blocks.owner_of(far) < 4);
  // The neighbours of a place at a corner are all four; far from borders there is one.
  std::vector<int> near;
  blocks.for_each_owner({0, 0.5, 0}, 0.5, [&](int rank) { near.push_back(rank); });
  std::sort(near.begin(), near.end());
  near.erase(std::unique(near.begin(), near.end()), near.end());
  EXPECT_EQ(near, (std::vector<int>{0, 1, 2, 3}));
  near.clear();
  blocks.for_each_owner({-9, 0.5, -9}, 0.5, [&](int rank) { near.push_back(rank); });
  EXPECT_EQ(near.size(), 1u);
}

TEST(SpaceBlocks, AHeavyCellIsNotDividedAndEmptyRanksOwnNothing) {
  SpaceBlocks blocks(1.0, 3);
  blocks.divide({{10, 100.0}, {11, 1.0}});
  EXPECT_EQ(blocks.owner_of_key(10) == blocks.owner_of_key(11), false);
  blocks.divide({});
  EXPECT_EQ(blocks.owner_of_key(0), 0);
}

#ifdef GYRE_MPI_PROGRAM
class Ranks : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("gyre_ranks_" + std::to_string(getpid()) + "_" +
                                           ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);
    setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
  }
  void TearDown() override { fs::remove_all(folder_); }
  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  std::string read(const std::string& name) const { return file_text(folder_ / name); }

  // Bodies beside a ground: "sphere" or "box" in place of {}.
  void write_scene(const std::string& bodies, const std::string& world = "") {
    write("s.gyre.json", R"({"gyre_scene": 1, "world": {"time_step": 0.016666667)" + world + R"(}, "bodies": [
      {"name": "ground", "type": "static", "shapes": [{"type": "plane"}]})" +
                             bodies + "]}");
  }
  static std::string box(const std::string& name, double x, double y, double z,
                         const std::string& more = "") {
    return ",\n{\"name\": \"" + name + "\", \"position\": [" + std::to_string(x) + ", " + std::to_string(y) +
           ", " + std::to_string(z) + "]" + more +
           ", \"shapes\": [{\"type\": \"box\", \"half_extents\": [0.5, 0.5, 0.5]}]}";
  }
  int mpi(int ranks, const std::string& arguments) {
    const std::string command = "cd '" + folder_.string() + "' && " GYRE_MPIRUN " --oversubscribe -n " +
                                std::to_string(ranks) + " '" GYRE_MPI_PROGRAM "' simulate " + arguments +
                                " >out.txt 2>err.txt";
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  Json figures(int ranks, const std::string& arguments) {
    const int code = mpi(ranks, "s.gyre.json --json " + arguments);
    EXPECT_EQ(code, 0) << read("err.txt");
    return Json::parse(read("out.txt"), nullptr, false);
  }
  fs::path folder_;
};

TEST_F(Ranks, BodiesThatTouchNoOtherHaveTheSameBitsOnAnyNumberOfRanks) {
  std::string bodies;
  for (int i = 0; i < 16; ++i) {
    const std::string spin = ", \"linear_velocity\": [" + std::to_string(0.3 * (i % 5) - 0.6) +
                             ", 0, 0.4], \"angular_velocity\": [1, 0.2, " + std::to_string(0.1 * i) + "]";
    bodies += box("b" + std::to_string(i), 5.0 * (i % 4) - 7.5, 1.0 + 0.1 * i, 5.0 * (i / 4) - 7.5, spin);
  }
  write_scene(bodies);
  ASSERT_EQ(mpi(1, "s.gyre.json --steps 150 --final one.json --quiet"), 0) << read("err.txt");
  const std::string one = read("one.json");
  EXPECT_NE(one.find("\"b15\""), std::string::npos);
  for (const int ranks : {2, 4}) {
    ASSERT_EQ(mpi(ranks, "s.gyre.json --steps 150 --rebalance 20 --final many.json --quiet"), 0)
        << read("err.txt");
    EXPECT_EQ(read("many.json"), one) << ranks;
  }
}

TEST_F(Ranks, TwoBoxesThatCollideAcrossABorderKeepTheirMomentum) {
  write_scene(box("a", -3, 5, 0.1, ", \"linear_velocity\": [4, 0, 0]") +
                  box("b", 3, 5, 0, ", \"linear_velocity\": [-2, 0, 0]"),
              ", \"gravity\": [0, 0, 0]");
  ASSERT_EQ(mpi(1, "s.gyre.json --steps 90 --final one.json --quiet"), 0);
  const Json two = figures(2, "--steps 90 --rebalance 0 --final many.json");
  EXPECT_NEAR(two["momentum"][0].get<double>(), 1000 * (4 - 2), 0.05);
  EXPECT_LT(two["kinetic_energy"].get<double>(), 9000.0);  // they did meet
  EXPECT_EQ(read("many.json"), read("one.json"));          // and each rank sees all of the impact
}

TEST_F(Ranks, AnIslandAcrossBordersFallsAsleepAndWakesAsOne) {
  std::string bodies;
  for (int i = 0; i < 16; ++i) bodies += box("b" + std::to_string(i), 0.999 * (i - 7.5), 0.5, 0);
  bodies += box("late", -7.4, 60, 0);  // hits the first box after 3.5 s
  write_scene(bodies);
  for (const int ranks : {1, 4}) {
    EXPECT_EQ(figures(ranks, "--steps 150")["awake"], 1.0) << ranks;
    EXPECT_EQ(figures(ranks, "--steps 215")["awake"], 17.0) << ranks;
  }
}

TEST_F(Ranks, APileOnManyRanksStandsAsOnOne) {
  std::string bodies;
  for (int i = 0; i < 60; ++i)
    bodies += box("b" + std::to_string(i), 1.02 * (i % 5) - 2, 0.5 + 1.001 * (i / 10), 1.02 * (i / 5 % 2));
  write_scene(bodies);
  const Json one = figures(1, "--steps 120"), four = figures(4, "--steps 120");
  EXPECT_NEAR(four["center_of_mass"][1].get<double>(), one["center_of_mass"][1].get<double>(), 0.01);
  EXPECT_LT(four["deepest_overlap"].get<double>(), 0.01);
  EXPECT_LT(four["kinetic_energy"].get<double>(), 10.0);
  EXPECT_GT(four["bytes_a_step"].get<double>(), 1000.0);
}

TEST_F(Ranks, ASceneThatCannotBeDividedIsRefusedInWords) {
  write_scene(R"(], "ropes": [{"name": "r", "points": [[0, 3, 0], [1, 3, 0]])"
              "}");
  EXPECT_EQ(mpi(2, "s.gyre.json --steps 1"), 3);
  EXPECT_NE(read("err.txt").find("ropes"), std::string::npos) << read("err.txt");
}

TEST_F(Ranks, ADeadRankEndsTheRunAndTheCheckpointGoesOnWithOtherRanks) {
  std::string bodies;
  for (int i = 0; i < 16; ++i)
    bodies += box("b" + std::to_string(i), 4.0 * (i % 4) - 6, 1.0, 4.0 * (i / 4) - 6);
  write_scene(bodies);
  const pid_t run = fork();
  if (run == 0) {
    if (chdir(folder_.c_str()) != 0) _exit(125);
    const int out = open("dead.txt", O_WRONLY | O_CREAT | O_TRUNC, 0600);
    dup2(out, 1), dup2(out, 2);
    execlp(GYRE_MPIRUN, "mpirun", "--oversubscribe", "-n", "2", GYRE_MPI_PROGRAM, "simulate", "s.gyre.json",
           "--steps", "100000000", "--checkpoint", "20", "--checkpoint-file", "c.gyre.json", nullptr);
    _exit(126);
  }
  std::vector<pid_t> ranks;
  for (int tries = 0; tries < 1000 && (ranks.size() < 2 || !fs::exists(folder_ / "c.gyre.json")); ++tries) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    ranks.clear();
    std::istringstream children(
        file_text("/proc/" + std::to_string(run) + "/task/" + std::to_string(run) + "/children"));
    for (pid_t child = 0; children >> child;) ranks.push_back(child);
  }
  ASSERT_GE(ranks.size(), 2u) << read("dead.txt");
  kill(ranks.back(), SIGKILL);
  int status = 0;
  waitpid(run, &status, 0);
  EXPECT_FALSE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  EXPECT_NE(read("dead.txt").find("signal 9"), std::string::npos) << read("dead.txt");
  EXPECT_EQ(mpi(3, "c.gyre.json --steps 5 --json"), 0) << read("err.txt");
  EXPECT_EQ(Json::parse(read("out.txt"))["bodies"], 16.0);
}
#endif

}  // namespace
}  // namespace gyre::ranks_test
