// Solids that are made of a closed surface: checks, mass, and the surface that they carry along.
#include "math/rotation.h"
#include "soft/mesh/tetrahedral_fill_test_meshes.h"
#include "soft/store/soft_builder.h"

#include <gtest/gtest.h>

#include <string>

namespace gyre::filled_solid_test {
namespace {

SolidDef bunny_def() {
  const TestMesh mesh = bunny_mesh(3);
  SolidDef def;
  def.surface = SolidSurface{mesh.vertices, mesh.indices, 12};
  def.pose = {{1.0e6, -2.0, 3.0}, normalized(Quat{1, 2, 3, 4})};
  def.density = 700.0f;
  return def;
}
SoftEntry built(const SolidDef& def) { return build_soft(std::make_shared<const SoftDef>(def)); }

TEST(FilledSolid, HasTheMassOfTheSurface) {
  const SolidDef def = bunny_def();
  ASSERT_TRUE(check_soft(def).ok()) << check_soft(def).message;
  const SoftEntry entry = built(def);
  double mass = 0.0;
  for (int i = 0; i < entry.body.particles.count; ++i) mass += double(entry.body.particles.mass[i]);
  EXPECT_NEAR(mass, 700.0 * bunny_mesh(3).volume(), 1.0e-4 * mass);
}

TEST(FilledSolid, CarriesItsSurfaceAlong) {
  const SolidDef def = bunny_def();
  SoftEntry entry = built(def);
  ASSERT_EQ(entry.surface.points.size(), def.surface->vertices.size());
  ASSERT_EQ(entry.surface.triangles.size(), def.surface->triangles.size());
  const DQuat turn = to_double(def.pose.orientation);
  const auto expect_at = [&](DVec3 moved) {
    for (std::size_t i = 0; i < entry.surface.points.size(); ++i) {
      const DVec3 expected = def.pose.position + rotate(turn, DVec3(def.surface->vertices[i])) + moved;
      EXPECT_LT(length(surface_position(entry, i) - expected), 3.0e-6) << i;
    }
  };
  expect_at({0, 0, 0});
  for (int i = 0; i < entry.body.particles.count; ++i)
    entry.body.particles.set_place(i, entry.body.particles.place(i) + DVec3{10, 20, 30});
  expect_at({10, 20, 30});
}

TEST(FilledSolid, CollidesWithTheFacesOfItsTetrahedra) {
  const SoftEntry entry = built(bunny_def());
  double volume = 0.0;
  const DVec3 middle = entry.body.particles.place(0);
  for (std::size_t i = 0; i < entry.triangles.size(); i += 3) {
    const DVec3 a = entry.body.particles.place(int(entry.triangles[i])) - middle,
                b = entry.body.particles.place(int(entry.triangles[i + 1])) - middle,
                c = entry.body.particles.place(int(entry.triangles[i + 2])) - middle;
    volume += dot(a, cross(b, c)) / 6.0;
  }
  EXPECT_NEAR(volume, bunny_mesh(3).volume(), 0.05 * volume);
}

TEST(FilledSolid, IsAPureFunctionOfItsDefinition) {
  const SoftEntry one = built(bunny_def()), other = built(bunny_def());
  EXPECT_EQ(one.body.particles.x, other.body.particles.x);
  EXPECT_EQ(one.body.particles.mass, other.body.particles.mass);
  EXPECT_EQ(one.triangles, other.triangles);
}

TEST(FilledSolid, RefusesWhatItCannotFill) {
  SolidDef def = bunny_def();
  def.surface->resolution = 500;
  EXPECT_EQ(std::string(check_soft(def).message), "surface.resolution: 500; allowed are 2 to 128");
  def.surface->resolution = 12;
  def.surface->triangles.resize(30);
  EXPECT_EQ(check_soft(def).code, ErrorCode::invalid_geometry);
  EXPECT_EQ(std::string(check_soft(def).message).rfind("surface.mesh: edge from vertex", 0), 0u)
      << check_soft(def).message;
  def = bunny_def();
  def.box = SolidBox{};
  EXPECT_EQ(std::string(check_soft(def).message),
            "2 of box, surface and tetrahedra are given; a solid is one of them");
  def.box.reset();
  def.settings.positions.resize(3);
  EXPECT_NE(std::string(check_soft(def).message).find("settings.positions has 3 entries; there are"),
            std::string::npos);
}

}  // namespace
}  // namespace gyre::filled_solid_test
