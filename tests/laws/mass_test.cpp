// Mass, centre and inertia of every shape and of meshes, by the numbers of the validation table; closed forms of textbooks.
// src/geometry/mass/mass_test.cpp tests the functions one by one.
#include "laws/kit.h"

#include <cstring>
#include <string>

namespace gyre::laws::mass_test {
namespace {

struct TestMesh {
  std::vector<Vec3> vertices;
  std::vector<std::uint32_t> indices;
};

MassProperties of(const AnyShape& shape, float density = 1000.0f) {
  const Result<MassProperties> mass = mass_properties(shape, density);
  EXPECT_TRUE(mass) << mass.error().message;
  return mass ? *mass : MassProperties{};
}
MassProperties of(const TestMesh& mesh, float density) {
  const Result<MassProperties> mass = mesh_mass(mesh.vertices, mesh.indices, density);
  EXPECT_TRUE(mass) << mass.error().message;
  return mass ? *mass : MassProperties{};
}

// Mass and the three moments, to a part in a million.
void expect_mass(const char* id, const MassProperties& found, double mass, DVec3 moments) {
  const std::string name = id;
  EXPECT_TRUE(relative_row((name + " mass (kg)").c_str(), double(found.mass), mass, 1e-6, 1e-7));
  EXPECT_TRUE(
      relative_row((name + " Ixx (kg m^2)").c_str(), double(found.inertia.xx), moments.x, 1e-6, 1e-7));
  EXPECT_TRUE(
      relative_row((name + " Iyy (kg m^2)").c_str(), double(found.inertia.yy), moments.y, 1e-6, 1e-7));
  EXPECT_TRUE(
      relative_row((name + " Izz (kg m^2)").c_str(), double(found.inertia.zz), moments.z, 1e-6, 1e-7));
}

TestMesh box_mesh(Vec3 half) {
  TestMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.push_back(
        {(i & 1) ? half.x : -half.x, (i & 2) ? half.y : -half.y, (i & 4) ? half.z : -half.z});
  mesh.indices = {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                  2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
  return mesh;
}

TEST(MassRow, OfSimpleShapes) {
  expect_mass("A-130 box", of(Box{{0.5f, 1.0f, 1.5f}}), 6000, {6500, 5000, 2500});
  const double ball = 1000.0 * 4.0 / 3.0 * kPiDouble * 0.125, skin = 10.0 * 4.0 * kPiDouble * 0.25;
  expect_mass("A-131 sphere", of(Sphere{0.5f}), ball, 0.4 * ball * 0.25 * DVec3{1, 1, 1});
  expect_mass("A-131 shell", hollow_sphere_mass(0.5f, 10.0f), skin, 2.0 / 3.0 * skin * 0.25 * DVec3{1, 1, 1});
  expect_mass("A-132 capsule", of(Capsule{0.25f, 0.5f}), 261.7994, {43.565054, 7.772169, 43.565054});
  expect_mass("A-133 cylinder", of(Cylinder{0.5f, 1.0f}), 1570.7963, {621.77355, 196.34954, 621.77355});
  const MassProperties cone = of(Cone{0.5f, 0.75f});
  expect_mass("A-134 cone", cone, 392.6991, {47.860201, 29.452431, 47.860201});
  EXPECT_TRUE(row("A-134 centre above the base (m)", 0.75 + double(cone.center.y), 0.375, 1e-6, 1e-7));
  expect_mass("A-135 ellipsoid", ellipsoid_mass({0.5f, 0.3f, 0.2f}, 1000.0f), 125.66371,
              {3.267256, 7.288495, 8.545132});
}

// The hull with 32 sides that stands for a cylinder has less mass, and says how much it has.
TEST(MassRow, OfACylinderAsAHull) {
  std::vector<Vec3> points;
  for (int i = 0; i < 32; ++i) {
    const double a = 2 * kPiDouble * i / 32;
    for (const float y : {-1.0f, 1.0f})
      points.push_back({float(0.5 * std::cos(a)), y, float(0.5 * std::sin(a))});
  }
  const MassProperties hull = of(*cook_hull(points));
  EXPECT_TRUE(relative_row("A-133 mass of a hull of 32 sides (kg)", double(hull.mass), 1560.72, 1e-5, 1e-5));
  EXPECT_TRUE(relative_row("A-133 axial of that hull (kg m^2)", double(hull.inertia.yy), 193.84, 5e-5, 5e-5));
}

TestMesh torus_mesh(int around, int across) {
  TestMesh mesh;
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      const double a = 2 * kPiDouble * i / around, b = 2 * kPiDouble * j / across,
                   r = 1.0 + 0.25 * std::cos(b);
      mesh.vertices.push_back({float(r * std::cos(a)), float(0.25 * std::sin(b)), float(r * std::sin(a))});
      const auto at = [&](int u, int v) { return std::uint32_t((u % around) * across + v % across); };
      mesh.indices.insert(mesh.indices.end(), {at(i, j), at(i, j + 1), at(i + 1, j), at(i + 1, j),
                                               at(i, j + 1), at(i + 1, j + 1)});
    }
  }
  return mesh;
}

// A mesh errs by the square of its steps; what two of them err differently by is the limit, to the fourth power.
TEST(MassRow, OfATorusMeshConverges) {
  const double exact[3] = {1233.70055, 1291.53026, 665.04170};
  double last[3] = {};
  const char* const names[3] = {"mass (kg)", "axial (kg m^2)", "about a diameter (kg m^2)"};
  for (const int n : {32, 64, 128}) {
    const MassProperties mass = of(torus_mesh(2 * n, n), 1000.0f);
    const double found[3] = {double(mass.mass), double(mass.inertia.yy), double(mass.inertia.xx)};
    for (int k = 0; k < 3; ++k) {
      const double error = exact[k] - found[k];
      if (n > 32) {
        EXPECT_TRUE(row(("A-136 error at twice the steps: " + std::string(names[k])).c_str(), last[k] / error,
                        4.0, 0.1, 0.05));
      }
      if (n == 128) {
        EXPECT_TRUE(relative_row(("A-136 extrapolated " + std::string(names[k])).c_str(),
                                 found[k] + (last[k] - error) / 3.0, exact[k], 2e-6, 1e-6));
      }
      last[k] = error;
    }
  }
}

TEST(MassRow, OfATetrahedron) {
  const MassProperties corner = tetrahedron_mass({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, 1.0f);
  expect_mass("A-137 tetrahedron", corner, 1.0 / 6.0, DVec3{1, 1, 1} / 80.0);
  EXPECT_TRUE(relative_row("A-137 centre (m)", double(corner.center.x), 0.25, 1e-6, 1e-7));
  EXPECT_TRUE(relative_row("A-137 Ixy (kg m^2)", double(corner.inertia.xy), 1.0 / 480.0, 1e-6, 1e-7));
  const MassProperties regular = tetrahedron_mass({1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}, 3.0f);
  expect_mass("A-137 regular tetrahedron", regular, 8.0, 8.0 * 8.0 / 20.0 * DVec3{1, 1, 1});
}

TEST(MassRow, OfAHollowCube) {
  TestMesh mesh = box_mesh({1, 1, 1});
  const TestMesh inner = box_mesh({0.5f, 0.5f, 0.5f});
  mesh.vertices.insert(mesh.vertices.end(), inner.vertices.begin(), inner.vertices.end());
  for (std::size_t i = 0; i < inner.indices.size(); i += 3) {
    mesh.indices.insert(mesh.indices.end(),
                        {8 + inner.indices[i], 8 + inner.indices[i + 2], 8 + inner.indices[i + 1]});
  }
  expect_mass("A-139 hollow cube", of(mesh, 1.0f), 7.0, 5.1666667 * DVec3{1, 1, 1});
}

// By a body of two shapes, as a user makes it.
TEST(MassRow, OfHalfWoodHalfLead) {
  World world = make_world();
  const ShapeDef halves[2] = {{.geometry = Box{}, .local = {.position = {-0.5f, 0, 0}}, .density = 600.0f},
                              {.geometry = Box{}, .local = {.position = {0.5f, 0, 0}}, .density = 11340.0f}};
  const MassProperties both = world.mass_properties(world.add_body({}, halves));
  EXPECT_TRUE(relative_row("A-140 centre (m)", double(both.center.x), 0.4497487, 1e-6, 1e-7));
  expect_mass("A-140 half wood, half lead", both, 11940, {1990.0, 2559.84925, 2559.84925});
}

// Eight balls at the corners of a cube of 2 m, a hundred metres off along each axis: as they are about the origin.
TEST(MassRow, OfPartsFarAwayDoesNotCancel) {
  World world = make_world();
  std::vector<ShapeDef> near, far;
  for (int i = 0; i < 8; ++i) {
    const Vec3 p{i & 1 ? 1.0f : -1.0f, i & 2 ? 1.0f : -1.0f, i & 4 ? 1.0f : -1.0f};
    near.push_back({.geometry = Sphere{0.5f}, .local = {.position = p}});
    far.push_back({.geometry = Sphere{0.5f}, .local = {.position = p + Vec3{100, 100, 100}}});
  }
  const MassProperties here = world.mass_properties(world.add_body({}, near));
  const MassProperties there = world.mass_properties(world.add_body({}, far));
  // Each 2/5 m r^2 and two arms of a metre.
  const double m = 1000.0 * 4.0 / 3.0 * kPiDouble * 0.125, moment = 8.0 * (0.4 * m * 0.25 + 2.0 * m);
  EXPECT_TRUE(relative_row("A-141 near", double(here.inertia.xx), moment, 1e-6, 1e-7));
  EXPECT_TRUE(relative_row("A-141 far", double(there.inertia.xx), moment, 1e-5, 1e-6));
  EXPECT_TRUE(
      row("A-141 products of inertia (relative)", double(there.inertia.xy) / moment, 0.0, 1e-5, 1e-6));
}

std::string refusal(const TestMesh& mesh) {
  const Result<MassProperties> mass = mesh_mass(mesh.vertices, mesh.indices, 1000.0f);
  return mass ? "" : mass.error().message;
}
// Nothing silent: an error of its own kind, in words, for each.
TEST(MassRow, OfBadMeshesIsRefused) {
  TestMesh open = box_mesh({1, 1, 1}), inverted = box_mesh({1, 1, 1}), crossing = box_mesh({1, 1, 1});
  open.indices.erase(open.indices.begin(), open.indices.begin() + 3);
  for (std::size_t i = 0; i < inverted.indices.size(); i += 3)
    std::swap(inverted.indices[i], inverted.indices[i + 1]);
  TestMesh other = box_mesh({0.5f, 0.5f, 0.5f});
  for (Vec3& v : other.vertices) v = v + Vec3{1, 1.1f, 0.9f};
  for (const std::uint32_t i : other.indices) crossing.indices.push_back(8 + i);
  crossing.vertices.insert(crossing.vertices.end(), other.vertices.begin(), other.vertices.end());
  EXPECT_NE(refusal(open).find("is open"), std::string::npos) << "A-142 " << refusal(open);
  EXPECT_NE(refusal(inverted).find("inside out"), std::string::npos) << "A-142 " << refusal(inverted);
  EXPECT_NE(refusal(crossing).find("cross each other"), std::string::npos) << "A-142 " << refusal(crossing);
  EXPECT_NE(refusal(box_mesh({1, 0, 1})).find("enclose"), std::string::npos)
      << "A-142 " << refusal(box_mesh({1, 0, 1}));
  say("[row] A-142 \"%s\"\n", refusal(open).c_str());
}

// A tensor that no body has is refused with the axis; one at the very limit, a flat plate, is not.
TEST(MassRow, OfImpossibleTensorsIsRefusedWithTheAxis) {
  const char* const axes[3] = {"axis x", "axis y", "axis z"};
  for (int axis = 0; axis < 3; ++axis) {
    World world = make_world();
    float d[3] = {1, 1, 1};
    d[axis] = 2.1f;
    EXPECT_FALSE(world.add_body({.inertia = Sym3{d[0], d[1], d[2], 0, 0, 0}}, {.geometry = Box{}}))
        << "A-143";
    ASSERT_FALSE(world.problems().empty());
    const char* const said = world.problems().back().message;
    EXPECT_NE(std::strstr(said, axes[axis]), nullptr) << "A-143 " << said;
    say("[row] A-143 \"%s\"\n", said);
    d[axis] = 2.0f;
    EXPECT_TRUE(world.add_body({.inertia = Sym3{d[0], d[1], d[2], 0, 0, 0}}, {.geometry = Box{}})) << "A-143";
  }
}

}  // namespace
}  // namespace gyre::laws::mass_test
