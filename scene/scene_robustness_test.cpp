// The reader against bytes that nobody meant: cut off anywhere, with any byte changed. It answers with a scene or an error,
// and what it reads it can write and read again.
#include "scene/scene_reader.h"
#include "scene/scene_writer.h"

#include <gtest/gtest.h>

#include <clocale>
#include <string>

namespace gyre::scene_robustness_test {
namespace {

const std::string kSmall = R"({
  "gyre_scene": 1,
  "name": "small",
  "world": {"gravity": [0, -9.81, 0.5], "substeps": 2, "sleeping": false},
  "materials": {"ice": {"density": 917, "static_friction": 0.1, "dynamic_friction": 0.03}, "oak": {}},
  "material_pairs": [{"materials": ["ice", "oak"], "restitution": 0.25}],
  "meshes": {"m": {"vertices": [[0,0,0],[1,0,0],[0,1,0],[0,0,1]], "triangles": [[0,2,1],[0,1,3]]}},
  "bodies": [
    {"name": "g", "type": "static", "shapes": [{"type": "plane"}, {"type": "mesh", "mesh": "m"}]},
    {"name": "b", "position": [0, 1e0, 0], "orientation": {"axis": [0, 1, 0], "angle": 0.5}, "mass": 2,
     "shapes": [{"type": "box", "half_extents": [0.5, 0.25, 1], "material": "ice"}],
     "forces": [{"force": [1, 0, 0], "end": 2, "frame": "body"}]}
  ],
  "joints": [{"type": "hinge", "a": "world", "b": "b", "anchor": [0, 0, 0], "axis": [0, 0, 1], "limits": [-1, 1]}]
})";

TEST(SceneRobustness, SmallSceneIsValid) {
  const SceneResult<Scene> read = read_scene(kSmall);
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read->bodies.size(), 2u);
  EXPECT_EQ(read->joints.size(), 1u);
}

TEST(SceneRobustness, CutOffAnywhereIsAnError) {
  for (std::size_t size = 0; size < kSmall.size(); ++size) {
    const SceneResult<Scene> read = read_scene(std::string_view(kSmall).substr(0, size));
    EXPECT_FALSE(read) << size;
    EXPECT_FALSE(read.error().message.empty()) << size;
  }
}

TEST(SceneRobustness, AnyByteChangedIsASceneOrAnError) {
  int scenes = 0;
  for (std::size_t i = 0; i < kSmall.size(); ++i) {
    for (const int flip : {0x01, 0x02, 0x04, 0x08, 0x10, 0x20, 0x40, 0x80, 0xff}) {
      std::string text = kSmall;
      text[i] = char(text[i] ^ flip);
      const SceneResult<Scene> read = read_scene(text);
      if (!read) {
        EXPECT_FALSE(read.error().text().empty());
        continue;
      }
      ++scenes;
      const std::string once = write_scene(*read);
      const SceneResult<Scene> again = read_scene(once);
      ASSERT_TRUE(again) << again.error().text() << "\n" << once;
      EXPECT_EQ(write_scene(*again), once);
    }
  }
  EXPECT_GT(scenes, 100);  // digits and letters of names
}

TEST(SceneRobustness, ByteOrderMarkAndLineEndsDoNotMatter) {
  EXPECT_TRUE(read_scene("\xef\xbb\xbf" + kSmall));
  std::string windows;
  for (const char c : kSmall) windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_TRUE(read_scene(windows));
  EXPECT_TRUE(read_scene(kSmall + "\n\n \t\r\n"));
  EXPECT_FALSE(read_scene("\xef\xbb" + kSmall));
  std::string wide;
  for (const char c : kSmall) wide += std::string(1, c) + '\0';
  EXPECT_FALSE(read_scene(wide));
}

// A locale with a decimal comma must not change how numbers are read or written.
TEST(SceneRobustness, NumbersDoNotFollowTheLocale) {
  const std::string plain = write_scene(*read_scene(kSmall));
  const std::string before = std::setlocale(LC_ALL, nullptr);
  const char* comma = nullptr;
  for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "de_DE", "fr_FR"}) {
    if (!comma) comma = std::setlocale(LC_ALL, name);
  }
  if (!comma) GTEST_SKIP() << "no locale with a decimal comma here";
  const SceneResult<Scene> read = read_scene(kSmall);
  const std::string text = read ? write_scene(*read) : read.error().text();
  std::setlocale(LC_ALL, before.c_str());
  EXPECT_EQ(text, plain);
}

TEST(SceneRobustness, HugeAndTinyNumbers) {
  const auto with_mass = [](const std::string& number) {
    return read_scene(R"({"gyre_scene": 1, "bodies": [{"name": "b", "mass": )" + number + "}]}");
  };
  EXPECT_FALSE(with_mass("1e39"));
  EXPECT_FALSE(with_mass("1e400"));
  EXPECT_FALSE(with_mass("1" + std::string(400, '0')));
  EXPECT_FALSE(with_mass("1e-400"));
  EXPECT_FALSE(with_mass("0x10"));
  EXPECT_FALSE(with_mass("01"));
  EXPECT_FALSE(with_mass("+1"));
  EXPECT_FALSE(with_mass("1."));
  EXPECT_FALSE(with_mass("1e99999999999999999999"));
  EXPECT_TRUE(with_mass("3.4e38"));
  EXPECT_TRUE(with_mass("1.5e-38"));
  EXPECT_TRUE(with_mass("1." + std::string(100000, '0') + "1"));
  EXPECT_TRUE(with_mass("4"));
}

}  // namespace
}  // namespace gyre::scene_robustness_test
