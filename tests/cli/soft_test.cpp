// Ropes, cloths and soft bodies on the command line: rows of the trace, figures, the final scene, counts, refusals.
#include "run_program.h"

#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace gyre::soft_test {
namespace {

namespace fs = std::filesystem;
using Document = nlohmann::json;

const std::string kSoftScene = R"({"gyre_scene": 1, "name": "soft", "world": {"time_step": 0.01},
  "bodies": [{"name": "ground", "type": "static", "shapes": [{"type": "plane"}]}],
  "cloths": [{"name": "cl,oth", "grid": {"size": [1, 1], "cells": [2, 1]}, "position": [0, 3, 0], "pinned": [0]}],
  "ropes": [{"name": "rope", "points": [[0, 2, 3], [1, 2, 3]], "segments": 4, "links": "springs", "attach": [{"end": 0, "body": "world"}]}],
  "soft_bodies": [{"name": "jelly", "box": {"half_extents": [0.5, 0.5, 0.5], "cells": [1, 1, 1]}, "position": [5, 0.6, 0],
                   "state": {"velocities": [[1,0,0],[1,0,0],[1,0,0],[1,0,0],[1,0,0],[1,0,0],[1,0,0],[1,0,0]]}}]})";

std::vector<std::string> rows_of(const std::string& text) {
  std::vector<std::string> rows;
  std::istringstream stream(text);
  for (std::string row; std::getline(stream, row);) rows.push_back(row);
  return rows;
}
std::vector<std::string> cells_of(const std::string& row) {
  std::vector<std::string> cells;
  std::istringstream stream(row);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

class SoftCommandLine : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("gyre_soft_" + std::to_string(getpid()) + "_" +
                                           ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    write("s.gyre.json", kSoftScene);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  std::string read(const std::string& name) const { return file_text(folder_ / name); }
  Finished gyre(const std::vector<std::string>& arguments) const { return run_program(arguments, folder_); }

  fs::path folder_;
};

TEST_F(SoftCommandLine, TheTraceHasARowPerVertex) {
  ASSERT_EQ(gyre({"simulate", "s.gyre.json", "--steps", "2", "--trace", "t.csv", "--trace-every", "2"}).code,
            0);
  const std::vector<std::string> rows = rows_of(read("t.csv"));
  // A body, then the vertices of the rope, of the cloth and of the soft body.
  ASSERT_EQ(rows.size(), 1u + 2u * (1u + 5u + 6u + 8u));
  EXPECT_EQ(rows[1].rfind("0,0,ground,", 0), 0u);
  EXPECT_EQ(rows[2], "0,0,rope[0],0,2,3,0,0,0,1,0,0,0,0,0,0,1");
  EXPECT_EQ(rows[6], "0,0,rope[4],1,2,3,0,0,0,1,0,0,0,0,0,0,1");
  EXPECT_EQ(rows[7], "0,0,\"cl,oth[0]\",-0.5,3,-0.5,0,0,0,1,0,0,0,0,0,0,1");
  EXPECT_EQ(rows[9], "0,0,\"cl,oth[2]\",0.5,3,-0.5,0,0,0,1,0,0,0,0,0,0,1");
  EXPECT_EQ(rows[10], "0,0,\"cl,oth[3]\",-0.5,3,0.5,0,0,0,1,0,0,0,0,0,0,1");
  EXPECT_EQ(rows[13].rfind("0,0,jelly[0],4.5,0.1", 0), 0u) << rows[13];
  EXPECT_EQ(rows[13].substr(rows[13].size() - 22), ",0,0,0,1,1,0,0,0,0,0,1") << rows[13];
  EXPECT_EQ(rows[22], "2,0.02,rope[0],0,2,3,0,0,0,1,0,0,0,0,0,0,1");
  // Free fall of the far end: v = -g t.
  const std::vector<std::string> end = cells_of(rows[26]);
  ASSERT_EQ(end.size(), 17u) << rows[26];
  EXPECT_EQ(end[2], "rope[4]");
  EXPECT_NEAR(std::stod(end[11]), -9.81 * 0.02, 0.01);
}

TEST_F(SoftCommandLine, FiguresCountSoftMatter) {
  ASSERT_EQ(gyre({"simulate", "s.gyre.json", "--steps", "5", "--stats", "u.csv"}).code, 0);
  const std::vector<std::string> rows = rows_of(read("u.csv"));
  ASSERT_EQ(rows.size(), 6u);
  const std::vector<std::string> names = cells_of(rows[0]), first = cells_of(rows[1]),
                                 last = cells_of(rows[5]);
  ASSERT_EQ(first.size(), names.size());
  const auto column = [&](const std::string& name) {
    return std::size_t(std::find(names.begin(), names.end(), name) - names.begin());
  };
  // The jelly weighs a tonne and slides at 1 m/s; the pinned ends take some of the others' weight.
  EXPECT_NEAR(std::stod(first[column("px")]), 1000, 1);
  EXPECT_NEAR(std::stod(first[column("py")]), -9.81 * 0.01 * 1000.3, 1);
  EXPECT_NEAR(std::stod(first[column("kinetic_energy")]), 500, 6);
  // In a step of four sub-steps the jelly falls g h^2 5 / 8.
  const double start = 9.81 * (1000 * 0.6 + 0.1 * 2 + 0.2 * 3), fallen = 1000 * 9.81 * 9.81 * 1e-4 * 5 / 8;
  EXPECT_NEAR(std::stod(first[column("potential_energy")]), start - fallen, 0.1);
  EXPECT_GT(std::stod(last[column("soft_elastic_energy")]), 0);
  EXPECT_EQ(std::stod(last[column("elastic_energy")]), 0);
  for (const char* name : {"crossings", "liquid_volume", "liquid_particles", "smoke_mass", "max_divergence",
                           "pressure_residual"})
    EXPECT_EQ(last[column(name)], "0") << name;
}

TEST_F(SoftCommandLine, CrossingsAreCountedWhereTheyAreAskedFor) {
  // Two edges of the second triangle pierce the first.
  write("x.gyre.json", R"({"gyre_scene": 1, "world": {"gravity": [0, 0, 0]},
    "meshes": {"one": {"vertices": [[-1,0,-1],[1,0,-1],[0,0,1]], "triangles": [[0,2,1]]},
               "other": {"vertices": [[0,-1,-0.5],[0,1,-0.4],[0,1,-0.3]], "triangles": [[0,1,2]]}},
    "cloths": [{"name": "a", "mesh": "one", "self_collision": false, "pinned": [0, 1, 2]},
               {"name": "b", "mesh": "other", "self_collision": false, "pinned": [0, 1, 2]}]})");
  for (const bool counted : {false, true}) {
    std::vector<std::string> arguments = {"simulate", "x.gyre.json", "--steps", "1", "--stats", "u.csv"};
    if (counted) arguments.push_back("--count-crossings");
    ASSERT_EQ(gyre(arguments).code, 0);
    const std::vector<std::string> rows = rows_of(read("u.csv"));
    EXPECT_EQ(cells_of(rows[0])[18], "crossings");
    EXPECT_EQ(cells_of(rows[1])[18], counted ? "2" : "0");
  }
  EXPECT_EQ(gyre({"simulate", "x.gyre.json", "--count-crossings"}).code, 2);
}

TEST_F(SoftCommandLine, TheFinalSceneGoesOn) {
  ASSERT_EQ(gyre({"simulate", "s.gyre.json", "--steps", "20", "--final", "f.gyre.json"}).code, 0);
  ASSERT_EQ(
      gyre({"simulate", "s.gyre.json", "--steps", "40", "--trace", "whole.csv", "--trace-every", "40"}).code,
      0);
  ASSERT_EQ(
      gyre({"simulate", "f.gyre.json", "--steps", "20", "--trace", "rest.csv", "--trace-every", "20"}).code,
      0);
  const std::vector<std::string> whole = rows_of(read("whole.csv")), rest = rows_of(read("rest.csv"));
  ASSERT_EQ(whole.size(), rest.size());
  for (std::size_t i = whole.size() / 2 + 2; i < whole.size(); ++i) {
    const std::vector<std::string> a = cells_of(whole[i]), b = cells_of(rest[i]);
    ASSERT_EQ(a.size(), b.size());
    EXPECT_EQ(a[2], b[2]);
    // The jelly slides on the ground, and what the solver remembers of that is forgotten.
    const double within = a[2].rfind("jelly", 0) == 0 ? 3e-3 : 2e-4;
    const std::size_t x = a.size() - 14;
    for (std::size_t k = x; k < x + 3; ++k)
      EXPECT_NEAR(std::stod(a[k]), std::stod(b[k]), within) << whole[i] << "\n" << rest[i];
  }
}

TEST_F(SoftCommandLine, SummariesCountThem) {
  const Finished text = gyre({"simulate", "s.gyre.json", "--steps", "1"});
  EXPECT_EQ(text.out.rfind("soft: 1 body, 0 joints, 1 rope, 1 cloth, 1 soft body (19 vertices)\n", 0), 0u)
      << text.out;
  const Document summary = Document::parse(gyre({"simulate", "s.gyre.json", "--steps", "1", "--json"}).out);
  EXPECT_EQ(summary["ropes"], 1);
  EXPECT_EQ(summary["particles"], 19);
  EXPECT_NEAR(summary["energy"].get<double>(),
              summary["kinetic_energy"].get<double>() + summary["potential_energy"].get<double>() +
                  summary["soft_elastic_energy"].get<double>(),
              1e-9 * summary["energy"].get<double>());
}

TEST_F(SoftCommandLine, InfoListsThem) {
  const Document info = Document::parse(gyre({"info", "s.gyre.json", "--json"}).out);
  ASSERT_EQ(info["ropes"].size(), 1u);
  EXPECT_EQ(info["ropes"][0]["name"], "rope");
  EXPECT_EQ(info["ropes"][0]["particles"], 5);
  EXPECT_EQ(info["cloths"][0]["name"], "cl,oth");
  EXPECT_EQ(info["cloths"][0]["particles"], 6);
  EXPECT_EQ(info["soft_bodies"][0]["particles"], 8);
  const std::string text = gyre({"info", "s.gyre.json"}).out;
  EXPECT_NE(text.find("soft body \"jelly\", 8 vertices, 1000 kg"), std::string::npos) << text;
}

TEST_F(SoftCommandLine, WhatIsRefusedIsStatusThreeAndNothingIsWritten) {
  write(
      "bad.gyre.json",
      R"({"gyre_scene": 1, "cloths": [{"name": "c", "grid": {"size": [1, 1], "cells": [2, 2]}, "pinned": [9]}]})");
  for (const char* command : {"simulate", "info"}) {
    const Finished done = gyre({command, "bad.gyre.json"});
    EXPECT_EQ(done.code, 3);
    EXPECT_EQ(done.err,
              "gyre: bad.gyre.json: /cloths/0/pinned/0: found 9, expected an integer from 0 to 8\n");
  }
  EXPECT_EQ(gyre({"simulate", "bad.gyre.json", "--trace", "t.csv", "--final", "f.json"}).code, 3);
  EXPECT_FALSE(fs::exists(folder_ / "t.csv"));
  EXPECT_FALSE(fs::exists(folder_ / "f.json"));
}

TEST_F(SoftCommandLine, AnExplosionPastAllNumbersIsStatusFour) {
  write(
      "boom.gyre.json",
      R"({"gyre_scene": 1, "world": {"substeps": 1}, "ropes": [{"name": "boom", "points": [[0, 0, 0], [1, 0, 0]],
    "segments": 8, "links": "springs", "stretch_stiffness": 1e6, "integrator": "explicit_euler", "attach": [{"end": 0, "body": "world"}]}]})");
  const Finished done = gyre({"simulate", "boom.gyre.json", "--trace", "t.csv", "--final", "f.json"});
  EXPECT_EQ(done.code, 4) << done.out;
  EXPECT_NE(done.err.find("\"boom\": soft matter 0 is no longer finite; it was frozen"), std::string::npos)
      << done.err;
  EXPECT_TRUE(fs::exists(folder_ / "t.csv"));
  EXPECT_FALSE(fs::exists(folder_ / "f.json"));
}

}  // namespace
}  // namespace gyre::soft_test
