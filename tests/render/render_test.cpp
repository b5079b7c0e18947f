// gyre render as a user sees it: the same bytes twice, things where a pinhole has them, exit statuses and words.
#include "cli/run_program.h"

#include <gyre/gyre.h>
#include <gyre/replay.h>
#include <gyre/track.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#ifdef GYRE_WITH_RENDER
#include <gif_lib.h>
#include <png.h>
#endif

namespace gyre::render_test {
namespace {

namespace fs = std::filesystem;

// A red box of 1 m, seen from the front; the ground is far below.
const std::string kBox = R"({"gyre_scene": 1, "world": {"gravity": [0, 0, 0]}, "bodies": [
  {"name": "box", "color": "#ff0000", "shapes": [{"type": "box", "half_extents": [0.5, 0.5, 0.5]}]},
  {"name": "far ball", "position": [40, 0, 0], "shapes": [{"type": "sphere", "radius": 0.5}]}]})";
const std::string kFalling = R"({"gyre_scene": 1, "bodies": [
  {"name": "ground", "type": "static", "shapes": [{"type": "plane"}]},
  {"name": "ball", "position": [0, 2, 0], "color": "#ff0000", "shapes": [{"type": "sphere", "radius": 0.5}]}]})";

class Render : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("gyre_render_" + std::to_string(getpid()) + "_" +
                                           ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    write("box.gyre.json", kBox);
    write("fall.gyre.json", kFalling);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  std::string read(const std::string& name) const { return file_text(folder_ / name); }
  // Small and with few samples, so that many pictures take little time.
  Finished draw(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "render");
    return run_program(arguments, folder_);
  }
  Finished draw_small(std::vector<std::string> arguments) const {
    arguments.insert(arguments.end(), {"--size", "96x60", "--samples", "2", "--quiet"});
    return draw(std::move(arguments));
  }
  std::vector<std::string> files(const fs::path& folder) const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder))
      names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
  }
  void expect_refused(const std::vector<std::string>& arguments, int code, const std::string& word) const {
    const Finished done = draw(arguments);
    EXPECT_EQ(done.code, code) << done.err;
    EXPECT_EQ(done.out, "");
    EXPECT_EQ(std::count(done.err.begin(), done.err.end(), '\n'), 1) << done.err;
    EXPECT_NE(done.err.find(word), std::string::npos) << done.err << "expected: " << word;
    EXPECT_EQ(files(folder_), (std::vector<std::string>{"box.gyre.json", "fall.gyre.json"}));
  }

  fs::path folder_;
};

TEST_F(Render, WrongUsageIsStatusTwoAndOneLine) {
  expect_refused({}, 2, "SCENE");
  expect_refused({"box.gyre.json"}, 2, "--out");
  expect_refused({"box.gyre.json", "--out", "a.jpg"}, 2, ".png, .gif, .mp4 or .webm");
  expect_refused({"box.gyre.json", "--out", "a%s.png"}, 2, "%04d");
  expect_refused({"box.gyre.json", "--out", "a.png", "--size", "0x10"}, 2, "WIDTHxHEIGHT");
  expect_refused({"box.gyre.json", "--out", "a.png", "--size", "640"}, 2, "found 640");
  expect_refused({"box.gyre.json", "--out", "a.png", "--camera", "1,2"}, 2, "3 numbers");
  expect_refused({"box.gyre.json", "--out", "a.png", "--camera", "1,2,nan"}, 2, "found 1,2,nan");
  expect_refused({"box.gyre.json", "--out", "a.png", "--camera", "1,2,3", "--look-at", "1,2,3"}, 2,
                 "somewhere else");
  expect_refused({"box.gyre.json", "--out", "a.png", "--direction", "0,100"}, 2, "-90 to 90");
  expect_refused({"box.gyre.json", "--out", "a.png", "--fov", "180"}, 2, "1 to 170");
  expect_refused({"box.gyre.json", "--out", "a.png", "--samples", "0"}, 2, "1 to 1024");
  expect_refused({"box.gyre.json", "--out", "a.png", "--frames", "5"}, 2, "one picture");
  expect_refused({"box.gyre.json", "--out", "a.gif", "--at", "5"}, 2, "--from and --to");
  expect_refused({"box.gyre.json", "--out", "a.gif", "--from", "2", "--to", "1"}, 2, "later");
  expect_refused({"box.gyre.json", "--out", "a.gif", "--to", "1", "--frames", "5"}, 2, "--frames");
  expect_refused({"box.gyre.json", "--out", "a.gif", "--fps", "100"}, 2, "50 frames");
  expect_refused({"box.gyre.json", "--out", "a.gif", "--frames", "0"}, 2, "found 0");
  expect_refused({"box.gyre.json", "--out", "a.png", "--color-by", "heat"}, 2, "stress or strain");
  expect_refused({"box.gyre.json", "--out", "a.png", "--color-range", "0,1"}, 2, "--color-by");
  expect_refused({"box.gyre.json", "--out", "a.png", "--color-by", "strain", "--color-range", "1,0"}, 2, "below");
  expect_refused({"box.gyre.json", "--out", "a.png", "--color-by", "strain", "--color-range", "1"}, 2, "2 numbers");
}

#ifndef GYRE_WITH_RENDER

TEST_F(Render, ABuildWithoutPicturesSaysWhatToInstall) {
  expect_refused({"box.gyre.json", "--out", "a.png"}, 3, "libepoxy-dev");
}

#else

struct Pixels {
  unsigned width = 0, height = 0;
  std::vector<std::uint8_t> bytes;
  bool is_red(int x, int y) const {
    const std::size_t at = 3 * (std::size_t(y) * width + std::size_t(x));
    return bytes[at] > 90 && bytes[at + 1] < 70 && bytes[at + 2] < 70;
  }
};
Pixels read_png(const fs::path& path) {
  Pixels out;
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  if (!png_image_begin_read_from_file(&image, path.c_str())) return out;
  image.format = PNG_FORMAT_RGB;
  out.bytes.resize(PNG_IMAGE_SIZE(image));
  if (!png_image_finish_read(&image, nullptr, out.bytes.data(), 0, nullptr)) return out;
  out.width = image.width;
  out.height = image.height;
  return out;
}
// Frames of a GIF; -1 if it cannot be decoded.
int count_frames(const fs::path& path, int& width, int& height) {
  int error = 0;
  GifFileType* file = DGifOpenFileName(path.c_str(), &error);
  if (!file) return -1;
  const int frames = DGifSlurp(file) == GIF_OK ? file->ImageCount : -1;
  width = file->SWidth;
  height = file->SHeight;
  DGifCloseFile(file, &error);
  return frames;
}
// How far the picture is from one plain colour.
double spread(const Pixels& picture) {
  double sum = 0, squares = 0;
  for (const std::uint8_t byte : picture.bytes) {
    sum += byte;
    squares += double(byte) * byte;
  }
  const double count = double(picture.bytes.size()), mean = sum / count;
  return std::sqrt(squares / count - mean * mean);
}

TEST_F(Render, TwoRunsGiveTheSameBytes) {
  for (const char* out : {"a", "b"}) {
    ASSERT_EQ(draw_small({"fall.gyre.json", "--out", std::string(out) + ".png", "--at", "0.5"}).code, 0);
    ASSERT_EQ(draw_small({"fall.gyre.json", "--out", std::string(out) + ".gif", "--frames", "5", "--threads",
                          out[0] == 'a' ? "1" : "3"})
                  .code,
              0);
  }
  EXPECT_GT(read("a.png").size(), 500u);
  EXPECT_EQ(read("a.png"), read("b.png"));
  EXPECT_GT(read("a.gif").size(), 500u);
  EXPECT_EQ(read("a.gif"), read("b.gif"));
}

TEST_F(Render, ABoxsCornersLieWhereAPinholeHasThem) {
  // From 10 m before the front face (z = 0.5) and a little beside; half of the height is tan 10 degrees.
  const Finished done = draw({"box.gyre.json", "--out", "a.png", "--size", "320x200", "--camera",
                              "0.3,0.2,10.5", "--look-at", "0.3,0.2,0", "--fov", "20", "--samples", "16"});
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_EQ(done.out.rfind("a.png: 1 frame of 320 x 200", 0), 0u) << done.out;
  const Pixels picture = read_png(folder_ / "a.png");
  ASSERT_EQ(picture.width, 320u);
  ASSERT_EQ(picture.height, 200u);
  const double pixels_a_metre = 100 / std::tan(20 * 3.14159265358979 / 360) / 10;
  const double left = 160 + pixels_a_metre * (-0.5 - 0.3), right = 160 + pixels_a_metre * (0.5 - 0.3);
  const double top = 100 - pixels_a_metre * (0.5 - 0.2), bottom = 100 - pixels_a_metre * (-0.5 - 0.2);
  // A pixel and a half inside every corner it is red, as far outside it is not.
  for (const double x : {left, right}) {
    for (const double y : {top, bottom}) {
      const double in_x = x == left ? 1.5 : -1.5, in_y = y == top ? 1.5 : -1.5;
      const auto at = [&](double px, double py) {
        return picture.is_red(int(std::floor(px)), int(std::floor(py)));
      };
      EXPECT_TRUE(at(x + in_x, y + in_y)) << x << " " << y;
      EXPECT_FALSE(at(x - in_x, y + in_y)) << x << " " << y;
      EXPECT_FALSE(at(x + in_x, y - in_y)) << x << " " << y;
    }
  }
  EXPECT_TRUE(picture.is_red(int((left + right) / 2), int((top + bottom) / 2)));
}

TEST_F(Render, ABallFallsAsItShould) {
  // Half a second of free fall is 1.226 m: the ball is then at 0.774 m, and stood at 2 m before.
  const std::vector<std::string> camera = {"--camera", "0,1,12", "--look-at", "0,1,0", "--fov", "20"};
  const auto middle_at = [&](const char* time) {
    std::vector<std::string> arguments = {"fall.gyre.json", "--out",   "a.png",     "--at", time,
                                          "--size",         "200x200", "--samples", "8"};
    arguments.insert(arguments.end(), camera.begin(), camera.end());
    if (draw(arguments).code != 0) return -1.0;
    const Pixels picture = read_png(folder_ / "a.png");
    double sum = 0, rows = 0;
    for (int y = 0; y < 200; ++y) {
      const std::size_t at = 3 * (std::size_t(y) * 200 + 100);
      if (picture.bytes[at] > picture.bytes[at + 1] + 20) {  // nothing else is red
        sum += y + 0.5;
        rows += 1;
      }
    }
    return rows > 0 ? sum / rows : -2.0;
  };
  const double pixels_a_metre = 100 / std::tan(20 * 3.14159265358979 / 360) / 12;
  EXPECT_NEAR(middle_at("0"), 100 - pixels_a_metre * (2 - 1), 2.0);
  EXPECT_NEAR(middle_at("0.5"), 100 - pixels_a_metre * (0.774 - 1), 2.0);
}

TEST_F(Render, FramesAreCounted) {
  ASSERT_EQ(
      draw_small({"fall.gyre.json", "--out", "frames/%03d.png", "--from", "0.5", "--to", "1", "--fps", "8"})
          .code,
      0);
  EXPECT_EQ(files(folder_ / "frames"),
            (std::vector<std::string>{"000.png", "001.png", "002.png", "003.png"}));
  ASSERT_EQ(draw_small({"fall.gyre.json", "--out", "a.gif", "--seconds", "0.5", "--fps", "10"}).code, 0);
  int width = 0, height = 0;
  EXPECT_EQ(count_frames(folder_ / "a.gif", width, height), 5);
  EXPECT_EQ(width, 96);
  EXPECT_EQ(height, 60);
  // Slow motion: as long, but of less of the scene.
  ASSERT_EQ(
      draw_small({"fall.gyre.json", "--out", "b.gif", "--seconds", "0.5", "--fps", "10", "--speed", "0.1"})
          .code,
      0);
  EXPECT_EQ(count_frames(folder_ / "b.gif", width, height), 5);
  EXPECT_NE(read("a.gif"), read("b.gif"));
}

TEST_F(Render, ARecordingLooksLikeItsScene) {
  ASSERT_EQ(
      run_program({"simulate", "fall.gyre.json", "--steps", "60", "--record", "r.gyrec", "--quiet"}, folder_)
          .code,
      0);
  ASSERT_EQ(draw_small({"fall.gyre.json", "--out", "scene.gif", "--frames", "15"}).code, 0);
  ASSERT_EQ(
      draw_small({"r.gyrec", "--scene", "fall.gyre.json", "--out", "recording.gif", "--frames", "15"}).code,
      0);
  EXPECT_EQ(read("scene.gif"), read("recording.gif"));
  // To its end, which is where the scene is after a second.
  ASSERT_EQ(draw_small({"r.gyrec", "--out", "whole.gif"}).code, 0);
  int width = 0, height = 0;
  EXPECT_EQ(count_frames(folder_ / "whole.gif", width, height), 21);
  // Cut off: played as far as it goes, and said so.
  write("cut.gyrec", read("r.gyrec").substr(0, read("r.gyrec").size() - 40));
  const Finished cut = draw_small({"cut.gyrec", "--out", "cut.gif"});
  EXPECT_EQ(cut.code, 0);
  EXPECT_NE(cut.err.find("last whole step"), std::string::npos) << cut.err;
  const Finished broken = draw_small({"stdout.txt", "--out", "x.gif"});
  EXPECT_EQ(broken.code, 3);
  EXPECT_FALSE(fs::exists(folder_ / "x.gif"));
  const Finished other = draw_small({"r.gyrec", "--scene", "box.gyre.json", "--out", "x.gif"});
  EXPECT_EQ(other.code, 3);
  EXPECT_NE(other.err.find("not one of this scene"), std::string::npos) << other.err;
}

TEST_F(Render, ATrackIsLookedAtWithoutSimulating) {
  // A recording of poses alone: a red ball that drops and a plane, with the name and the colour said by labels.
  Result<World> world = World::create();
  ASSERT_TRUE(world);
  const BodyId ground = world->add_body({.type = BodyType::fixed}, {.geometry = Plane{}});
  const BodyId ball = world->add_body({.pose = {.position = {0, 2, 0}}}, {.geometry = Sphere{0.5f}});
  struct Sink : ByteSink {
    std::string bytes;
    bool write(std::span<const std::byte> more) override {
      bytes.append(reinterpret_cast<const char*>(more.data()), more.size());
      return true;
    }
  } sink;
  {
    Recorder recorder(*world, sink, {.commands = false});
    const TrackColor red{255, 0, 0};
    recorder.label(ball, "ball", {&red, 1});
    recorder.label(ground, "ground");
    recorder.note(
        "scene",
        R"({"name": "x", "view": {"eye": [0, 1, 12], "target": [0, 1, 0], "field_of_view": 0.349}})");
    for (int i = 0; i < 60; ++i) world->step(1.0f / 60.0f);
    ASSERT_TRUE(recorder.finish());
  }
  write("t.gyrec", sink.bytes);
  // The scene with that camera looks the same, to what rounding the track leaves.
  ASSERT_EQ(draw_small({"t.gyrec", "--out", "track.png", "--at", "0.5"}).code, 0);
  ASSERT_EQ(draw_small({"fall.gyre.json", "--out", "scene.png", "--at", "0.5", "--camera", "0,1,12",
                        "--look-at", "0,1,0", "--fov", "20"})
                .code,
            0);
  const Pixels track = read_png(folder_ / "track.png"), scene = read_png(folder_ / "scene.png");
  ASSERT_EQ(track.bytes.size(), scene.bytes.size());
  int red = 0, different = 0;
  for (int y = 0; y < 60; ++y) {
    for (int x = 0; x < 96; ++x) {
      red += track.is_red(x, y) ? 1 : 0;
      const std::size_t at = 3 * std::size_t(y * 96 + x);
      different += std::abs(track.bytes[at] - scene.bytes[at]) > 40 ? 1 : 0;
    }
  }
  EXPECT_GT(red, 50);
  EXPECT_LT(different, 5);
  EXPECT_EQ(draw_small({"t.gyrec", "--out", "f.png", "--follow", "ball"}).code, 0);
  EXPECT_EQ(draw_small({"t.gyrec", "--out", "f.png", "--follow", "nobody"}).code, 2);
  ASSERT_EQ(draw_small({"t.gyrec", "--out", "whole.gif"}).code, 0);
  int width = 0, height = 0;
  EXPECT_EQ(count_frames(folder_ / "whole.gif", width, height), 21);
}

// The red sheet of 1 m hangs in the plane z = 0 and is seen from both sides: its back is paler. A recording of poses alone shows the same.
TEST_F(Render, ACapeHasTwoSidesInAReplayAndInATrack) {
  struct Sink : ByteSink {
    std::string bytes;
    bool write(std::span<const std::byte> more) override {
      bytes.append(reinterpret_cast<const char*>(more.data()), more.size());
      return true;
    }
  };
  for (const bool commands : {true, false}) {
    Result<World> world = World::create({.gravity = {}});
    ASSERT_TRUE(world);
    // A quarter turn about x: the upper side looks along +z.
    const SoftId sheet = world->add_cloth({.grid = ClothGrid{.size = {1, 1}, .cells = {4, 4}},
                                           .pose = {{0, 0, 0}, from_axis_angle({1, 0, 0}, 0.5f * kPi)}});
    Sink sink;
    {
      Recorder recorder(*world, sink, {.commands = commands});
      const TrackColor red{200, 0, 0};
      recorder.label_soft(sheet, "cape", {&red, 1});
      for (int i = 0; i < 3; ++i) world->step(1.0f / 60.0f);
      ASSERT_TRUE(recorder.finish());
    }
    write("cape.gyrec", sink.bytes);
    const auto look = [&](const char* eye) {
      const Finished done = draw({"cape.gyrec", "--out", "cape.png", "--size", "100x100", "--samples", "4",
                                  "--camera", eye, "--look-at", "0,0,0", "--fov", "20"});
      EXPECT_EQ(done.code, 0) << done.err;
      return read_png(folder_ / "cape.png");
    };
    // Half of the sheet takes 0.5 / (10 tan 10 degrees) of half of the picture: 14 pixels.
    const Pixels front = look("0,0,10"), back = look("0,0,-10");
    ASSERT_EQ(front.bytes.size(), 30000u);
    const auto part = [](const Pixels& picture, int x, int y, int of) {
      return int(picture.bytes[std::size_t(3 * (100 * y + x) + of)]);
    };
    for (const int offset : {-12, 0, 12}) {
      EXPECT_TRUE(front.is_red(50 + offset, 50)) << offset;
      EXPECT_TRUE(front.is_red(50, 50 + offset)) << offset;
      EXPECT_GT(part(back, 50 + offset, 50, 1), part(front, 50 + offset, 50, 1) + 40) << offset;
      EXPECT_GT(part(back, 50 + offset, 50, 0), part(back, 50 + offset, 50, 1) + 20) << "reddish still";
    }
    for (const int outside : {-17, 17}) {
      EXPECT_FALSE(front.is_red(50 + outside, 50));
      EXPECT_FALSE(front.is_red(50, 50 + outside));
    }
  }
}

TEST_F(Render, TooManyFramesAreRefusedBeforeTheWork) {
  expect_refused({"fall.gyre.json", "--out", "a.gif", "--seconds", "10000000"}, 2, "200000000 frames");
  expect_refused({"fall.gyre.json", "--out", "%d.png", "--seconds", "10000000"}, 2, "at most 10000000");
}

TEST_F(Render, WhatCannotBeReadOrWrittenIsStatusThree) {
  write("bad.gyre.json", R"({"gyre_scene": 1, "bodies": [{"name": "b", "color": "red"}]})");
  const Finished bad = draw_small({"bad.gyre.json", "--out", "a.png"});
  EXPECT_EQ(bad.code, 3);
  EXPECT_NE(bad.err.find("/bodies/0/color"), std::string::npos) << bad.err;
  EXPECT_EQ(draw_small({"none.gyre.json", "--out", "a.png"}).code, 3);
  EXPECT_EQ(draw_small({"box.gyre.json", "--out", "none/a.png"}).code, 3);
  EXPECT_EQ(draw_small({"box.gyre.json", "--out", "none/none/%d.png"}).code, 3);
  EXPECT_FALSE(fs::exists(folder_ / "none"));
  EXPECT_FALSE(fs::exists(folder_ / "a.png"));
  write("scene.png", kBox);
  const Finished over = draw_small({"scene.png", "--out", "./scene.png"});
  EXPECT_EQ(over.code, 2);
  EXPECT_NE(over.err.find("overwrite"), std::string::npos);
  EXPECT_EQ(read("scene.png"), kBox);
  EXPECT_EQ(draw_small({"box.gyre.json", "--follow", "nobody", "--out", "a.png"}).code, 2);
}

TEST_F(Render, ACameraFollowsABody) {
  // Falling, the ball stays in the middle of the picture only if the camera falls too.
  write("free.gyre.json", R"({"gyre_scene": 1, "bodies": [
    {"name": "ball", "position": [0, 200, 0], "color": "#ff0000", "shapes": [{"type": "sphere", "radius": 0.5}]}]})");
  ASSERT_EQ(draw({"free.gyre.json", "--out", "%d.png", "--frames", "3", "--fps", "1", "--camera", "0,200,9",
                  "--look-at", "0,200,0", "--follow", "ball", "--size", "64x64", "--samples", "2"})
                .code,
            0);
  for (const char* name : {"0.png", "1.png", "2.png"})
    EXPECT_TRUE(read_png(folder_ / name).is_red(32, 32)) << name;
}

TEST_F(Render, AShapeCastsItsShadowAndGlassDoesNotHide) {
  // Straight from above: the ground beside the post is dark on the side away from the sun.
  write("post.gyre.json", R"({"gyre_scene": 1, "bodies": [
    {"name": "ground", "type": "static", "shapes": [{"type": "plane"}]},
    {"name": "post", "position": [0, 1, 0], "can_sleep": false, "shapes": [{"type": "box", "half_extents": [0.1, 1, 0.1]}]}]})");
  ASSERT_EQ(draw({"post.gyre.json", "--out", "a.png", "--size", "200x200", "--samples", "16", "--camera",
                  "0,8,0.8", "--look-at", "0,0,0"})
                .code,
            0);
  const Pixels picture = read_png(folder_ / "a.png");
  int darkest = 255, brightest = 0;
  for (int turn = 0; turn < 64; ++turn) {
    const double angle = turn * 6.283185307 / 64;
    const auto x = std::size_t(100 + 24 * std::cos(angle)), y = std::size_t(100 + 24 * std::sin(angle));
    darkest = std::min(darkest, int(picture.bytes[3 * (y * 200 + x)]));
    brightest = std::max(brightest, int(picture.bytes[3 * (y * 200 + x)]));
  }
  EXPECT_LT(darkest, brightest - 50);

  write("wall.gyre.json", R"({"gyre_scene": 1, "world": {"gravity": [0, 0, 0]}, "bodies": [
    {"name": "wall", "type": "static", "position": [0, 0, 2], "color": "#0000ff",
     "shapes": [{"type": "box", "half_extents": [2, 2, 0.1]}]},
    {"name": "box", "color": "#ff0000", "shapes": [{"type": "box", "half_extents": [0.5, 0.5, 0.5]}]}]})");
  ASSERT_EQ(draw({"wall.gyre.json", "--out", "b.png", "--size", "64x64", "--samples", "32", "--camera",
                  "0,0,9", "--look-at", "0,0,0"})
                .code,
            0);
  const Pixels through = read_png(folder_ / "b.png");
  const std::size_t at = 3 * (32 * 64 + 32);
  EXPECT_GT(through.bytes[at], through.bytes[at + 2]);  // more of the box behind than of the wall before it
}

// Mean of the red, green and blue of a square of 8 pixels around a place.
std::array<double, 3> color_around(const Pixels& picture, int x, int y) {
  std::array<double, 3> sum{};
  for (int row = y - 4; row < y + 4; ++row) {
    for (int column = x - 4; column < x + 4; ++column) {
      for (std::size_t k = 0; k < 3; ++k)
        sum[k] += picture.bytes[3 * (std::size_t(row) * picture.width + std::size_t(column)) + k] / 64.0;
    }
  }
  return sum;
}

// Dark smoke before a pale background; behind a body it is not seen.
TEST_F(Render, SmokeTakesLightWhereItIs) {
  const auto scene = [](const char* more) {
    return std::string(R"({"gyre_scene": 1, "world": {"gravity": [0, 0, 0]}, "bodies": [)") + more +
           R"(], "gases": [{"name": "room", "bounds": [[-1, -1, -1], [1, 1, 1]], "cells": [20, 20, 20], "color": "#202020",
        "emitters": [{"position": [0, 0, 0], "radius": 0.4, "temperature": 293.15}]}]})";
  };
  write("smoke.gyre.json", scene(""));
  write("wall.gyre.json",
        scene(R"({"name": "wall", "type": "static", "position": [0, 0, 1.5], "color": "#ffffff",
               "shapes": [{"type": "box", "half_extents": [0.5, 0.5, 0.1]}]})"));
  for (const char* name : {"smoke", "wall"}) {
    ASSERT_EQ(draw({std::string(name) + ".gyre.json", "--out", std::string(name) + ".png", "--at", "0.1",
                    "--size", "96x96", "--samples", "4", "--camera", "0,0,6", "--look-at", "0,0,0"})
                  .code,
              0);
  }
  const Pixels smoke = read_png(folder_ / "smoke.png"), wall = read_png(folder_ / "wall.png");
  EXPECT_LT(color_around(smoke, 48, 48)[0], 120.0);
  EXPECT_GT(color_around(smoke, 86, 48)[0], 200.0);
  EXPECT_GT(color_around(wall, 48, 48)[0], 150.0);
}

// A sheet that begins twice as long in its left half: red there, blue at the right, and the key says so.
TEST_F(Render, StrainIsAColorOnAKey) {
  write("drawn.gyre.json", R"({"gyre_scene": 1, "world": {"gravity": [0, 0, 0]}, "cloths": [
    {"name": "sheet", "grid": {"size": [2, 1], "cells": [2, 1]}, "color": "#808080", "orientation": [0.70710678, 0, 0, 0.70710678],
     "state": {"positions": [[-2, 0.5, 0], [0, 0.5, 0], [1, 0.5, 0], [-2, -0.5, 0], [0, -0.5, 0], [1, -0.5, 0]]}}]})");
  const auto picture = [&](const char* range) {
    EXPECT_EQ(draw({"drawn.gyre.json", "--out", "drawn.png", "--color-by", "strain", "--color-range", range, "--size", "192x120",
                    "--samples", "8", "--camera", "0,0,6", "--look-at", "0,0,0"})
                  .code,
              0);
    return read_png(folder_ / "drawn.png");
  };
  const Pixels all = picture("0,1");
  const auto left = color_around(all, 50, 60), right = color_around(all, 125, 60);
  EXPECT_GT(left[0], left[2] + 60.0);
  EXPECT_GT(right[2], right[0] + 40.0);
  const Pixels low = picture("0,10");
  const auto pale = color_around(low, 50, 60);
  EXPECT_GT(pale[2], pale[0] + 40.0);
  // The key stands at the right, red above and blue below.
  int red = 0, blue = 0;
  for (int y = 30; y < 90; ++y) {
    for (int x = 140; x < 192; ++x) {
      const std::uint8_t* const at = &all.bytes[3 * (std::size_t(y) * all.width + std::size_t(x))];
      red += y < 50 && at[0] > at[2] + 100 ? 1 : 0;
      blue += y > 70 && at[2] > at[0] + 100 ? 1 : 0;
    }
  }
  EXPECT_GT(red, 50);
  EXPECT_GT(blue, 50);
}

TEST_F(Render, AFlatGasIsAPictureAndALiquidASurface) {
  write("flat.gyre.json", R"({"gyre_scene": 1, "world": {"gravity": [0, 0, 0]}, "gases": [
    {"name": "sheet", "bounds": [[-1, -1, 0], [1, 1, 0.1]], "cells": [24, 24, 1], "color": "#ff0000",
     "emitters": [{"position": [-0.5, 0, 0.05], "radius": 0.3, "temperature": 293.15}]}]})");
  write("pool.gyre.json", R"({"gyre_scene": 1, "liquids": [
    {"name": "pool", "bounds": [[-1, -1, -1], [1, 1, 1]], "cell_size": 0.1, "color": "#0000ff",
     "fill": [{"box": [[-1, -1, -1], [1, 0, 1]]}]}]})");
  for (const char* name : {"flat", "pool"}) {
    ASSERT_EQ(draw({std::string(name) + ".gyre.json", "--out", std::string(name) + ".png", "--at", "0.1",
                    "--size", "96x96", "--samples", "8", "--camera", "0,0,6", "--look-at", "0,0,0"})
                  .code,
              0);
  }
  const Pixels flat = read_png(folder_ / "flat.png"), pool = read_png(folder_ / "pool.png");
  const std::array<double, 3> smoke = color_around(flat, 34, 48), clear = color_around(flat, 65, 48);
  EXPECT_GT(smoke[0], smoke[2] + 100.0);
  EXPECT_LT(clear[0], 60.0);
  const std::array<double, 3> water = color_around(pool, 48, 60), air = color_around(pool, 48, 30);
  EXPECT_GT(water[2], water[0] + 40.0);
  EXPECT_LT(air[2], air[0] + 40.0);
}

TEST_F(Render, EverySceneOfTheRepositoryIsAPicture) {
  int scenes = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(GYRE_SOURCE_DIR) / "scenes")) {
    const std::string name = entry.path().filename().string();
    if (name.size() < 10 || name.substr(name.size() - 10) != ".gyre.json") continue;
    ++scenes;
    const Finished done =
        draw_small({entry.path().string(), "--out", "a.gif", "--frames", "2", "--fps", "4"});
    EXPECT_EQ(done.code, 0) << name << done.err;
    int width = 0, height = 0;
    EXPECT_EQ(count_frames(folder_ / "a.gif", width, height), 2) << name;
    ASSERT_EQ(draw_small({entry.path().string(), "--out", "a.png"}).code, 0) << name;
    EXPECT_GT(spread(read_png(folder_ / "a.png")), 8.0) << name;
  }
  EXPECT_GE(scenes, 14);
}

#endif

}  // namespace
}  // namespace gyre::render_test
