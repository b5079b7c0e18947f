// Decompositions as bytes: the round trip, and refusal of all invalid data.
#include "geometry/decomposition/decomposition_test_meshes.h"

#include <gyre/decomposition.h>

#include <gtest/gtest.h>

namespace gyre::decomposition_codec_test {
namespace {

TEST(DecompositionCodec, GivesBackWhatWasSaved) {
  const TestMesh mesh = beam_mesh();
  const DecompositionDef def = mesh.def();
  const std::uint64_t key = decomposition_key(def);
  const Result<Decomposition> made = decompose(def);
  ASSERT_TRUE(made) << made.error().message;
  const std::vector<std::byte> bytes = save_decomposition(*made, key);
  const Result<Decomposition> back = load_decomposition(bytes, key);
  ASSERT_TRUE(back) << back.error().message;
  ASSERT_EQ(back->hulls.size(), made->hulls.size());
  for (std::size_t i = 0; i < made->hulls.size(); ++i)
    EXPECT_EQ(back->hulls[i].content_hash(), made->hulls[i].content_hash());
  EXPECT_EQ(back->stats.overhang_bound, made->stats.overhang_bound);
  EXPECT_EQ(back->stats.solid_volume, made->stats.solid_volume);
  EXPECT_EQ(back->stats.within_concavity, made->stats.within_concavity);
  EXPECT_EQ(save_decomposition(*back, key), bytes);
}

TEST(DecompositionCodec, RefusesOtherKeysAndAnyDamage) {
  const TestMesh mesh = box_mesh({0, 0, 0}, {1, 1, 1});
  const std::uint64_t key = decomposition_key(mesh.def());
  const Result<Decomposition> made = decompose(mesh.def());
  ASSERT_TRUE(made);
  const std::vector<std::byte> bytes = save_decomposition(*made, key);
  EXPECT_FALSE(load_decomposition(bytes, key + 1));
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_FALSE(load_decomposition(std::span(bytes).first(size), key)) << size;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::vector<std::byte> damaged = bytes;
    damaged[i] ^= std::byte{0x10};
    EXPECT_FALSE(load_decomposition(damaged, key)) << i;
  }
}

TEST(DecompositionCodec, KeysTellMeshesAndSettingsApart) {
  const TestMesh mesh = box_mesh({0, 0, 0}, {1, 1, 1});
  const std::uint64_t key = decomposition_key(mesh.def());
  std::vector<std::uint64_t> keys{key};
  const auto changed = [&](auto&& change) {
    DecompositionDef def = mesh.def();
    change(def);
    return decomposition_key(def);
  };
  EXPECT_EQ(changed([](DecompositionDef& def) { def.threads = 3; }), key);
  keys.push_back(changed([](DecompositionDef& def) { def.concavity = 0.05f; }));
  keys.push_back(changed([](DecompositionDef& def) { def.max_hulls = 31; }));
  keys.push_back(changed([](DecompositionDef& def) { def.max_hull_vertices = 31; }));
  keys.push_back(changed([](DecompositionDef& def) { def.meaning = SurfaceMeaning::shell; }));
  keys.push_back(changed([](DecompositionDef& def) { def.shell_thickness = 0.5f; }));
  keys.push_back(decomposition_key(box_mesh({0, 0, 0}, {1, 1, 1.0000001f}).def()));
  TestMesh turned = mesh;
  turned.flip();
  keys.push_back(decomposition_key(turned.def()));
  for (std::size_t i = 0; i < keys.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) EXPECT_NE(keys[i], keys[k]) << i << ' ' << k;
  }
}

}  // namespace
}  // namespace gyre::decomposition_codec_test
