// Commands around a simulation: replay, plot, tables of forces, standard input and output, guesses at misspelt words, completion.
#include "io/chunk/chunks.h"
#include "run_program.h"

#include <gyre/replay.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

namespace gyre::tools_test {
namespace {

namespace fs = std::filesystem;

// A pendulum of 2 kg on a hinge, at rest; a box of 8 kg at rest on the ground; a ball in the air.
const std::string kScene =
    R"({"gyre_scene": 1, "name": "small", "world": {"time_step": 0.01, "sleeping": false}, "bodies": [
  {"name": "ground", "type": "static", "shapes": [{"type": "plane"}]},
  {"name": "box", "position": [5, 0.1, 0], "mass": 8, "shapes": [{"type": "box", "half_extents": [0.1, 0.1, 0.1]}]},
  {"name": "bob", "position": [0, 2, 0], "mass": 2, "shapes": [{"type": "sphere", "radius": 0.1}]},
  {"name": "ball", "position": [-5, 9, 0], "shapes": [{"type": "sphere", "radius": 0.5}]}],
  "joints": [{"name": "pivot", "type": "hinge", "a": "world", "b": "bob", "anchor": [0, 3, 0], "axis": [0, 0, 1]}]})";

std::vector<std::vector<std::string>> rows_of(const std::string& text) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    rows.emplace_back();
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
  }
  return rows;
}

double number(const std::string& text) { return std::atof(text.c_str()); }

class Tools : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("gyre_tools_" + std::to_string(getpid()) + "_" +
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
  // Through a shell, which can connect programs.
  std::string shell(const std::string& command) const {
    const std::string whole =
        "cd '" + folder_.string() + "' && " + command + " > piped.txt 2> piped_errors.txt";
    status_ = std::system(whole.c_str());
    return read("piped.txt");
  }
  void record(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"simulate", "s.gyre.json", "--steps", "60",
                                          "--record", "r.gyrec",     "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    ASSERT_EQ(gyre(arguments).code, 0);
  }

  fs::path folder_;
  mutable int status_ = 0;
};

TEST_F(Tools, ReplayComparesEveryHash) {
  record({"--threads", "2"});
  const std::string hash = gyre({"simulate", "s.gyre.json", "--steps", "60", "--quiet", "--hash"}).out;
  const Finished done = gyre({"replay", "r.gyrec", "--hash"});
  EXPECT_EQ(done.code, 0) << done.err;
  EXPECT_EQ(done.out, "60 steps replayed; every hash agrees.\n" + hash);
  EXPECT_EQ(gyre({"replay", "r.gyrec", "--quiet", "--simd-width", "1"}).out, "");
  EXPECT_NE(gyre({"replay", "r.gyrec", "--json"}).out.find("\"different_steps\": 0"), std::string::npos);
}

// One number of a command in the file is changed, and all checksums with it: the run goes another way from that step on.
TEST_F(Tools, ReplayNamesTheFirstDifference) {
  struct File : ByteSink {
    std::vector<std::byte> bytes;
    bool write(std::span<const std::byte> more) override {
      bytes.insert(bytes.end(), more.begin(), more.end());
      return true;
    }
  } file;
  World world = *World::create();
  const BodyId ball = world.add_body({}, {.geometry = Sphere{0.5f}});
  const float marked = 1234.5678f;
  {
    Recorder recorder(world, file);
    for (int step = 0; step < 20; ++step) {
      if (step == 12) world.add_impulse(ball, {marked, 0, 0});
      world.step(0.01f);
    }
  }
  const auto* const pattern = reinterpret_cast<const std::byte*>(&marked);
  const auto found = std::search(file.bytes.begin(), file.bytes.end(), pattern, pattern + sizeof marked);
  ASSERT_NE(found, file.bytes.end());
  const float other = 2 * marked;
  std::copy_n(reinterpret_cast<const std::byte*>(&other), sizeof other, found);
  reseal_recording(file.bytes);
  write("other.gyrec", {reinterpret_cast<const char*>(file.bytes.data()), file.bytes.size()});
  Finished done = gyre({"replay", "other.gyrec"});
  EXPECT_EQ(done.code, 1) << done.err;
  EXPECT_EQ(done.out, "Step 13 of 20 (0.13 s) is not as it was recorded.\n");
  EXPECT_NE(gyre({"replay", "other.gyrec", "--json", "--keep-going"}).out.find("\"different_steps\": 8"), std::string::npos);
}

TEST_F(Tools, ReplayPlaysWhatIsLeftOfARecording) {
  record({"--record-as", "commands"});
  std::string bytes = read("r.gyrec");
  bytes.resize(bytes.size() * 3 / 4);
  write("cut.gyrec", bytes);
  Finished done = gyre({"replay", "cut.gyrec"});
  EXPECT_EQ(done.code, 0) << done.err;
  EXPECT_NE(done.out.find("has no end"), std::string::npos) << done.out;
  done = gyre({"replay", "s.gyre.json"});
  EXPECT_EQ(done.code, 3);
  EXPECT_NE(done.err.find("is no recording"), std::string::npos) << done.err;
  record({"--record-as", "poses"});
  EXPECT_EQ(gyre({"replay", "r.gyrec"}).code, 3) << "no commands";
}

TEST_F(Tools, ARecordingIsKnownToOtherCommands) {
  record();
  const Finished info = gyre({"info", "r.gyrec"});
  EXPECT_EQ(info.code, 0) << info.err;
  EXPECT_NE(info.out.find("replay  60 steps, begins with 4 bodies, 1 joints"), std::string::npos) << info.out;
  EXPECT_NE(info.out.find("track   61 frames"), std::string::npos) << info.out;
  EXPECT_NE(info.out.find("body \"bob\", dynamic, 1 shape"), std::string::npos) << info.out;
  EXPECT_NE(gyre({"info", "r.gyrec", "--json"}).out.find("\"frames\": 61"), std::string::npos);
  const Finished simulated = gyre({"simulate", "r.gyrec"});
  EXPECT_EQ(simulated.code, 3);
  EXPECT_NE(simulated.err.find("is a recording, expected a scene; gyre replay"), std::string::npos) << simulated.err;
  const Finished converted = gyre({"convert", "r.gyrec", "x.gyre.json"});
  EXPECT_NE(converted.code, 0);
  EXPECT_NE(converted.err.find("a recording becomes a .glb or .gltf file"), std::string::npos) << converted.err;
}

TEST_F(Tools, StandardInputAndOutputTakeThePlaceOfFiles) {
  const std::string program = "'" + program_path() + "'";
  const std::string hash = gyre({"simulate", "s.gyre.json", "--steps", "20", "--quiet", "--hash"}).out;
  EXPECT_EQ(shell("cat s.gyre.json | " + program + " simulate - --steps 20 --quiet --hash"), hash);
  const std::string trace = shell(program + " simulate s.gyre.json --steps 20 --trace -");
  EXPECT_EQ(status_, 0);
  EXPECT_EQ(trace.rfind("step,time,body", 0), 0u);
  EXPECT_EQ(rows_of(trace).size(), 1u + 21u * 4u) << "the summary goes to stderr";
  EXPECT_NE(read("piped_errors.txt").find("20 steps"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder_ / "-"));
  EXPECT_NE(shell(program + " simulate s.gyre.json --steps 20 --record - | " + program + " replay -")
                .find("20 steps replayed"),
            std::string::npos);
  EXPECT_NE(shell(program + " convert s.gyre.json - | " + program + " info -").find("bodies  4"),
            std::string::npos);
  EXPECT_EQ(gyre({"simulate", "s.gyre.json", "--trace", "-", "--stats", "-"}).code, 2);
}

TEST_F(Tools, JointsAndContactsHaveTables) {
  ASSERT_EQ(gyre({"simulate", "s.gyre.json", "--steps", "100", "--joints", "j.csv", "--contacts", "c.csv",
                  "--trace", "t.csv", "--trace-only", "bob", "--trace-every", "50", "--quiet"})
                .code,
            0);
  const auto joints = rows_of(read("j.csv"));
  ASSERT_EQ(joints.size(), 4u);
  EXPECT_EQ(joints[0][2], "joint");
  EXPECT_EQ((std::vector<std::string>{joints[3].begin(), joints[3].begin() + 6}),
            (std::vector<std::string>{"100", "1", "pivot", "hinge", "world", "bob"}));
  EXPECT_NEAR(number(joints[3][7]), 2 * 9.81, 0.01) << "the pivot bears the bob";
  const auto contacts = rows_of(read("c.csv"));
  double normal = 0;
  for (const auto& row : contacts) {
    if (row[0] != "100") continue;
    EXPECT_TRUE((row[2] == "ground" && row[3] == "box") || (row[2] == "box" && row[3] == "ground"));
    normal += number(row[11]);
  }
  EXPECT_NEAR(normal, 8 * 9.81, 0.1) << "the ground bears the box";
  const auto trace = rows_of(read("t.csv"));
  ASSERT_EQ(trace.size(), 4u);
  EXPECT_EQ(trace[1][2], "bob");
}

TEST_F(Tools, MisspeltWordsGetAGuess) {
  const std::map<std::string, std::vector<std::string>> cases = {
      {"unknown command simulat; did you mean simulate?", {"simulat"}},
      {"unknown command dance (", {"dance"}},
      {"unknown option --durtion; did you mean --duration?", {"simulate", "s.gyre.json", "--durtion", "3"}},
      {"unknown option --qqqqqqq (", {"simulate", "s.gyre.json", "--qqqqqqq"}},
      {"unexpected argument 5", {"simulate", "s.gyre.json", "5", "6"}},
      {"did you mean soft_step?", {"simulate", "s.gyre.json", "--solver", "sof_step"}},
      {"did you mean \"ball\"?", {"simulate", "s.gyre.json", "--explain", "bal"}},
      {"did you mean phase?", {"plot", "s.gyre.json", "--out", "x.svg", "--what", "phsae"}}};
  for (const auto& [message, arguments] : cases) {
    const Finished done = gyre(arguments);
    EXPECT_EQ(done.code, 2);
    EXPECT_NE(done.err.find(message), std::string::npos) << done.err;
  }
  for (const char* command : {"simulate", "replay", "render", "plot"}) {
    const Finished done = gyre({command, "s.gyre.json", "--out", "x.svg", "--threads", "65"});
    EXPECT_EQ(done.code, 2);
  }
  EXPECT_NE(gyre({"bench", "--threads", "65"}).err.find("from 0 to 64"), std::string::npos);
}

std::size_t curves_in(const std::string& svg) {
  std::size_t count = 0;
  for (std::size_t at = svg.find("<path"); at != std::string::npos; at = svg.find("<path", at + 1)) ++count;
  return count;
}

TEST_F(Tools, PlotDrawsEnergyMotionAndPhase) {
  record();
  Finished done = gyre({"plot", "s.gyre.json", "--out", "e.svg", "--duration", "1"});
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_EQ(done.out, "e.svg: energy, 4 series of 101 points, drawn by gyre\n");
  const std::string energy = read("e.svg");
  EXPECT_EQ(energy.rfind("<svg ", 0), 0u);
  EXPECT_EQ(curves_in(energy), 4u);
  EXPECT_NE(energy.find(">energy (J)<"), std::string::npos);
  EXPECT_EQ(energy.find("nan"), std::string::npos);
  ASSERT_EQ(
      gyre({"plot", "r.gyrec", "--what", "position", "--body", "ball", "--out", "a.svg", "--quiet"}).code, 0);
  ASSERT_EQ(gyre({"plot", "s.gyre.json", "--what", "position", "--body", "ball", "--out", "b.svg",
                  "--duration", "0.6", "--quiet"})
                .code,
            0);
  const auto drawing = [](const std::string& text) { return text.substr(text.find("<path")); };
  EXPECT_EQ(drawing(read("a.svg")), drawing(read("b.svg"))) << "a scene and its recording";
  ASSERT_EQ(gyre({"plot", "s.gyre.json", "--what", "phase", "--joint", "pivot", "--out", "c.svg",
                  "--duration", "1", "--quiet"})
                .code,
            0);
  EXPECT_EQ(curves_in(read("c.svg")), 1u);
  EXPECT_EQ(gyre({"plot", "s.gyre.json", "--out", "-", "--duration", "1"}).out, energy);
  EXPECT_EQ(gyre({"plot", "s.gyre.json", "--out", "x.jpg"}).code, 2);
  EXPECT_EQ(gyre({"plot", "s.gyre.json", "--what", "position", "--body", "bull", "--out", "x.svg"}).code, 2);
}

// Programs of these names that only keep what they are given stand for gnuplot and ffmpeg.
TEST_F(Tools, GnuplotAndFfmpegAreFedWhereTheyAre) {
  fs::create_directory(folder_ / "bin");
  write("bin/gnuplot", "#!/bin/sh\n/bin/cat > script.txt\n/bin/cp script.txt g.png.part.png\n");
  write("bin/ffmpeg", "#!/bin/sh\nfor last; do :; done\necho \"$@\" > arguments.txt\n/bin/cat > \"$last\"\n");
  for (const char* name : {"bin/gnuplot", "bin/ffmpeg"})
    fs::permissions(folder_ / name, fs::perms::owner_all);
  const std::string program = "PATH='" + (folder_ / "bin").string() + "' '" + program_path() + "'";
  const std::string said = shell(program + " plot s.gyre.json --out g.png --duration 0.1");
  EXPECT_NE(said.find("drawn by gnuplot"), std::string::npos) << read("piped_errors.txt");
  EXPECT_NE(read("g.png").find("with lines"), std::string::npos);
  shell(program + " render s.gyre.json --out m.mp4 --size 32x24 --samples 1 --frames 3 --fps 10");
  if (read("piped_errors.txt").find("left out") != std::string::npos || status_ != 0) {
    GTEST_SKIP() << "gyre render cannot draw here: " << read("piped_errors.txt");
  }
  EXPECT_EQ(read("m.mp4").size(), 3u * 32u * 24u * 3u) << "raw frames, as ffmpeg is given them";
  EXPECT_NE(read("arguments.txt").find("-video_size 32x24 -framerate 10"), std::string::npos)
      << read("arguments.txt");
}

TEST_F(Tools, CompletionAndManualNameEveryCommandAndOption) {
  const std::string help = gyre({"--help"}).out;
  const std::string manual = gyre({"manual"}).out;
  EXPECT_EQ(manual.rfind(".TH GYRE 1", 0), 0u);
  for (const char* shell_name : {"bash", "zsh", "fish"}) {
    const Finished done = gyre({"completion", shell_name});
    ASSERT_EQ(done.code, 0);
    for (const char* word : {"simulate", "replay", "plot", "render", "validate", "completion"}) {
      EXPECT_NE(help.find(word), std::string::npos) << word;
      EXPECT_NE(done.out.find(word), std::string::npos) << shell_name << " " << word;
      EXPECT_NE(manual.find("gyre " + std::string(word)), std::string::npos) << word;
    }
    for (const char* word : {"record-as", "trace-only", "simd-width"})
      EXPECT_NE(done.out.find(word), std::string::npos) << word;
    EXPECT_NE(done.out.find("sequential_impulses"), std::string::npos) << "words of --solver";
  }
  EXPECT_NE(manual.find("\\-\\-record\\-as"), std::string::npos);
  EXPECT_EQ(gyre({"completion", "tcsh"}).code, 2);
  if (std::system("bash --version > /dev/null 2>&1") != 0) return;
  const std::string program = "'" + program_path() + "'";
  EXPECT_EQ(shell(program + " completion bash > gyre.bash && bash -c \". ./gyre.bash; COMP_WORDS=(gyre "
                            "simulate x.json --solver l); "
                            "COMP_CWORD=4; _gyre; echo \\${COMPREPLY[@]}\""),
            "lcp\n");
  EXPECT_EQ(
      shell("bash -c \". ./gyre.bash; COMP_WORDS=(gyre re); COMP_CWORD=1; _gyre; echo \\${COMPREPLY[@]}\""),
      "replay render\n");
}

}  // namespace
}  // namespace gyre::tools_test
