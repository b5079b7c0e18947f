// Gases and liquids on the command line: probes, figures, the final scene, counts, refusals.
#include "run_program.h"

#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace gyre::fluid_test {
namespace {

namespace fs = std::filesystem;
using FluidDocument = nlohmann::json;

// A ball of smoke in a closed box without gravity stays where it is; vortices in another one decay.
const std::string kGasScene =
    R"({"gyre_scene": 1, "name": "gases", "world": {"time_step": 0.01, "gravity": [0, 0, 0]},
  "gases": [
    {"name": "ai,r", "bounds": [[0, 0, 0], [2, 1, 1]], "cells": [16, 8, 8], "boundary": "closed",
     "emitters": [{"position": [0.5, 0.5, 0.5], "radius": 0.3, "density": 2, "temperature": 350, "end": 0.015}],
     "probes": [{"name": "in smoke", "position": [0.5, 0.5, 0.5]}, {"name": "far", "position": [1.9, 0.5, 0.5]}]},
    {"name": "vortices", "bounds": [[5, 0, 0], [6, 1, 0.1]], "cells": [32, 32, 1], "density": 1, "viscosity": 0.02, "boundary": "periodic",
     "initial_velocity": {"type": "taylor_green", "amplitude": 0.5, "wave_number": [6.283185307, 6.283185307, 0]},
     "probes": [{"name": "p", "position": [5.25, 0, 0.05]}]}]})";

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> rows;
  std::istringstream stream(text);
  for (std::string row; std::getline(stream, row);) rows.push_back(row);
  return rows;
}
// The last `count` cells of a row, none of which is quoted.
std::vector<std::string> last_cells(const std::string& row, std::size_t count) {
  std::vector<std::string> cells;
  std::istringstream stream(row);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  if (cells.size() > count) cells.erase(cells.begin(), cells.end() - std::ptrdiff_t(count));
  return cells;
}

class FluidCommandLine : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("gyre_fluid_" + std::to_string(getpid()) + "_" +
                                           ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    write("g.gyre.json", kGasScene);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  std::string read(const std::string& name) const { return file_text(folder_ / name); }
  Finished gyre(const std::vector<std::string>& arguments) const { return run_program(arguments, folder_); }

  fs::path folder_;
};

TEST_F(FluidCommandLine, ProbesHaveARowEachInEveryTracedStep) {
  ASSERT_EQ(gyre({"simulate", "g.gyre.json", "--steps", "4", "--probes", "p.csv", "--trace-every", "2"}).code,
            0);
  const std::vector<std::string> rows = lines_of(read("p.csv"));
  ASSERT_EQ(rows.size(), 1u + 3u * 3u);
  EXPECT_EQ(rows[0], "step,time,domain,probe,vx,vy,vz,pressure,density,temperature,surface");
  EXPECT_EQ(rows[1], "0,0,\"ai,r\",in smoke,0,0,0,0,0,293.149994,nan");
  EXPECT_EQ(rows[2], "0,0,\"ai,r\",far,0,0,0,0,0,293.149994,nan");
  EXPECT_EQ(rows[4].rfind("2,0.02,\"ai,r\",in smoke,", 0), 0u) << rows[4];
  const std::vector<std::string> held = last_cells(rows[7], 4), far = last_cells(rows[8], 4);
  EXPECT_NEAR(std::stod(held[1]), 2.0, 1e-5);
  EXPECT_NEAR(std::stod(held[2]), 350.0, 1e-3);
  EXPECT_EQ(held[3], "nan");
  EXPECT_EQ(std::stod(far[1]), 0.0);
}

TEST_F(FluidCommandLine, ProbedVorticesDecayAsTheyShould) {
  ASSERT_EQ(gyre({"simulate", "g.gyre.json", "--steps", "50", "--probes", "p.csv"}).code, 0);
  const double nu = 0.02, k = 2 * 3.14159265358979;
  int seen = 0;
  for (const std::string& row : lines_of(read("p.csv"))) {
    if (row.find(",vortices,p,") == std::string::npos) continue;
    ++seen;
    const double time = std::stod(row.substr(row.find(',') + 1));
    EXPECT_NEAR(std::stod(last_cells(row, 7)[0]), 0.5 * std::exp(-2 * nu * k * k * time), 0.005) << row;
  }
  EXPECT_EQ(seen, 51);
}

TEST_F(FluidCommandLine, EventsTellWhatEntersAGas) {
  write("e.gyre.json",
        R"({"gyre_scene": 1, "name": "events", "world": {"time_step": 0.01, "gravity": [0, 0, 0]},
    "bodies": [{"name": "ball", "position": [-0.25, 0.5, 0.5], "linear_velocity": [10, 0, 0],
                "shapes": [{"type": "sphere", "radius": 0.1, "density": 1000}]}],
    "gases": [{"name": "air", "bounds": [[0, 0, 0], [1, 1, 1]], "cells": [4, 4, 4]}]})");
  ASSERT_EQ(gyre({"simulate", "e.gyre.json", "--steps", "20", "--events", "e.csv"}).code, 0);
  const std::vector<std::string> rows = lines_of(read("e.csv"));
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0], "step,time,event,first,second,value");
  EXPECT_EQ(rows[1], "2,0.02,fluid_enter,ball,air,-1");
  EXPECT_EQ(rows[2], "14,0.14,fluid_leave,ball,air,-1");
}

TEST_F(FluidCommandLine, FiguresCountSmokeAndDivergence) {
  ASSERT_EQ(gyre({"simulate", "g.gyre.json", "--steps", "5", "--stats", "u.csv"}).code, 0);
  const std::vector<std::string> rows = lines_of(read("u.csv"));
  ASSERT_EQ(rows.size(), 6u);
  const std::string tail =
      ",soft_elastic_energy,crossings,liquid_volume,liquid_particles,smoke_mass,max_divergence,pressure_"
      "residual";
  ASSERT_GT(rows[0].size(), tail.size());
  EXPECT_EQ(rows[0].substr(rows[0].size() - tail.size()), tail);
  const std::vector<std::string> first = last_cells(rows[1], 5), last = last_cells(rows[5], 5);
  EXPECT_EQ(first[0], "0");
  EXPECT_EQ(first[1], "0");
  // A ball of radius 0.3, cells of 0.125.
  EXPECT_NEAR(std::stod(first[2]), 2 * 4.18879 * 0.027, 0.04);
  EXPECT_NEAR(std::stod(last[2]), std::stod(first[2]), 1e-4);
  EXPECT_LT(std::stod(last[3]), 0.02);
  EXPECT_LT(std::stod(last[4]), 0.02);
}

TEST_F(FluidCommandLine, AGasGoesOnFromTheFinalScene) {
  ASSERT_EQ(gyre({"simulate", "g.gyre.json", "--steps", "10", "--final", "f.gyre.json"}).code, 0);
  ASSERT_EQ(
      gyre({"simulate", "g.gyre.json", "--steps", "20", "--probes", "whole.csv", "--trace-every", "20"}).code,
      0);
  ASSERT_EQ(
      gyre({"simulate", "f.gyre.json", "--steps", "10", "--probes", "rest.csv", "--trace-every", "10"}).code,
      0);
  const std::vector<std::string> whole = lines_of(read("whole.csv")), rest = lines_of(read("rest.csv"));
  ASSERT_EQ(whole.size(), 7u);
  ASSERT_EQ(rest.size(), 7u);
  for (std::size_t i = 4; i < 7; ++i) {
    EXPECT_EQ(last_cells(whole[i], 7), last_cells(rest[i], 7)) << whole[i] << "\n" << rest[i];
  }
  EXPECT_NE(read("f.gyre.json").find("\"state\""), std::string::npos);
}

TEST_F(FluidCommandLine, SummaryAndInfoCountFluids) {
  const Finished text = gyre({"simulate", "g.gyre.json", "--steps", "1"});
  EXPECT_EQ(text.out.rfind("gases: 0 bodies, 0 joints, 2 gases\n", 0), 0u) << text.out;
  const FluidDocument summary =
      FluidDocument::parse(gyre({"simulate", "g.gyre.json", "--steps", "1", "--json"}).out);
  EXPECT_EQ(summary["gases"], 2);
  EXPECT_EQ(summary["liquids"], 0);
  EXPECT_EQ(summary["liquid_particles"], 0);
  EXPECT_GT(summary["smoke_mass"].get<double>(), 0.1);
  const FluidDocument info = FluidDocument::parse(gyre({"info", "g.gyre.json", "--json"}).out);
  ASSERT_EQ(info["gases"].size(), 2u);
  EXPECT_EQ(info["gases"][0]["name"], "ai,r");
  EXPECT_EQ(info["gases"][0]["cells"], (std::vector<int>{16, 8, 8}));
  EXPECT_EQ(info["liquids"].size(), 0u);
  const std::string words = gyre({"info", "g.gyre.json"}).out;
  EXPECT_NE(words.find("fluids  2 gases, 0 liquids\n"), std::string::npos) << words;
  EXPECT_NE(words.find("gas \"vortices\", 32 x 32 x 1 cells of (0.03125, 0.03125, 0.1) m\n"),
            std::string::npos)
      << words;
}

// Still water in a plane box: 8 x 4 full cells of four particles.
const std::string kWaterScene =
    R"({"gyre_scene": 1, "name": "water", "liquids": [{"name": "tank", "bounds": [[0, 0, 0], [0.8, 0.8, 0.1]],
  "cell_size": 0.1, "fill": [{"box": [[0, 0, 0], [0.8, 0.4, 0.1]]}], "probes": [{"name": "p", "position": [0.4, 0.1, 0.05]}]}]})";

TEST_F(FluidCommandLine, LiquidsAreTracedWhereItIsAskedFor) {
  write("w.gyre.json", kWaterScene);
  ASSERT_EQ(gyre({"simulate", "w.gyre.json", "--steps", "1", "--trace", "t.csv"}).code, 0);
  EXPECT_EQ(lines_of(read("t.csv")).size(), 1u);
  ASSERT_EQ(gyre({"simulate", "w.gyre.json", "--steps", "1", "--trace", "t.csv", "--trace-liquids"}).code, 0);
  const std::vector<std::string> rows = lines_of(read("t.csv"));
  ASSERT_EQ(rows.size(), 1u + 2u * 128u);
  EXPECT_EQ(rows[1].rfind("0,0,tank[0],", 0), 0u) << rows[1];
  EXPECT_EQ(rows[128].rfind("0,0,tank[127],", 0), 0u) << rows[128];
  EXPECT_EQ(rows[129].rfind("1,", 0), 0u) << rows[129];
  EXPECT_EQ(last_cells(rows[1], 17).size(), 17u);
}

TEST_F(FluidCommandLine, FiguresAndCountsKnowLiquids) {
  write("w.gyre.json", kWaterScene);
  ASSERT_EQ(gyre({"simulate", "w.gyre.json", "--steps", "20", "--stats", "u.csv", "--probes", "p.csv"}).code,
            0);
  const std::vector<std::string> rows = lines_of(read("u.csv"));
  const std::vector<std::string> last = last_cells(rows.back(), 5);
  EXPECT_NEAR(std::stod(last[0]), 0.8 * 0.4 * 0.1, 0.05 * 0.032);
  EXPECT_EQ(last[1], "128");
  EXPECT_EQ(last[2], "0");
  const std::vector<std::string> probe = last_cells(lines_of(read("p.csv")).back(), 4);
  EXPECT_NEAR(std::stod(probe[0]), 1000 * 9.81 * 0.3, 150);
  EXPECT_EQ(probe[1], "1");
  EXPECT_NEAR(std::stod(probe[3]), 0.4, 0.02);
  const FluidDocument info = FluidDocument::parse(gyre({"info", "w.gyre.json", "--json"}).out);
  EXPECT_EQ(info["liquids"][0]["name"], "tank");
  EXPECT_EQ(info["liquids"][0]["particles"], 128);
  const Finished text = gyre({"simulate", "w.gyre.json", "--steps", "1"});
  EXPECT_EQ(text.out.rfind("water: 0 bodies, 0 joints, 1 liquid (128 particles)\n", 0), 0u) << text.out;
}

TEST_F(FluidCommandLine, HelpNamesTheTables) {
  const Finished help = gyre({"simulate", "--help"});
  for (const char* option : {"--probes FILE.csv", "--trace-liquids"})
    EXPECT_NE(help.out.find(option), std::string::npos) << help.out;
  EXPECT_EQ(gyre({"simulate", "g.gyre.json", "--trace-liquids"}).code, 2);
  EXPECT_EQ(gyre({"simulate", "g.gyre.json", "--probes", "x.csv", "--trace", "x.csv"}).code, 2);
  EXPECT_EQ(gyre({"simulate", "g.gyre.json", "--probes", "g.gyre.json"}).code, 2);
}

TEST_F(FluidCommandLine, ABadGasIsStatusThreeAndNothingIsWritten) {
  write(
      "bad.gyre.json",
      R"({"gyre_scene": 1, "gases": [{"name": "g", "bounds": [[0,0,0],[1,1,1]], "cells": [512, 512, 512]}]})");
  for (const char* command : {"simulate", "info"}) {
    const Finished done = gyre({command, "bad.gyre.json"});
    EXPECT_EQ(done.code, 3);
    EXPECT_EQ(done.err,
              "gyre: bad.gyre.json: /gases/0/cells: found 134217728 cells, expected at most 16777216\n");
  }
  EXPECT_EQ(gyre({"simulate", "bad.gyre.json", "--probes", "p.csv", "--final", "f.json"}).code, 3);
  EXPECT_FALSE(fs::exists(folder_ / "p.csv"));
  EXPECT_FALSE(fs::exists(folder_ / "f.json"));
}

}  // namespace
}  // namespace gyre::fluid_test
