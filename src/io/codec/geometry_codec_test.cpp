#include "io/codec/geometry_codec.h"

#include "determinism/scenes.h"
#include "geometry/shape/cooked.h"
#include "geometry/shape/height_field.h"
#include "geometry/shape/hull.h"
#include "geometry/shape/mesh.h"

#include <gtest/gtest.h>

#include <cstring>

namespace gyre::geometry_codec_test {
namespace {

Geometry random_hull(std::uint32_t seed, int points) {
  scenes::Random random(seed);
  std::vector<Vec3> corners;
  for (int i = 0; i < points; ++i) corners.push_back(random.next_vector(1));
  return *cook_hull(corners);
}

// A bumpy mesh with degenerate triangles and vertices to weld.
Geometry rough_mesh(bool double_sided) {
  std::vector<Vec3> vertices;
  std::vector<std::uint32_t> indices;
  for (int row = 0; row < 12; ++row) {
    for (int column = 0; column < 12; ++column) {
      const float height = row < 5 ? 0.0f : 0.125f * float(row * column % 7);
      for (int twice = 0; twice < 2; ++twice) vertices.push_back({float(column), height, float(row)});
    }
  }
  for (std::uint32_t i = 0; i < 11 * 11; ++i) {
    const std::uint32_t at = 2 * (12 * (i / 11) + i % 11) + i % 2;
    for (const std::uint32_t corner : {at, at + 24, at + 2, at + 2, at + 24, at + 26})
      indices.push_back(corner % 288);
    if (i % 5 == 0) indices.insert(indices.end(), {at, at, at + 2});
    if (i % 7 == 0) indices.insert(indices.end(), {at, at + 24, at + 2});
  }
  return *cook_mesh({vertices, indices, double_sided});
}

Geometry holed_field() {
  std::vector<float> heights;
  for (int i = 0; i < 9 * 6; ++i)
    heights.push_back(i % 11 == 3 ? __builtin_nanf("") : 0.25f * float(i * i % 13));
  return *cook_height_field({heights, 9, 6, 0.5f});
}

template <class T>
void expect_same(const std::vector<T>& a, const std::vector<T>& b) {
  ASSERT_EQ(a.size(), b.size());
  EXPECT_TRUE(a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

Result<Geometry> pass_through(const Geometry& geometry) {
  ByteWriter out;
  write_geometry(out, geometry);
  ByteReader in(out.view());
  Result<Geometry> back = read_geometry(in, {});
  EXPECT_TRUE(in.finished());
  EXPECT_TRUE(back) << back.error().message;
  return back;
}

TEST(GeometryCodec, HullsComeBackBitForBit) {
  for (const int points : {4, 8, 30, 400}) {
    const Geometry hull = random_hull(std::uint32_t(points), points);
    const Result<Geometry> back = pass_through(hull);
    ASSERT_TRUE(back);
    const Hull &a = *hull.data()->hull, &b = *back->data()->hull;
    EXPECT_EQ(hull.content_hash(), back->content_hash());
    expect_same(a.x, b.x), expect_same(a.y, b.y), expect_same(a.z, b.z);
    expect_same(a.vertices, b.vertices);
    expect_same(a.planes, b.planes);
    expect_same(a.face_offsets, b.face_offsets);
    expect_same(a.face_vertices, b.face_vertices);
    expect_same(a.edges, b.edges);
    EXPECT_EQ(a.box.low, b.box.low);
    EXPECT_EQ(a.box.high, b.box.high);
    EXPECT_EQ(a.centroid, b.centroid);
    EXPECT_EQ(a.inner_radius, b.inner_radius);
  }
}

TEST(GeometryCodec, MeshesComeBackBitForBit) {
  for (const bool double_sided : {false, true}) {
    const Geometry mesh = rough_mesh(double_sided);
    const Result<Geometry> back = pass_through(mesh);
    ASSERT_TRUE(back);
    const Mesh &a = *mesh.data()->mesh, &b = *back->data()->mesh;
    EXPECT_EQ(mesh.content_hash(), back->content_hash());
    expect_same(a.vertices, b.vertices), expect_same(a.indices, b.indices), expect_same(a.normals, b.normals);
    expect_same(a.twins, b.twins), expect_same(a.flags, b.flags), expect_same(a.source, b.source);
    expect_same(a.tree.nodes, b.tree.nodes), expect_same(a.flat_lanes, b.flat_lanes);
    EXPECT_EQ(a.double_sided, b.double_sided);
  }
}

TEST(GeometryCodec, HeightFieldsComeBackBitForBit) {
  const Geometry field = holed_field();
  const Result<Geometry> back = pass_through(field);
  ASSERT_TRUE(back);
  EXPECT_EQ(field.content_hash(), back->content_hash());
  expect_same(field.data()->field->heights, back->data()->field->heights);
  expect_same(field.data()->field->flat_samples, back->data()->field->flat_samples);
}

TEST(GeometryCodec, WhatIsKnownIsShared) {
  const Geometry hull = random_hull(1, 12);
  ByteWriter out;
  write_geometry(out, hull);
  GeometryTable known;
  EXPECT_TRUE(known.add(hull));
  EXPECT_FALSE(known.add(hull));
  ByteReader in(out.view());
  EXPECT_EQ(read_geometry(in, known)->data(), hull.data());
}

TEST(GeometryCodec, EveryShapeComesBack) {
  const Geometry hull = random_hull(2, 12);
  GeometryTable table;
  table.add(hull);
  const AnyShape shapes[] = {Sphere{0.25f},       Box{{1, 2, 3}, 0.5f}, Capsule{0.5f, 2}, Cylinder{0.75f, 3},
                             Cone{0.125f, 0.25f}, Plane{{1, 0, 0}, 7},  AnyShape(hull)};
  for (const AnyShape& shape : shapes) {
    ByteWriter out;
    write_shape(out, shape);
    ByteReader in(out.view());
    const AnyShape back = read_shape(in, table);
    EXPECT_TRUE(in.finished());
    ByteWriter again;
    write_shape(again, back);
    ASSERT_EQ(out.size(), again.size());
    EXPECT_EQ(std::memcmp(out.view().data(), again.view().data(), out.size()), 0);
  }
  ByteWriter out;
  write_shape(out, shapes[6]);
  ByteReader in(out.view());
  read_shape(in, {});
  EXPECT_TRUE(in.failed()) << "geometry that is not in the table";
}

// Each byte of each kind with several values, and each length: refused, or a valid geometry.
TEST(GeometryCodec, DamageIsRefusedOrHarmless) {
  int refused = 0;
  for (const Geometry& geometry : {random_hull(3, 10), rough_mesh(false), holed_field()}) {
    ByteWriter out;
    write_geometry(out, geometry);
    const std::vector<std::byte> good(out.view().begin(), out.view().end());
    for (std::size_t place = 0; place<good.size(); place += good.size()> 2000 ? 17 : 1) {
      for (const unsigned flip : {0x01u, 0x80u, 0xffu}) {
        std::vector<std::byte> bytes = good;
        bytes[place] ^= std::byte(flip);
        ByteReader in(bytes);
        if (!read_geometry(in, {})) ++refused;
      }
      ByteReader in(std::span<const std::byte>(good).first(place));
      EXPECT_FALSE(read_geometry(in, {})) << "cut at " << place;
    }
  }
  EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace gyre::geometry_codec_test
