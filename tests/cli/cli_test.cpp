// The command line as scripts see it: exit statuses, headers, files, and that a mistake leaves nothing behind.
#include "run_program.h"
#include "scene/scene_schema.h"

#include <gyre/replay.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace gyre::cli_test {
namespace {

namespace fs = std::filesystem;

const std::string kScene = R"({"gyre_scene": 1, "name": "small", "world": {"time_step": 0.01}, "bodies": [
  {"name": "ground", "type": "static", "shapes": [{"type": "plane"}]},
  {"name": "box, \"left\"", "position": [0, 2, 0], "shapes": [{"type": "box", "half_extents": [0.5, 0.5, 0.5]}]},
  {"name": "ball", "position": [2, 3, 0], "linear_velocity": [1, 0, 0], "shapes": [{"type": "sphere", "radius": 0.5}]}]})";

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

class CommandLine : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("gyre_cli_" + std::to_string(getpid()) + "_" +
                                           ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    write("s.gyre.json", kScene);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  std::string read(const std::string& name) const { return file_text(folder_ / name); }
  Finished gyre(const std::vector<std::string>& arguments) const { return run_program(arguments, folder_); }
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_))
      names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
  }
  Result<Replay> open_recording(const std::string& name) const {
    const std::string text = read(name);
    const std::byte* bytes = reinterpret_cast<const std::byte*>(text.data());
    return Replay::open(std::vector<std::byte>(bytes, bytes + text.size()));
  }
  void expect_usage(const std::vector<std::string>& arguments, const std::string& word) const {
    const Finished done = gyre(arguments);
    EXPECT_EQ(done.code, 2) << word;
    EXPECT_EQ(done.out, "");
    EXPECT_EQ(lines_of(done.err).size(), 1u) << done.err;
    EXPECT_NE(done.err.find(word), std::string::npos) << done.err;
    EXPECT_EQ(files(), std::vector<std::string>{"s.gyre.json"}) << done.err;
  }

  fs::path folder_;
};

TEST_F(CommandLine, NoCommandPrintsHelpAndIsWrongUsage) {
  const Finished done = gyre({});
  EXPECT_EQ(done.code, 2);
  EXPECT_NE(done.err.find("simulate"), std::string::npos);
  const Finished help = gyre({"--help"});
  EXPECT_EQ(help.code, 0);
  EXPECT_NE(help.out.find("simulate"), std::string::npos);
  EXPECT_EQ(gyre({"simulate", "--help"}).code, 0);
  const Finished version = gyre({"--version"});
  EXPECT_EQ(version.code, 0);
  EXPECT_EQ(version.out.rfind("gyre ", 0), 0u);
}

TEST_F(CommandLine, WrongUsageIsStatusTwoAndOneLine) {
  expect_usage({"dance"}, "dance");
  expect_usage({"simulate"}, "SCENE");
  expect_usage({"simulate", "s.gyre.json", "--fast"}, "--fast");
  expect_usage({"simulate", "s.gyre.json", "--steps", "many"}, "found many");
  expect_usage({"simulate", "s.gyre.json", "--steps", "-1"}, "found -1");
  expect_usage({"simulate", "s.gyre.json", "--steps", "1.5"}, "steps");
  expect_usage({"simulate", "s.gyre.json", "--steps", "1", "--duration", "1"}, "--steps");
  expect_usage({"simulate", "s.gyre.json", "--duration", "-2"}, "found -2");
  expect_usage({"simulate", "s.gyre.json", "--duration", "nan"}, "found nan");
  expect_usage({"simulate", "s.gyre.json", "--step", "0"}, "above 0");
  expect_usage({"simulate", "s.gyre.json", "--step", "2"}, "at most 1");
  expect_usage({"simulate", "s.gyre.json", "--substeps", "65"}, "1 to 64");
  expect_usage({"simulate", "s.gyre.json", "--threads", "-1"}, "0 to 64");
  expect_usage({"simulate", "s.gyre.json", "--solver", "magic"}, "found magic, expected one of soft_step");
  expect_usage({"simulate", "s.gyre.json", "--integrator", "rk5"}, "semi_implicit_euler");
  expect_usage({"simulate", "s.gyre.json", "--broad-phase", "tree"}, "found tree, expected one of bvh");
  expect_usage({"simulate", "s.gyre.json", "--stepping", "often"}, "error_controlled");
  expect_usage({"simulate", "s.gyre.json", "--trace-every", "0", "--trace", "t.csv"}, "1 to");
  expect_usage({"simulate", "s.gyre.json", "--trace", "t.csv", "--stats", "t.csv"}, "same file");
  expect_usage({"simulate", "s.gyre.json", "--explain", "nobody"}, "no body \"nobody\"");
  expect_usage({"simulate", "s.gyre.json", "--explain", ""}, "no body \"\"");
  expect_usage({"simulate", "s.gyre.json", "--trace", "./s.gyre.json"}, "overwrite the scene");
  expect_usage({"simulate", "s.gyre.json", "--record-as", "poses"}, "--record");
  expect_usage({"simulate", "s.gyre.json", "--record", "r.gyrec", "--record-as", "film"},
               "found film, expected one of all");
  expect_usage({"simulate", "s.gyre.json", "--record", "r.gyrec", "--record-every", "0"}, "1 to");
  expect_usage({"simulate", "s.gyre.json", "--record", "r.gyrec", "--record-accuracy", "0"}, "1e-12 to");
  expect_usage({"simulate", "s.gyre.json", "--record", "r.gyrec", "--record-hash-every", "0"}, "from 1");
  expect_usage({"info"}, "SCENE");
  expect_usage({"schema", "more"}, "more");
}

TEST_F(CommandLine, AnInvalidSceneIsStatusThreeAndNothingIsWritten) {
  write("bad.gyre.json",
        R"({"gyre_scene": 1, "bodies": [{"name": "b", "shapes": [{"type": "sphere", "radius": -1}]}]})");
  const std::vector<std::string> before = files();
  for (const char* command : {"simulate", "info"}) {
    const Finished done = gyre({command, "bad.gyre.json"});
    EXPECT_EQ(done.code, 3);
    EXPECT_EQ(done.out, "");
    EXPECT_EQ(done.err,
              "gyre: bad.gyre.json: /bodies/0/shapes/0/radius: found -1, expected a number above 0\n");
    EXPECT_EQ(gyre({command, "none.gyre.json"}).code, 3);
    EXPECT_EQ(gyre({command, "."}).code, 3);
  }
  const Finished done = gyre({"simulate", "bad.gyre.json", "--trace", "t.csv", "--stats", "u.csv", "--final",
                              "f.json", "--record", "r.gyrec"});
  EXPECT_EQ(done.code, 3);
  EXPECT_EQ(files(), before);
}

TEST_F(CommandLine, WhatTheEngineRefusesIsStatusThreeToo) {
  write("flat.gyre.json", R"({"gyre_scene": 1, "bodies": [{"name": "b", "shapes": [
      {"type": "convex_hull", "points": [[0,0,0],[1,0,0],[0,0,1],[1,0,1]]}]}]})");
  const Finished done = gyre({"simulate", "flat.gyre.json", "--trace", "t.csv"});
  EXPECT_EQ(done.code, 3);
  EXPECT_NE(done.err.find("/bodies/0/shapes/0/points"), std::string::npos) << done.err;
  EXPECT_FALSE(fs::exists(folder_ / "t.csv"));
}

TEST_F(CommandLine, AnOutputThatCannotBeWrittenIsStatusThreeAndLeavesNothing) {
  const Finished done =
      gyre({"simulate", "s.gyre.json", "--steps", "3", "--trace", "t.csv", "--stats", "none/u.csv"});
  EXPECT_EQ(done.code, 3);
  EXPECT_NE(done.err.find("none/u.csv"), std::string::npos) << done.err;
  EXPECT_EQ(files(), std::vector<std::string>{"s.gyre.json"});
  EXPECT_EQ(gyre({"simulate", "s.gyre.json", "--final", "."}).code, 3);
  if (fs::exists("/dev/full")) {
    EXPECT_EQ(
        gyre({"simulate", "s.gyre.json", "--steps", "3", "--trace", "/dev/full", "--stats", "u.csv"}).code,
        3);
    EXPECT_EQ(files(), std::vector<std::string>{"s.gyre.json"});
  }
}

TEST_F(CommandLine, TraceHasARowPerBodyAndTracedStep) {
  ASSERT_EQ(gyre({"simulate", "s.gyre.json", "--steps", "10", "--trace", "t.csv", "--trace-every", "5"}).code,
            0);
  const std::vector<std::string> lines = lines_of(read("t.csv"));
  ASSERT_EQ(lines.size(), 1u + 3u * 3u);
  EXPECT_EQ(lines[0], "step,time,body,px,py,pz,qx,qy,qz,qw,vx,vy,vz,wx,wy,wz,awake");
  EXPECT_EQ(lines[1], "0,0,ground,0,0,0,0,0,0,1,0,0,0,0,0,0,0");
  EXPECT_EQ(lines[2], "0,0,\"box, \"\"left\"\"\",0,2,0,0,0,0,1,0,0,0,0,0,0,1");
  EXPECT_EQ(lines[3], "0,0,ball,2,3,0,0,0,0,1,1,0,0,0,0,0,1");
  EXPECT_EQ(lines[4].rfind("5,0.05,ground,", 0), 0u) << lines[4];
  ASSERT_EQ(lines[9].rfind("10,0.1,ball,", 0), 0u) << lines[9];
  EXPECT_NEAR(std::stod(lines[9].substr(12)), 2.1, 1e-6);
}

TEST_F(CommandLine, StatsHaveARowAStep) {
  ASSERT_EQ(gyre({"simulate", "s.gyre.json", "--steps", "7", "--stats", "u.csv"}).code, 0);
  const std::vector<std::string> lines = lines_of(read("u.csv"));
  ASSERT_EQ(lines.size(), 8u);
  EXPECT_EQ(lines[0],
            "step,time,step_ms,bodies,awake,pairs,contacts,max_penetration,kinetic_energy,potential_energy,"
            "elastic_energy,px,py,pz,"
            "lx,ly,lz,soft_elastic_energy,crossings,liquid_volume,liquid_particles,smoke_mass,max_divergence,"
            "pressure_residual");
  EXPECT_EQ(lines[1].rfind("1,0.01,", 0), 0u);
  EXPECT_EQ(lines[7].rfind("7,0.07,", 0), 0u);
  EXPECT_EQ(std::count(lines[7].begin(), lines[7].end(), ','), 23);
}

TEST_F(CommandLine, TheHashIsOneLineAndTheSameForAnyThreads) {
  const Finished one =
      gyre({"simulate", "s.gyre.json", "--steps", "100", "--hash", "--quiet", "--threads", "1"});
  ASSERT_EQ(one.code, 0);
  ASSERT_EQ(one.out.size(), 17u) << one.out;
  EXPECT_EQ(one.out.find_first_not_of("0123456789abcdef"), 16u);
  for (const char* threads : {"0", "2", "4"}) {
    EXPECT_EQ(
        gyre({"simulate", "s.gyre.json", "--steps", "100", "--hash", "--quiet", "--threads", threads}).out,
        one.out);
  }
  for (const char* kind :
       {"bvh", "grid", "octree", "quadtree", "kd_tree", "bsp_tree", "sweep_and_prune", "brute_force"}) {
    EXPECT_EQ(
        gyre({"simulate", "s.gyre.json", "--steps", "100", "--hash", "--quiet", "--broad-phase", kind}).out,
        one.out)
        << kind;
  }
  EXPECT_NE(gyre({"simulate", "s.gyre.json", "--steps", "101", "--hash", "--quiet"}).out, one.out);
  EXPECT_NE(gyre({"simulate", "s.gyre.json", "--steps", "100", "--hash", "--quiet", "--substeps", "8"}).out,
            one.out);
}

TEST_F(CommandLine, DurationAndStepsMeanTheSame) {
  const auto steps_of = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"simulate", "s.gyre.json", "--json"});
    const Finished done = gyre(arguments);
    EXPECT_EQ(done.code, 0);
    const std::size_t at = done.out.find("\"steps\": ");
    return at == std::string::npos ? -1 : std::atoi(done.out.c_str() + at + 9);
  };
  EXPECT_EQ(steps_of({}), 1000);  // 10 s
  EXPECT_EQ(steps_of({"--duration", "0.5"}), 50);
  EXPECT_EQ(steps_of({"--duration", "1", "--step", "0.016666667"}), 60);
  EXPECT_EQ(steps_of({"--duration", "1", "--step", "0.3"}), 4);
  EXPECT_EQ(steps_of({"--steps", "3"}), 3);
  EXPECT_EQ(steps_of({"--steps", "0"}), 0);
  EXPECT_EQ(steps_of({"--duration", "0"}), 0);
}

TEST_F(CommandLine, JsonSummaryHasWhatWasPromised) {
  const Finished done = gyre({"simulate", "s.gyre.json", "--steps", "60", "--json", "--hash", "--quiet"});
  ASSERT_EQ(done.code, 0);
  EXPECT_EQ(done.err, "");
  EXPECT_EQ(done.out.front(), '{');
  EXPECT_EQ(done.out.substr(done.out.size() - 2), "}\n");
  for (const char* key :
       {"\"steps\": 60", "\"time\": 0.6", "\"bodies\": 3", "\"contacts\": ", "\"step_ms\": {\"median\": ",
        "\"mean\": ", "\"p99\": ", "\"max\": ", "\"energy\": ", "\"hash\": \""}) {
    EXPECT_NE(done.out.find(key), std::string::npos) << key << "\n" << done.out;
  }
}

TEST_F(CommandLine, ExplainSaysWhyABodyIsAwake) {
  const std::string left = R"(box, "left")";
  Finished done =
      gyre({"simulate", "s.gyre.json", "--steps", "10", "--quiet", "--explain", left, "--explain", "ground"});
  EXPECT_EQ(done.code, 0) << done.err;
  std::vector<std::string> lines = lines_of(done.out);
  ASSERT_EQ(lines.size(), 2u) << done.out;
  EXPECT_EQ(lines[0].rfind(left + " is awake because nothing touches it", 0), 0u) << lines[0];
  EXPECT_EQ(lines[1], "ground is fixed: it never moves.");
  done = gyre({"simulate", "s.gyre.json", "--duration", "3", "--quiet", "--explain", left});
  EXPECT_NE(done.out.find(left + " is asleep."), std::string::npos) << done.out;
  EXPECT_NE(done.out.find("It touches ground (4 points, 9.81e+03 N"), std::string::npos) << done.out;
  done = gyre({"simulate", "s.gyre.json", "--duration", "3", "--json", "--explain", "ball"});
  EXPECT_NE(done.out.find(R"("explanations": {)"), std::string::npos) << done.out;
}

TEST_F(CommandLine, TimesListsTheStages) {
  Finished done = gyre({"simulate", "s.gyre.json", "--steps", "20", "--quiet", "--times"});
  EXPECT_EQ(done.code, 0) << done.err;
  const std::vector<std::string> lines = lines_of(done.out);
  ASSERT_EQ(lines.size(), 12u) << done.out;
  EXPECT_EQ(lines[0], "stages of a step, mean:");
  EXPECT_EQ(lines[3].rfind("  flow ", 0), 0u);
  EXPECT_EQ(lines[4].rfind("  touch_soft ", 0), 0u);
  EXPECT_EQ(lines[5].rfind("  collide ", 0), 0u);
  done = gyre({"simulate", "s.gyre.json", "--steps", "20", "--json", "--times"});
  EXPECT_NE(done.out.find(R"("stage_ms": {"refit": )"), std::string::npos) << done.out;
  done = gyre({"simulate", "s.gyre.json", "--steps", "0", "--quiet", "--times"});
  EXPECT_EQ(done.out, "") << "no step, no times";
}

TEST_F(CommandLine, QuietSaysNothing) {
  const Finished done = gyre({"simulate", "s.gyre.json", "--steps", "5", "--quiet"});
  EXPECT_EQ(done.code, 0);
  EXPECT_EQ(done.out, "");
  EXPECT_EQ(done.err, "");
  EXPECT_NE(gyre({"simulate", "s.gyre.json", "--steps", "5"}).out.find("5 steps"), std::string::npos);
}

TEST_F(CommandLine, TheFinalSceneCanBeSimulatedOn) {
  ASSERT_EQ(gyre({"simulate", "s.gyre.json", "--steps", "20", "--final", "f.gyre.json"}).code, 0);
  ASSERT_EQ(gyre({"simulate", "f.gyre.json", "--steps", "10", "--trace", "rest.csv"}).code, 0);
  ASSERT_EQ(gyre({"simulate", "s.gyre.json", "--steps", "30", "--trace", "whole.csv"}).code, 0);
  const std::vector<std::string> rest = lines_of(read("rest.csv")), whole = lines_of(read("whole.csv"));
  // Still in the air, where nothing but rounding distinguishes the two: compare the place of the ball.
  const auto height = [](const std::string& line) {
    std::istringstream cells(line);
    std::string cell;
    for (int i = 0; i < 5; ++i) std::getline(cells, cell, ',');
    return std::atof(cell.c_str());
  };
  EXPECT_NEAR(height(rest.back()), height(whole.back()), 1e-6);
  EXPECT_LT(height(whole.back()), 2.7);
  // In place: the final scene may take the place of the one it goes on from.
  EXPECT_EQ(gyre({"simulate", "f.gyre.json", "--steps", "1", "--final", "f.gyre.json"}).code, 0);
}

TEST_F(CommandLine, AStateThatIsNotFiniteIsStatusFourAndKeepsWhatWasRecorded) {
  write("wild.gyre.json", R"({"gyre_scene": 1, "bodies": [{"name": "wild", "mass": 1e-30,
      "shapes": [{"type": "sphere", "radius": 0.5}], "forces": [{"force": [3e38, 0, 0], "start": 0.1}]}]})");
  const Finished done =
      gyre({"simulate", "wild.gyre.json", "--trace", "t.csv", "--stats", "u.csv", "--final", "f.json"});
  EXPECT_EQ(done.code, 4) << done.err;
  EXPECT_NE(done.err.find("no longer finite"), std::string::npos) << done.err;
  EXPECT_NE(done.err.find("\"wild\""), std::string::npos) << done.err;
  EXPECT_NE(done.err.find("kept"), std::string::npos) << done.err;
  EXPECT_GT(lines_of(read("t.csv")).size(), 5u);
  EXPECT_GT(lines_of(read("u.csv")).size(), 5u);
  EXPECT_EQ(read("t.csv").find("nan"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder_ / "f.json"));
}

TEST_F(CommandLine, CtrlCIsStatus130AndKeepsWhatWasRecorded) {
  const Finished done = run_program(
      {"simulate", "s.gyre.json", "--duration", "1e9", "--trace", "t.csv", "--trace-every", "100"}, folder_,
      "t.csv");
  EXPECT_EQ(done.code, 130) << done.err;
  EXPECT_NE(done.err.find("interrupted"), std::string::npos) << done.err;
  EXPECT_EQ(lines_of(read("t.csv"))[0].rfind("step,time,body", 0), 0u);
  EXPECT_EQ(read("t.csv").back(), '\n');
  EXPECT_EQ(files(), (std::vector<std::string>{"s.gyre.json", "t.csv"}));
}

TEST_F(CommandLine, ARecordingReplaysToTheSameHash) {
  const Finished done =
      gyre({"simulate", "s.gyre.json", "--steps", "50", "--record", "r.gyrec", "--hash", "--quiet"});
  ASSERT_EQ(done.code, 0) << done.err;
  Result<Replay> replay = open_recording("r.gyrec");
  ASSERT_TRUE(replay) << replay.error().message;
  EXPECT_FALSE(replay->truncated());
  EXPECT_EQ(replay->step_count(), 50u);
  bool matches = true;
  int steps = 0;
  for (; replay->step(&matches); ++steps) ASSERT_TRUE(matches) << steps;
  EXPECT_EQ(steps, 50);
  char hash[20];
  std::snprintf(hash, sizeof hash, "%016llx\n", static_cast<unsigned long long>(replay->world().hash()));
  EXPECT_EQ(hash, done.out);
}

TEST_F(CommandLine, ARecordingCanBeLookedAtWithNamesAndColours) {
  ASSERT_EQ(gyre({"simulate", "s.gyre.json", "--steps", "50", "--record", "r.gyrec", "--quiet"}).code, 0);
  const std::string text = read("r.gyrec");
  const std::byte* const bytes = reinterpret_cast<const std::byte*>(text.data());
  Result<PoseTrack> track = PoseTrack::open({bytes, bytes + text.size()});
  ASSERT_TRUE(track) << track.error().message;
  ASSERT_EQ(track->frame_count(), 51u);
  EXPECT_NEAR(track->time(50), 0.5, 1e-6);
  EXPECT_EQ(track->label(track->frame().ids[1]).name, "box, \"left\"");
  EXPECT_EQ(track->label(track->frame().ids[1]).colors.size(), 1u);
  EXPECT_NE(track->note("scene").find("\"small\""), std::string_view::npos);
  ASSERT_EQ(track->seek(50).code, ErrorCode::none);
  EXPECT_LT(track->frame().poses[2].position.y, 2.0);
}

// tools/recording_to_csv.py was written from docs/recording.md and shares nothing with the engine.
TEST_F(CommandLine, ARecordingIsAsItsPageSays) {
  if (std::system("python3 --version > /dev/null 2>&1") != 0) GTEST_SKIP() << "no python3";
  ASSERT_EQ(gyre({"simulate", "s.gyre.json", "--steps", "150", "--record", "r.gyrec", "--trace", "t.csv",
                  "--quiet"})
                .code,
            0);
  const std::string command = "python3 '" GYRE_SOURCE_DIR "/tools/recording_to_csv.py' '" +
                              (folder_ / "r.gyrec").string() + "' > '" + (folder_ / "p.csv").string() + "'";
  ASSERT_EQ(std::system(command.c_str()), 0);
  const std::vector<std::string> read_back = lines_of(read("p.csv")), traced = lines_of(read("t.csv"));
  ASSERT_EQ(read_back.size(), traced.size());
  const auto cells = [](const std::string& line) {
    // From the end: names may hold commas.
    std::vector<std::string> found;
    std::string cell;
    std::istringstream stream(line);
    while (std::getline(stream, cell, ',')) found.push_back(cell);
    return std::vector<std::string>(found.rbegin(), found.rend());
  };
  for (std::size_t i = 1; i < traced.size(); ++i) {
    const std::vector<std::string> a = cells(read_back[i]), b = cells(traced[i]);
    ASSERT_GE(a.size(), 11u);
    ASSERT_EQ(a[0], b[0]) << traced[i];                // awake
    ASSERT_EQ(a.back(), b.back());                     // step
    ASSERT_EQ(a[8].substr(0, 4), b[14].substr(0, 4));  // the end of the name
    double same = 0, turned = 0;
    for (std::size_t part = 1; part <= 4; ++part) {
      const double u = std::atof(a[part].c_str()), v = std::atof(b[part + 6].c_str());
      same = std::max(same, std::abs(u - v)), turned = std::max(turned, std::abs(u + v));
    }
    ASSERT_LT(std::min(same, turned), 3e-5) << read_back[i] << "\n" << traced[i];
    for (std::size_t axis = 5; axis <= 7; ++axis)
      ASSERT_NEAR(std::atof(a[axis].c_str()), std::atof(b[axis + 6].c_str()), 6.2e-5) << read_back[i];
  }
}

TEST_F(CommandLine, VerticesOfARecordingAreAsItsPageSays) {
  if (std::system("python3 --version > /dev/null 2>&1") != 0) GTEST_SKIP() << "no python3";
  struct File : ByteSink {
    std::ofstream stream;
    bool write(std::span<const std::byte> bytes) override {
      return bool(stream.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size())));
    }
  } file;
  file.stream.open(folder_ / "r.gyrec", std::ios::binary);
  World world = *World::create();
  const SoftId sheet = world.add_cloth({.grid = ClothGrid{.size = {0.4f, 0.4f}, .cells = {4, 4}}});
  world.pin(sheet, 0);
  SoftId line = world.add_rope({.points = {{1, 0, 0}, {2, 0, 0}}, .segments = 5});
  Recorder recorder(world, file, {.commands = false});
  recorder.label_soft(sheet, "a, b");
  std::vector<DVec3> places;
  const auto look = [&] {
    for (const SoftId soft : {sheet, line})
      for (std::size_t i = 0; i < world.vertices(soft).size(); ++i) places.push_back(world.vertices(soft).position(i));
  };
  look();
  for (int step = 0; step < 80; ++step) {
    if (step == 40) {
      world.remove_soft(line);
      line = world.add_rope({.points = {{1, 1, 0}, {2, 0, 3}}, .segments = 7});
    }
    world.step(1.0f / 60.0f);
    look();
  }
  ASSERT_TRUE(recorder.finish());
  file.stream.close();
  const std::string command = "python3 '" GYRE_SOURCE_DIR "/tools/recording_to_csv.py' --vertices '" +
                              (folder_ / "r.gyrec").string() + "' > '" + (folder_ / "v.csv").string() + "'";
  ASSERT_EQ(std::system(command.c_str()), 0);
  const std::vector<std::string> lines = lines_of(read("v.csv"));
  ASSERT_EQ(lines.size(), places.size() + 1);
  EXPECT_EQ(lines[1].substr(0, 13), "0,0,\"a, b\",0,");
  for (std::size_t i = 0; i < places.size(); ++i) {
    std::size_t end = lines[i + 1].size();
    for (int axis = 2; axis >= 0; --axis) {
      const std::size_t comma = lines[i + 1].rfind(',', end - 1);
      ASSERT_NEAR(std::atof(lines[i + 1].c_str() + comma + 1), places[i][axis], 6.2e-5) << lines[i + 1];
      end = comma;
    }
  }
}

TEST_F(CommandLine, ARecordingHoldsWhatWasAskedFor) {
  const auto size = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"simulate", "s.gyre.json", "--steps", "60",
                                          "--record", "r.gyrec",     "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(gyre(arguments).code, 0);
    return read("r.gyrec").size();
  };
  const auto track = [&] {
    const std::string text = read("r.gyrec");
    const std::byte* const bytes = reinterpret_cast<const std::byte*>(text.data());
    return PoseTrack::open({bytes, bytes + text.size()});
  };
  const std::size_t all = size({}), poses = size({"--record-as", "poses"});
  EXPECT_FALSE(open_recording("r.gyrec"));
  EXPECT_TRUE(track());
  const std::size_t commands = size({"--record-as", "commands"});
  EXPECT_TRUE(open_recording("r.gyrec"));
  EXPECT_FALSE(track());
  EXPECT_LT(size({"--record-as", "commands", "--record-hash-every", "1"}), commands) << "one hash after the last step";
  EXPECT_GT(all, poses);
  EXPECT_GT(all, commands);
  EXPECT_LT(size({"--record-as", "poses", "--record-every", "4"}), poses / 2);
  EXPECT_EQ(track()->frame_count(), 16u);
  EXPECT_GT(size({"--record-as", "poses", "--record-accuracy", "1e-9"}), poses);
  EXPECT_LE(track()->accuracy().position, 1e-9);
}

TEST_F(CommandLine, ARecordingThatWasStoppedIsWhole) {
  const Finished done = run_program({"simulate", "s.gyre.json", "--duration", "1e9", "--record", "r.gyrec"},
                                    folder_, "r.gyrec");
  EXPECT_EQ(done.code, 130) << done.err;
  Result<Replay> replay = open_recording("r.gyrec");
  ASSERT_TRUE(replay) << replay.error().message;
  EXPECT_FALSE(replay->truncated());
  EXPECT_GT(replay->step_count(), 0u);
}

TEST_F(CommandLine, InfoShowsMassProperties) {
  const Finished text = gyre({"info", "s.gyre.json"});
  EXPECT_EQ(text.code, 0);
  EXPECT_NE(text.out.find("box, \"left\""), std::string::npos);
  EXPECT_NE(text.out.find("1000 kg"), std::string::npos) << text.out;
  const Finished json = gyre({"info", "s.gyre.json", "--json"});
  EXPECT_EQ(json.code, 0);
  for (const char* key :
       {"\"bodies\": 3", "\"mass\": 1000", "\"mass\": null", "\"center_of_mass\": [0, 0, 0]",
        "\"inertia\": [166.66", "\"principal_moments\": [166.66", "\"principal_axes\": [[",
        "\"shapes_by_type\": {\"sphere\": 1"}) {
    EXPECT_NE(json.out.find(key), std::string::npos) << key << "\n" << json.out;
  }
}

TEST_F(CommandLine, InfoShowsHowTightBoundsOfMeshesAre) {
  // A tetrahedron of a cube's corners fills a third of the cube.
  write("m.gyre.json", R"({"gyre_scene": 1, "bodies": [], "meshes": {
      "tetra": {"vertices": [[0,0,0], [1,1,0], [1,0,1], [0,1,1]], "triangles": [[0,1,2], [0,2,3], [0,3,1], [1,3,2]]},
      "sheet": {"vertices": [[0,0,0], [2,0,0], [0,3,0]], "triangles": [[0,1,2]]}}})");
  const Finished text = gyre({"info", "m.gyre.json"});
  EXPECT_EQ(text.code, 0) << text.err;
  EXPECT_NE(text.out.find("mesh \"tetra\", 4 vertices, 4 triangles"), std::string::npos) << text.out;
  EXPECT_NE(text.out.find("no volume"), std::string::npos) << text.out;
  const Finished json = gyre({"info", "m.gyre.json", "--json"});
  EXPECT_EQ(json.code, 0);
  for (const char* key : {"\"volume\": 0.333333", "\"box\": {\"volume\": 1, \"surface_area\": 6, \"times_hull\": 3, ",
                          "\"hull\": null", "\"times_mesh\": null", "\"k_dop_26\": {"}) {
    EXPECT_NE(json.out.find(key), std::string::npos) << key << "\n" << json.out;
  }
}

TEST_F(CommandLine, SchemaIsPrinted) {
  const Finished done = gyre({"schema"});
  EXPECT_EQ(done.code, 0);
  EXPECT_EQ(done.out, scene_schema());
}

TEST_F(CommandLine, OutputsReplaceFilesOnlyWhenWhole) {
  write("t.csv", "old");
  EXPECT_EQ(gyre({"simulate", "none.gyre.json", "--trace", "t.csv"}).code, 3);
  EXPECT_EQ(read("t.csv"), "old");
  EXPECT_EQ(gyre({"simulate", "s.gyre.json", "--steps", "1", "--trace", "t.csv"}).code, 0);
  EXPECT_EQ(read("t.csv").rfind("step,", 0), 0u);
  EXPECT_EQ(gyre({"simulate", "s.gyre.json", "--steps", "1", "--trace", "/dev/null"}).code, 0);
}

TEST_F(CommandLine, BenchPrintsTimesBesideQuality) {
  const Finished text = gyre({"bench", "tower", "chain", "--steps", "20", "--stages"});
  EXPECT_EQ(text.code, 0) << text.err;
  const std::vector<std::string> lines = lines_of(text.out);
  ASSERT_GE(lines.size(), 5u);
  EXPECT_NE(lines[0].find("overlap mm"), std::string::npos);
  EXPECT_EQ(lines[1].substr(0, 5), "tower");
  EXPECT_NE(text.out.find("  solve "), std::string::npos) << text.out;
  const Finished json = gyre({"bench", "tower", "--steps", "20", "--rounds", "2", "--json"});
  EXPECT_EQ(json.code, 0) << json.err;
  EXPECT_NE(json.out.find("\"scene\": \"tower\""), std::string::npos) << json.out;
  EXPECT_NE(json.out.find("\"rounds\": 2"), std::string::npos) << json.out;
  const Finished wrong = gyre({"bench", "towre"});
  EXPECT_EQ(wrong.code, 2);
  EXPECT_EQ(wrong.out, "");
  EXPECT_NE(wrong.err.find("no scene 'towre'"), std::string::npos) << wrong.err;
}

}  // namespace
}  // namespace gyre::cli_test
