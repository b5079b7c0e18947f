// gyre decompose as scripts see it: what it reports, what it keeps and when it may use that, and how it refuses.
#include "run_program.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace gyre::decompose_test {
namespace {

namespace fs = std::filesystem;

// A flat ring of a square: 1 m across, a hole of 0.5 m, 0.25 m high. Four beams make it without a rest.
std::string ring_obj(double hole = 0.25) {
  std::string out;
  for (const double y : {0.0, 0.25}) {
    for (const double r : {0.5, hole}) {
      for (int i = 0; i < 4; ++i) {
        const double x = i == 0 || i == 3 ? r : -r, z = i < 2 ? r : -r;
        out += "v " + std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + "\n";
      }
    }
  }
  // Below outer 1 to 4, inner 5 to 8; above outer 9 to 12, inner 13 to 16.
  for (int i = 0; i < 4; ++i) {
    const auto face = [&](int a, int b, int c, int d) {
      for (const int v : {a, b, c, d}) out += (v == a ? "f " : " ") + std::to_string(v);
      out += "\n";
    };
    const int j = (i + 1) % 4;
    face(1 + i, 1 + j, 5 + j, 5 + i);    // below
    face(9 + i, 13 + i, 13 + j, 9 + j);  // above
    face(1 + i, 9 + i, 9 + j, 1 + j);    // outside
    face(5 + i, 5 + j, 13 + j, 13 + i);  // inside
  }
  return out;
}

double number_in(const std::string& json, const std::string& name) {
  const std::size_t at = json.find("\"" + name + "\": ");
  return at == std::string::npos ? NAN : std::atof(json.c_str() + at + name.size() + 4);
}
bool says(const std::string& json, const std::string& name, const char* value) {
  return json.find("\"" + name + "\": " + value) != std::string::npos;
}

class Decompose : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("gyre_decompose_" + std::to_string(getpid()) + "_" +
                                           testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    write("ring.obj", ring_obj());
  }
  void TearDown() override { fs::remove_all(folder_); }
  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  std::string read(const std::string& name) const { return file_text(folder_ / name); }
  Finished gyre(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "decompose");
    return run_program(arguments, folder_);
  }
  std::vector<fs::path> kept() const {
    std::vector<fs::path> files;
    if (!fs::exists(folder_ / "kept")) return files;
    for (const auto& entry : fs::directory_iterator(folder_ / "kept")) files.push_back(entry.path());
    return files;
  }
  fs::path folder_;
};

TEST_F(Decompose, ReportsHullsAndVolumesOfARing) {
  const Finished done = gyre({"ring.obj", "--json", "--no-cache", "--out", "hulls.obj"});
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_EQ(number_in(done.out, "hulls"), 4) << done.out;
  // By hand: (1 - 0.25) * 0.25 m^3, which a single hull would fill with a third more.
  EXPECT_NEAR(number_in(done.out, "solid_volume"), 0.1875, 2e-3);
  EXPECT_NEAR(number_in(done.out, "hull_volume"), 0.1875, 2e-3);
  EXPECT_LT(number_in(done.out, "excess_volume"), 1e-3);
  EXPECT_LT(number_in(done.out, "missing_volume"), 1e-3);
  EXPECT_LT(number_in(done.out, "overhang"), 0.02 * number_in(done.out, "size"));
  EXPECT_TRUE(says(done.out, "within_concavity", "true")) << done.out;
  EXPECT_TRUE(says(done.out, "cached", "false"));
  const std::string hulls = read("hulls.obj");
  std::size_t objects = 0;
  for (std::size_t at = hulls.find("\no "); at != std::string::npos; at = hulls.find("\no ", at + 1))
    ++objects;
  EXPECT_EQ(objects, 4u);
  const Finished text = gyre({"ring.obj", "--no-cache"});
  EXPECT_NE(text.out.find("4 hulls"), std::string::npos) << text.out;
  EXPECT_NE(text.out.find("volume"), std::string::npos);
  EXPECT_TRUE(gyre({"ring.obj", "--no-cache", "--quiet"}).out.empty());
}

TEST_F(Decompose, KeepsResultsByContentAndTrustsNothingElse) {
  const auto ask = [&](const std::string& mesh, std::vector<std::string> more = {}) {
    more.insert(more.begin(), {mesh, "--json", "--cache", "kept", "--out", "out.obj"});
    const Finished done = gyre(more);
    EXPECT_EQ(done.code, 0) << done.err;
    return says(done.out, "cached", "true");
  };
  EXPECT_FALSE(ask("ring.obj"));
  ASSERT_EQ(kept().size(), 1u);
  const std::string first = read("out.obj");
  // The same content under another name, with another number of threads; and a later time of change.
  fs::copy_file(folder_ / "ring.obj", folder_ / "other.obj");
  EXPECT_TRUE(ask("other.obj", {"--threads", "3"}));
  EXPECT_EQ(read("out.obj"), first);
  EXPECT_EQ(kept().size(), 1u);
  // The same name with another content, and other settings.
  write("ring.obj", ring_obj(0.3));
  EXPECT_FALSE(ask("ring.obj"));
  EXPECT_NE(read("out.obj"), first);
  EXPECT_FALSE(ask("ring.obj", {"--concavity", "0.1"}));
  EXPECT_EQ(kept().size(), 3u);
  // What is kept is damaged at every eleventh byte, cut short, and empty: it is made anew, the same.
  write("ring.obj", ring_obj());
  for (int damage = 0; damage < 3; ++damage) {
    for (const fs::path& file : kept()) {
      std::string bytes = file_text(file);
      if (damage == 0) {
        for (std::size_t i = 7; i < bytes.size(); i += 11) bytes[i] = char(bytes[i] ^ 0x20);
      }
      if (damage == 1) bytes.resize(bytes.size() / 2);
      if (damage == 2) bytes.clear();
      std::ofstream(file, std::ios::binary) << bytes;
    }
    EXPECT_FALSE(ask("ring.obj")) << damage;
    EXPECT_EQ(read("out.obj"), first) << damage;
    EXPECT_TRUE(ask("ring.obj")) << damage;
  }
}

TEST_F(Decompose, ThreadsDoNotShow) {
  std::string first;
  for (const char* threads : {"1", "2", "5"}) {
    ASSERT_EQ(gyre({GYRE_SOURCE_DIR "/scenes/decomposition/meshes/gear.obj", "--threads", threads,
                    "--no-cache", "--quiet", "--out", "out.obj"})
                  .code,
              0);
    if (first.empty()) first = read("out.obj");
    EXPECT_EQ(read("out.obj"), first) << threads;
  }
}

TEST_F(Decompose, OddMeshesHaveHullsOrAReason) {
  struct Odd {
    const char* what;
    std::string text;
    bool refused;
  };
  const std::string square = "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\n";
  std::string open = ring_obj();
  open.erase(open.rfind("f "));
  const Odd odd[] = {
      {"empty", "", true},
      {"no face", square, true},
      {"no area", square + "f 1 1 2\nf 2 2 2\n", true},
      {"all in one place", "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n", true},
      {"not a number", "v nan 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n", true},
      {"an index beyond", square + "f 1 2 9\n", true},
      {"one triangle", square + "f 1 2 3\n", false},
      {"the same triangle twice and back", square + "f 1 2 3\nf 1 2 3\nf 3 2 1\n", false},
      {"a hole", open, false},
      {"beyond what a world holds", "v 0 0 0\nv 1e15 0 0\nv 0 1e15 0\nf 1 3 2\n", true},
      {"large", "v 0 0 0\nv 1e8 0 0\nv 0 1e8 0\nv 0 0 1e8\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n", false}};
  for (const Odd& it : odd) {
    write("odd.obj", it.text);
    fs::remove(folder_ / "out.obj");
    const Finished done = gyre({"odd.obj", "--json", "--no-cache", "--out", "out.obj"});
    if (it.refused) {
      EXPECT_EQ(done.code, 3) << it.what;
      EXPECT_EQ(std::count(done.err.begin(), done.err.end(), '\n'), 1) << it.what << ": " << done.err;
      EXPECT_FALSE(fs::exists(folder_ / "out.obj")) << it.what;
    } else {
      EXPECT_EQ(done.code, 0) << it.what << ": " << done.err;
      EXPECT_GE(number_in(done.out, "hulls"), 1) << it.what;
      EXPECT_TRUE(std::isfinite(number_in(done.out, "excess_volume"))) << it.what;
    }
  }
}

TEST_F(Decompose, WrongUsageIsStatusTwoAndAMissingFileThree) {
  EXPECT_EQ(gyre({}).code, 2);
  EXPECT_EQ(gyre({"ring.obj", "--concavity", "7", "--no-cache"}).code, 2);
  EXPECT_EQ(gyre({"ring.obj", "--max-hulls", "0", "--no-cache"}).code, 2);
  EXPECT_EQ(gyre({"ring.obj", "--meaning", "cheese"}).code, 2);
  EXPECT_EQ(gyre({"nowhere.obj"}).code, 3);
  EXPECT_EQ(gyre({"ring.obj", "--no-cache", "--out", "no/such/folder/out.obj"}).code, 3);
  // Where nothing can be kept the answer is the same, and it is said.
  write("blocked", "a file");
  const Finished done = gyre({"ring.obj", "--json", "--cache", "blocked"});
  EXPECT_EQ(done.code, 0);
  EXPECT_EQ(number_in(done.out, "hulls"), 4);
  EXPECT_NE(done.err.find("cannot be kept"), std::string::npos) << done.err;
}

}  // namespace
}  // namespace gyre::decompose_test
