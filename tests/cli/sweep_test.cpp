// gyre sweep, and gyre-mpi where it is built: cases, results, resumption, failures, and that the number of ranks changes no line.
#include "run_program.h"
#include "scene/json_document.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace gyre::sweep_test {
namespace {

namespace fs = std::filesystem;

// A ball that falls freely, without ground: y = 10 - g t (t + h) / 2 for semi-implicit Euler in each half of a sub-step.
const std::string kFall =
    R"({"gyre_scene": 1, "world": {"time_step": 0.01, "gravity": [0, -10, 0]}, "bodies": [
  {"name": "ball", "position": [0, 10, 0], "shapes": [{"type": "sphere", "radius": 0.5}]}]})";
const std::string kStudy =
    R"({"gyre_study": 1, "scene": "fall.gyre.json", "duration": 0.5, "seed": 3, "samples": 3, "parameters": [
  {"name": "height", "pointer": "/bodies/0/position/1", "values": [10, 20]},
  {"name": "g", "pointer": "/world/gravity/1", "range": {"from": -8, "to": -10, "count": 3}},
  {"name": "push", "pointer": "/bodies/0/linear_velocity", "values": [[1, 0, 0]]},
  {"name": "radius", "pointer": "/bodies/0/shapes/0/radius", "uniform": [0.1, 0.4]}],
  "readings": [
  {"name": "y", "quantity": "position_y", "body": "ball"}, {"quantity": "speed", "body": "ball", "take": "maximum"},
  {"name": "fast", "quantity": "speed", "body": "ball", "take": "first_above", "threshold": 4}, {"quantity": "hits"}]})";

class Sweep : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("gyre_sweep_" + std::to_string(getpid()) + "_" +
                                           ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    write("fall.gyre.json", kFall);
    write("study.json", kStudy);
  }
  void TearDown() override { fs::remove_all(folder_); }
  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  std::string read(const std::string& name) const { return file_text(folder_ / name); }
  Finished gyre(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "sweep");
    return run_program(arguments, folder_);
  }
  std::vector<Json> rows() const {
    std::vector<Json> out;
    std::istringstream stream(read("study.results.jsonl"));
    for (std::string line; std::getline(stream, line);) out.push_back(Json::parse(line));
    return out;
  }
  fs::path folder_;
};

TEST_F(Sweep, EveryCombinationRunsAndReadsTheLawOfFall) {
  const Finished done = gyre({"study.json", "--threads", "2"});
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_EQ(done.out, "18 cases, 0 failed\n");
  EXPECT_EQ(gyre({"study.json", "--count"}).out, "18\n");
  const std::vector<Json> all = rows();
  ASSERT_EQ(all.size(), 18u);
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(all[i]["case"], i);
    const Json &p = all[i]["parameters"], &r = all[i]["readings"];
    const double g = -p["g"].get<double>(), t = 0.5;
    EXPECT_EQ(p["height"], i < 9 ? 10 : 20);
    EXPECT_DOUBLE_EQ(g, 8.0 + double(i / 3 % 3));
    EXPECT_TRUE(p["radius"] >= 0.1 && p["radius"] <= 0.4);
    EXPECT_NEAR(r["y"].get<double>(), p["height"].get<double>() - g * t * t / 2, 0.01 * g * t);
    EXPECT_NEAR(r["ball speed maximum"].get<double>(), std::hypot(1, g * t), 1e-4);
    EXPECT_NEAR(r["fast"].get<double>(), std::sqrt(15.0) / g, 0.011);
    EXPECT_EQ(r["hits"], 0);
    EXPECT_EQ(all[i]["hash"].get<std::string>().size(), 16u);
  }
  EXPECT_NE(all[0]["parameters"]["radius"], all[1]["parameters"]["radius"]);
  const std::string table = read("study.results.csv");
  EXPECT_EQ(table.substr(0, table.find('\n')),
            "case,height,g,push,radius,y,ball speed maximum,fast,hits,hash,error");
  EXPECT_NE(table.find("\n17,20,-10.0,\"[1,0,0]\","), std::string::npos) << table;
  const std::string chart = read("study.results.svg");
  std::size_t dots = 0;
  for (std::size_t at = chart.find("<circle"); at != std::string::npos; at = chart.find("<circle", at + 1))
    ++dots;
  EXPECT_EQ(dots, 18u * 3 * 4);  // parameters that are numbers, and readings
}

TEST_F(Sweep, AJointMayHaveTheNameOfABody) {
  write("door.gyre.json", R"({"gyre_scene": 1, "world": {"gravity": [0, 0, 0], "time_step": 0.01},
    "bodies": [{"name": "door", "angular_velocity": [0, 1, 0], "shapes": [{"type": "sphere", "radius": 0.5}]}],
    "joints": [{"name": "door", "type": "hinge", "a": "world", "b": "door", "anchor": [0, 0, 0], "axis": [0, 1, 0]}]})");
  write("door.json", R"({"gyre_study": 1, "scene": "door.gyre.json", "steps": 10, "readings": [
    {"name": "angle", "quantity": "joint_position", "joint": "door"}, {"name": "speed", "quantity": "angular_speed", "body": "door"}]})");
  ASSERT_EQ(gyre({"door.json"}).code, 0);
  const Json line = Json::parse(read("door.results.jsonl"));
  EXPECT_NEAR(line["readings"]["angle"].get<double>(), 0.1, 1e-5);
  EXPECT_NEAR(line["readings"]["speed"].get<double>(), 1.0, 1e-5);
}

TEST_F(Sweep, AnInterruptedStudyGoesOnAndGivesTheSameFile) {
  ASSERT_EQ(gyre({"study.json", "--threads", "1"}).code, 0);
  const std::string whole = read("study.results.jsonl");
  // Five lines and a half, the second of them missing.
  std::string part;
  std::istringstream stream(whole);
  std::string line;
  for (int i = 0; i < 6; ++i) {
    std::getline(stream, line);
    if (i != 1) part += i < 5 ? line + "\n" : line.substr(0, 20);
  }
  write("study.results.jsonl", part);
  ASSERT_EQ(gyre({"study.json", "--threads", "2"}).code, 0);
  EXPECT_EQ(read("study.results.jsonl"), whole);
  // One case alone, as a job of an array prints it.
  const Finished one = gyre({"study.json", "--case", "1"});
  EXPECT_EQ(one.code, 0);
  EXPECT_NE(whole.find("\n" + one.out), std::string::npos);
  EXPECT_EQ(gyre({"study.json", "--case", "18"}).code, 2);
  // Results of a study that was changed since do not count.
  write("study.json", kStudy + "\n");
  const Finished changed = gyre({"study.json"});
  EXPECT_EQ(changed.code, 3);
  EXPECT_NE(changed.err.find("another study"), std::string::npos);
  EXPECT_EQ(read("study.results.jsonl"), whole);
}

TEST_F(Sweep, AFailedCaseIsToldAndStopsNoOther) {
  std::string study = kStudy;
  study.replace(study.find("[10, 20]"), 8, "[10, \"high\"]");
  write("study.json", study);
  const Finished done = gyre({"study.json"});
  EXPECT_EQ(done.code, 1);
  EXPECT_EQ(done.out, "18 cases, 9 failed\n");
  const std::vector<Json> all = rows();
  ASSERT_EQ(all.size(), 18u);
  EXPECT_TRUE(all[0].contains("readings") && !all[0].contains("error"));
  EXPECT_NE(all[17].value("error", std::string()).find("/bodies/0/position/1"), std::string::npos);
}

TEST_F(Sweep, MistakesOfAStudyNameTheirPlace) {
  const std::pair<const char*, const char*> mistakes[][2] = {
      {{"\"duration\": 0.5", "\"durations\": 0.5"}, {"", "/duration"}},
      {{"/bodies/0/position/1", "/bodies/7/position/1"}, {"", "/parameters/0/pointer"}},
      {{"\"uniform\": [0.1, 0.4]", "\"uniform\": [0.1]"}, {"", "/parameters/3/uniform"}},
      {{"\"hits\"", "\"hit\""}, {"", "/readings/3/quantity"}},
      {{"fall.gyre.json", "rise.gyre.json"}, {"", "rise.gyre.json"}}};
  for (const auto& [edit, place] : mistakes) {
    std::string study = kStudy;
    study.replace(study.find(edit.first), std::string(edit.first).size(), edit.second);
    write("study.json", study);
    const Finished done = gyre({"study.json"});
    EXPECT_EQ(done.code, 3) << edit.second;
    EXPECT_NE(done.err.find(place.second), std::string::npos) << done.err;
    EXPECT_FALSE(fs::exists(folder_ / "study.results.jsonl"));
  }
}

#ifdef GYRE_MPI_PROGRAM
// Runs gyre-mpi on some ranks; the exit status of mpirun.
int run_ranks(int ranks, const std::string& arguments, const fs::path& folder) {
  const std::string command =
      "cd '" + folder.string() +
      "' && OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 " GYRE_MPIRUN " --oversubscribe -n " +
      std::to_string(ranks) + " '" GYRE_MPI_PROGRAM "' " + arguments + " >ranks.txt 2>&1";
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST_F(Sweep, TheNumberOfRanksChangesNoLine) {
  ASSERT_EQ(gyre({"study.json"}).code, 0);
  const std::string lines = read("study.results.jsonl");
  for (const int ranks : {1, 2, 4}) {
    const std::string name = "ranks_" + std::to_string(ranks) + ".jsonl";
    ASSERT_EQ(run_ranks(ranks, "sweep study.json --output " + name, folder_), 0) << read("ranks.txt");
    EXPECT_EQ(read(name), lines) << ranks;
  }
}
#endif

}  // namespace
}  // namespace gyre::sweep_test
