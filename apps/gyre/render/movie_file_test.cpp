// Palettes, GIF files and the names of frames: what is written is read back by the libraries' own readers.
#include "render/frame_path.h"
#include "render/gif_file.h"
#include "render/light_samples.h"
#include "render/palette.h"
#include "render/png_file.h"

#include <gif_lib.h>
#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <set>

namespace gyre::movie_file_test {
namespace {

Picture gradient(int width, int height, int blue) {
  Picture picture{width, height, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (const int part : {255 * x / (width - 1), 255 * y / (height - 1), blue}) {
        picture.bytes.push_back(std::uint8_t(part));
      }
    }
  }
  return picture;
}

struct Reading {
  const std::string& bytes;
  std::size_t at = 0;
};
int read_some(GifFileType* file, GifByteType* to, int count) {
  Reading& reading = *static_cast<Reading*>(file->UserData);
  const std::size_t have = std::min(std::size_t(count), reading.bytes.size() - reading.at);
  std::memcpy(to, reading.bytes.data() + reading.at, have);
  reading.at += have;
  return int(have);
}

struct Movie {
  std::vector<Picture> frames;
  std::vector<int> delays;
};
Movie read_gif(const std::string& bytes) {
  Movie movie;
  Reading reading{bytes};
  int error = 0;
  GifFileType* file = DGifOpen(&reading, read_some, &error);
  if (!file || DGifSlurp(file) == GIF_ERROR) return movie;
  Picture shown{file->SWidth, file->SHeight,
                std::vector<std::uint8_t>(std::size_t(file->SWidth * file->SHeight * 3))};
  for (int i = 0; i < file->ImageCount; ++i) {
    const SavedImage& image = file->SavedImages[i];
    GraphicsControlBlock control;
    DGifSavedExtensionToGCB(file, i, &control);
    for (int y = 0; y < image.ImageDesc.Height; ++y) {
      for (int x = 0; x < image.ImageDesc.Width; ++x) {
        const int number = image.RasterBits[y * image.ImageDesc.Width + x];
        if (number == control.TransparentColor) continue;
        const GifColorType color = file->SColorMap->Colors[number];
        const std::size_t to =
            std::size_t(3 * ((y + image.ImageDesc.Top) * file->SWidth + x + image.ImageDesc.Left));
        shown.bytes[to] = color.Red;
        shown.bytes[to + 1] = color.Green;
        shown.bytes[to + 2] = color.Blue;
      }
    }
    movie.frames.push_back(shown);
    movie.delays.push_back(control.DelayTime);
  }
  DGifCloseFile(file, &error);
  return movie;
}

double mean_error(const Picture& a, const Picture& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.bytes.size(); ++i) sum += std::abs(int(a.bytes[i]) - int(b.bytes[i]));
  return sum / double(a.bytes.size());
}

TEST(Palette, FewColorsStayAsTheyAre) {
  Picture picture{3, 1, {10, 20, 30, 250, 0, 0, 0, 128, 255}};
  ColorCount colors;
  colors.add(picture);
  const std::vector<Rgb> palette = make_palette(colors, 255);
  const std::set<Rgb> expected = {{10, 20, 30}, {250, 0, 0}, {0, 128, 255}};
  EXPECT_EQ(std::set<Rgb>(palette.begin(), palette.end()), expected);
}

TEST(Palette, SpreadsOverAllThatIsThere) {
  ColorCount colors;
  colors.add(gradient(64, 64, 100));
  const std::vector<Rgb> palette = make_palette(colors, 200);
  EXPECT_EQ(palette.size(), 200u);
  // 200 colours over a square of 256 x 256 are 18 apart; no colour of the picture is farther than that from one of them.
  for (int red = 0; red < 256; red += 15) {
    for (int green = 0; green < 256; green += 15) {
      int nearest = 1000;
      for (const Rgb& color : palette)
        nearest = std::min(nearest, std::max(std::abs(color[0] - red), std::abs(color[1] - green)));
      EXPECT_LE(nearest, 24) << red << " " << green;
    }
  }
}

TEST(Gif, ReadsBackAsWhatWasDrawn) {
  std::vector<Picture> frames = {gradient(40, 30, 0), gradient(40, 30, 0), gradient(40, 30, 120)};
  for (std::size_t i = 0; i < 60; ++i) frames[1].bytes[900 + i] = 255;  // a small white change
  std::string error;
  const std::string bytes = gif_bytes(frames, 0.05, error);
  ASSERT_EQ(error, "");
  const Movie movie = read_gif(bytes);
  ASSERT_EQ(movie.frames.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_LT(mean_error(movie.frames[i], frames[i]), 6.0) << i;
  EXPECT_EQ(movie.delays, (std::vector<int>{5, 5, 5}));
  EXPECT_NE(bytes.find("NETSCAPE2.0"), std::string::npos);
  EXPECT_EQ(gif_bytes(frames, 0.05, error), bytes);
}

TEST(Gif, UnchangedFramesCostNextToNothing) {
  std::string error;
  const std::string one = gif_bytes({gradient(100, 80, 7)}, 0.05, error);
  const std::string many = gif_bytes(std::vector<Picture>(50, gradient(100, 80, 7)), 0.05, error);
  EXPECT_LT(many.size(), one.size() + 50 * 40);
  EXPECT_EQ(read_gif(many).frames.size(), 50u);
}

TEST(Gif, HundredthsOfASecondAreRightOnAverage) {
  std::string error;
  const Movie movie = read_gif(gif_bytes(std::vector<Picture>(30, gradient(8, 8, 7)), 1.0 / 30, error));
  int sum = 0;
  for (const int delay : movie.delays) sum += delay;
  EXPECT_EQ(sum, 100);
}

TEST(Png, ReadsBackBitForBit) {
  const Picture picture = gradient(33, 17, 200);
  std::string error;
  const std::string bytes = png_bytes(picture, error);
  ASSERT_EQ(error, "");
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  ASSERT_TRUE(png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()));
  image.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> read(PNG_IMAGE_SIZE(image));
  ASSERT_TRUE(png_image_finish_read(&image, nullptr, read.data(), 0, nullptr));
  EXPECT_EQ(image.width, 33u);
  EXPECT_EQ(image.height, 17u);
  EXPECT_EQ(read, picture.bytes);
}

TEST(Picture, LightGoesThereAndBack) {
  for (int value = 0; value < 230; ++value) {
    const float light = linear_light(std::uint8_t(value));
    if (light > 0.8f) break;  // beyond, the curve bends on purpose
    const Picture picture = develop(std::vector<float>{2 * light, 2 * light, 2 * light, 2}, 1, 1, 2);
    EXPECT_NEAR(picture.bytes[0], value, value < 8 ? 1 : 0) << value;
  }
}

TEST(FramePath, NumbersStandWhereTheyAreWanted) {
  FramePath path;
  ASSERT_EQ(parse_frame_path("frames/%04d.png", path), "");
  EXPECT_EQ(path.kind, OutputKind::numbered);
  EXPECT_EQ(path.at(7), "frames/0007.png");
  EXPECT_EQ(path.at(123456), "frames/123456.png");
  ASSERT_EQ(parse_frame_path("100%%_%d.png", path), "");
  EXPECT_EQ(path.at(7), "100%_7.png");
  ASSERT_EQ(parse_frame_path("a.png", path), "");
  EXPECT_EQ(path.kind, OutputKind::picture);
  ASSERT_EQ(parse_frame_path("a.gif", path), "");
  EXPECT_EQ(path.kind, OutputKind::movie);
  for (const char* bad :
       {"", ".png", "a", "a.jpg", "a%s.png", "a%.png", "%d%d.png", "%d.gif", "%999d.png", "%4.png", "%"}) {
    EXPECT_NE(parse_frame_path(bad, path), "") << bad;
  }
}

TEST(LightSamples, AreEvenlySpread) {
  const Vec3 sun = normalized(Vec3{0.3f, 0.8f, 0.2f});
  for (const int count : {1, 16, 48, 100}) {
    Vec3 sky_sum, sun_sum;
    float x = 0, y = 0;
    for (int i = 0; i < count; ++i) {
      const LightSample sample = light_sample(i, count, sun);
      EXPECT_NEAR(length(sample.sky), 1.0f, 1e-5f);
      EXPECT_GT(sample.sky.y, 0.0f);
      EXPECT_GT(dot(sample.sun, sun), 0.998f);
      sky_sum += sample.sky;
      sun_sum += sample.sun;
      x += sample.pixel_x;
      y += sample.pixel_y;
    }
    const float share = 1.0f / float(count);
    // The mean of the cosine over half a ball is a half: what faces up gets the light of the whole sky.
    EXPECT_NEAR(share * sky_sum.y, 0.5f, 1e-4f);
    if (count > 1) {
      EXPECT_NEAR(share * sky_sum.x, 0.0f, 2.0f * share);
      EXPECT_NEAR(share * x, 0.0f, 1e-5f);
      EXPECT_NEAR(share * y, 0.0f, 1e-5f);
    }
    EXPECT_GT(dot(normalized(sun_sum), sun), 0.9999f);
  }
}

}  // namespace
}  // namespace gyre::movie_file_test
