// Mass properties against closed forms and published numbers, against each other, and for input that must be refused.
#include "geometry/mass/mass.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace gyre::mass_test {
namespace {

using Points = std::vector<Vec3>;
using Indices = std::vector<std::uint32_t>;

struct TestMesh {
  Points vertices;
  Indices indices;
};

void expect_relative(double value, double wanted, double tolerance = 1e-6) {
  EXPECT_NEAR(value, wanted, tolerance * std::abs(wanted));
}

void expect_mass(const MassProperties& mass, double wanted, Vec3 center, Vec3 diagonal,
                 double tolerance = 1e-6) {
  expect_relative(double(mass.mass), wanted, tolerance);
  const double size = std::sqrt(double(largest(diagonal)) / wanted);
  EXPECT_NEAR(double(length(mass.center - center)), 0.0, tolerance * size);
  expect_relative(double(mass.inertia.xx), double(diagonal.x), tolerance);
  expect_relative(double(mass.inertia.yy), double(diagonal.y), tolerance);
  expect_relative(double(mass.inertia.zz), double(diagonal.z), tolerance);
  const double most = tolerance * double(largest(diagonal));
  EXPECT_NEAR(double(mass.inertia.xy), 0.0, most);
  EXPECT_NEAR(double(mass.inertia.xz), 0.0, most);
  EXPECT_NEAR(double(mass.inertia.yz), 0.0, most);
}

// Every number of two bodies within `tolerance` of the mass, the size and the largest moment.
void expect_same(const MassProperties& a, const MassProperties& b, double tolerance) {
  const double size = std::sqrt(double(b.inertia.xx + b.inertia.yy + b.inertia.zz) / double(b.mass));
  EXPECT_NEAR(double(a.mass), double(b.mass), tolerance * double(b.mass));
  EXPECT_NEAR(double(length(a.center - b.center)), 0.0, tolerance * size);
  const double most = tolerance * double(max(b.inertia.xx, max(b.inertia.yy, b.inertia.zz)));
  EXPECT_NEAR(double(a.inertia.xx), double(b.inertia.xx), most);
  EXPECT_NEAR(double(a.inertia.yy), double(b.inertia.yy), most);
  EXPECT_NEAR(double(a.inertia.zz), double(b.inertia.zz), most);
  EXPECT_NEAR(double(a.inertia.xy), double(b.inertia.xy), most);
  EXPECT_NEAR(double(a.inertia.xz), double(b.inertia.xz), most);
  EXPECT_NEAR(double(a.inertia.yz), double(b.inertia.yz), most);
}

MassProperties must_measure(const AnyShape& shape, float density = 1000.0f) {
  const Result<MassProperties> mass = mass_properties(shape, density);
  EXPECT_TRUE(mass) << mass.error().message;
  return mass ? *mass : MassProperties{};
}

MassProperties must_measure(const TestMesh& mesh, float density = 1000.0f) {
  const Result<MassProperties> mass = mesh_mass(mesh.vertices, mesh.indices, density);
  EXPECT_TRUE(mass) << mass.error().message;
  return mass ? *mass : MassProperties{};
}

std::string refusal(const TestMesh& mesh, ErrorCode code = ErrorCode::invalid_geometry) {
  const Result<MassProperties> mass = mesh_mass(mesh.vertices, mesh.indices, 1000.0f);
  EXPECT_FALSE(mass);
  EXPECT_EQ(mass.error().code, code) << mass.error().message;
  return mass.error().message;
}

bool contains(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

TestMesh box_mesh(Vec3 half, Vec3 center = {}) {
  TestMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.push_back(
        center + Vec3{(i & 1) ? half.x : -half.x, (i & 2) ? half.y : -half.y, (i & 4) ? half.z : -half.z});
  }
  mesh.indices = {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                  2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
  return mesh;
}

void append(TestMesh& mesh, const TestMesh& other, bool inside_out = false) {
  const auto base = std::uint32_t(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (std::size_t i = 0; i < other.indices.size(); i += 3) {
    const std::uint32_t a = other.indices[i], b = other.indices[i + 1], c = other.indices[i + 2];
    mesh.indices.insert(mesh.indices.end(),
                        {base + a, base + (inside_out ? c : b), base + (inside_out ? b : c)});
  }
}

void move(TestMesh& mesh, const Transform& t) {
  for (Vec3& v : mesh.vertices) v = t * v;
}

// Around y; `around` sections of a ring of radius 1 and `across` corners of a tube of radius `tube`.
TestMesh torus_mesh(int around, int across, float ring, float tube) {
  TestMesh mesh;
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      const double a = 2 * kPiDouble * i / around, b = 2 * kPiDouble * j / across;
      const double r = double(ring) + double(tube) * std::cos(b);
      mesh.vertices.push_back(
          {float(r * std::cos(a)), float(double(tube) * std::sin(b)), float(r * std::sin(a))});
      const auto at = [&](int u, int v) { return std::uint32_t((u % around) * across + v % across); };
      mesh.indices.insert(mesh.indices.end(), {at(i, j), at(i, j + 1), at(i + 1, j), at(i + 1, j),
                                               at(i, j + 1), at(i + 1, j + 1)});
    }
  }
  return mesh;
}

// ------------------------------------------------------------------------------------------------------ closed forms

TEST(Mass, BoxAndSphere) {
  expect_mass(must_measure(Box{{0.5f, 1.0f, 1.5f}}), 6000, {}, {6500, 5000, 2500});
  const double m = 1000 * 4.0 / 3.0 * kPiDouble * 0.027;
  const float i = float(0.4 * m * 0.09);
  expect_mass(must_measure(Sphere{0.3f}), m, {}, {i, i, i});
  const MassProperties shell = hollow_sphere_mass(0.3f, 10.0f);
  const double shell_mass = 10 * 4 * kPiDouble * 0.09;
  const float s = float(2.0 / 3.0 * shell_mass * 0.09);
  expect_mass(shell, shell_mass, {}, {s, s, s});
}

TEST(Mass, CapsuleCylinderConeEllipsoid) {
  expect_mass(must_measure(Capsule{0.25f, 0.5f}), 261.7994, {}, {43.565054f, 7.772169f, 43.565054f});
  expect_mass(must_measure(Cylinder{0.5f, 1.0f}), 1570.7963, {}, {621.77355f, 196.34954f, 621.77355f});
  expect_mass(must_measure(Cone{0.5f, 0.75f}), 392.6991, {0, -0.75f + 0.375f, 0},
              {47.860201f, 29.452431f, 47.860201f});
  expect_mass(ellipsoid_mass({0.5f, 0.3f, 0.2f}, 1000.0f), 125.66371, {}, {3.267256f, 7.288495f, 8.545132f});
  // Without its tube a capsule is a ball.
  expect_same(must_measure(Capsule{0.3f, 0.0f}), must_measure(Sphere{0.3f}), 1e-6);
}

TEST(Mass, RoundedBoxIsTheSumOfItsParts) {
  expect_same(must_measure(Box{{0.5f, 0.5f, 0.5f}, 0.5f}), must_measure(Sphere{0.5f}), 2e-6);
  // Two equal half extents that are all rounding: a capsule.
  expect_same(must_measure(Box{{0.25f, 0.75f, 0.25f}, 0.25f}), must_measure(Capsule{0.25f, 0.5f}), 2e-6);
  expect_same(must_measure(Box{{0.5f, 1.0f, 1.5f}, 1.0e-4f}), must_measure(Box{{0.5f, 1.0f, 1.5f}}), 1e-6);
  // By midpoints of small cubes.
  const Box box{{0.5f, 0.4f, 0.3f}, 0.2f};
  const double h = 0.004;
  double mass = 0, xx = 0, yy = 0, zz = 0;
  for (double x = h / 2; x < 0.5; x += h) {
    for (double y = h / 2; y < 0.4; y += h) {
      for (double z = h / 2; z < 0.3; z += h) {
        const double dx = std::max(x - 0.3, 0.0), dy = std::max(y - 0.2, 0.0), dz = std::max(z - 0.1, 0.0);
        if (dx * dx + dy * dy + dz * dz > 0.04) continue;
        const double part = 8 * 1000 * h * h * h;
        mass += part;
        xx += part * x * x;
        yy += part * y * y;
        zz += part * z * z;
      }
    }
  }
  expect_mass(must_measure(box), mass, {}, {float(yy + zz), float(xx + zz), float(xx + yy)}, 1e-3);
}

TEST(Mass, Tetrahedra) {
  const MassProperties corner = tetrahedron_mass({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, 1.0f);
  expect_relative(double(corner.mass), 1.0 / 6.0);
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(double(corner.center[axis]), 0.25, 2.5e-7);
  expect_relative(double(corner.inertia.xx), 1.0 / 80.0);
  expect_relative(double(corner.inertia.yy), 1.0 / 80.0);
  expect_relative(double(corner.inertia.zz), 1.0 / 80.0);
  // The integral of x y about the centre is -1/480, so the product of inertia is +1/480.
  expect_relative(double(corner.inertia.xy), 1.0 / 480.0);
  expect_relative(double(corner.inertia.xz), 1.0 / 480.0);
  expect_relative(double(corner.inertia.yz), 1.0 / 480.0);
  // The same as hull and as mesh, and wound the other way.
  const Points points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const Result<Geometry> hull = cook_hull(points);
  ASSERT_TRUE(hull);
  expect_same(must_measure(*hull, 1.0f), corner, 1e-6);
  expect_same(must_measure(TestMesh{points, {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3}}, 1.0f), corner, 1e-6);
  expect_same(tetrahedron_mass({1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {0, 0, 1}, 1.0f), corner, 1e-7);
  // Regular, edge a: m a^2 / 20 about every axis.
  const MassProperties regular = tetrahedron_mass({1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}, 3.0f);
  const float i = float(double(regular.mass) * 8.0 / 20.0);
  expect_mass(regular, 8.0, {}, {i, i, i});
}

TEST(Mass, FarTetrahedronKeepsItsDigits) {
  const Vec3 far{1024, -2048, 512};
  const MassProperties near = tetrahedron_mass({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, 1.0f);
  const MassProperties moved =
      tetrahedron_mass(far, far + Vec3{1, 0, 0}, far + Vec3{0, 1, 0}, far + Vec3{0, 0, 1}, 1.0f);
  EXPECT_EQ(moved.inertia, near.inertia);
  EXPECT_EQ(moved.mass, near.mass);
}

// ---------------------------------------------------------------------------------------------------- hulls and meshes

TEST(Mass, HullOfACylinder) {
  Points points;
  for (int i = 0; i < 32; ++i) {
    const double a = 2 * kPiDouble * i / 32;
    for (const float y : {-1.0f, 1.0f})
      points.push_back({float(0.5 * std::cos(a)), y, float(0.5 * std::sin(a))});
  }
  const Result<Geometry> hull = cook_hull(points);
  ASSERT_TRUE(hull) << hull.error().message;
  const MassProperties mass = must_measure(*hull);
  EXPECT_NEAR(double(mass.mass), 1560.72, 0.01);
  EXPECT_NEAR(double(mass.inertia.yy), 193.84, 0.01);
}

TEST(Mass, TurnedAndMovedBoxHull) {
  const Transform t{{3, -2, 5}, normalized(Quat{0.3f, -0.2f, 0.5f, 0.8f})};
  TestMesh mesh = box_mesh({0.5f, 1.0f, 1.5f});
  move(mesh, t);
  const MassProperties wanted = transformed(must_measure(Box{{0.5f, 1.0f, 1.5f}}), t);
  const Result<Geometry> hull = cook_hull(mesh.vertices);
  ASSERT_TRUE(hull);
  expect_same(must_measure(*hull), wanted, 1e-6);
  expect_same(must_measure(mesh), wanted, 1e-6);
  const Result<Geometry> cooked = cook_mesh({mesh.vertices, mesh.indices});
  ASSERT_TRUE(cooked);
  expect_same(must_measure(*cooked), wanted, 1e-6);
}

TEST(Mass, TorusMeshConvergesWithTheSquareOfItsSteps) {
  const double m = 1233.70055, axial = 1291.53026, across = 665.04170;
  double last[3] = {};
  for (int n = 16; n <= 128; n *= 2) {
    const MassProperties mass = must_measure(torus_mesh(2 * n, n, 1.0f, 0.25f));
    const double error[3] = {m - double(mass.mass), axial - double(mass.inertia.yy),
                             across - double(mass.inertia.xx)};
    for (int k = 0; k < 3; ++k) {
      EXPECT_GT(error[k], 0.0);
      if (n > 16) {
        EXPECT_NEAR(last[k] / error[k], 4.0, 0.1) << "steps " << n;
      }
      last[k] = error[k];
    }
    EXPECT_NEAR(double(length(mass.center)), 0.0, 1e-5);
  }
}

TEST(Mass, HollowCubeWithInnerFacesInverted) {
  TestMesh mesh = box_mesh({1, 1, 1});
  append(mesh, box_mesh({0.5f, 0.5f, 0.5f}), true);
  expect_mass(must_measure(mesh, 1.0f), 7.0, {}, {5.1666667f, 5.1666667f, 5.1666667f});
}

TEST(Mass, MeshesFarFromTheOriginKeepTheirDigits) {
  TestMesh mesh = torus_mesh(32, 16, 1.0f, 0.25f);
  const MassProperties near = must_measure(mesh);
  // Steps of 2^-7, so that moving is exact.
  for (Vec3& v : mesh.vertices) {
    v = {std::round(v.x * 128) / 128, std::round(v.y * 128) / 128, std::round(v.z * 128) / 128};
  }
  const MassProperties rounded = must_measure(mesh);
  expect_same(rounded, near, 0.1);
  move(mesh, {{4096, 8192, -4096}, {}});
  const MassProperties far = must_measure(mesh);
  expect_relative(double(far.mass), double(rounded.mass));
  expect_relative(double(far.inertia.xx), double(rounded.inertia.xx));
  expect_relative(double(far.inertia.yy), double(rounded.inertia.yy));
}

TEST(Mass, TouchingAndApartPartsAreFine) {
  TestMesh mesh = box_mesh({0.5f, 0.5f, 0.5f});
  append(mesh, box_mesh({0.5f, 0.5f, 0.5f}, {1, 0, 0}));  // a common face
  append(mesh, box_mesh({0.5f, 0.5f, 0.5f}, {4, 0, 0}));
  const MassProperties mass = must_measure(mesh, 1.0f);
  expect_relative(double(mass.mass), 3.0);
  EXPECT_NEAR(double(mass.center.x), 5.0 / 3.0, 1e-6);
}

TEST(Mass, SplitVerticesAreWelded) {
  // As files for renderers have it: three vertices of its own for each triangle.
  const TestMesh box = box_mesh({0.5f, 1.0f, 1.5f});
  TestMesh split;
  for (const std::uint32_t i : box.indices) {
    split.indices.push_back(std::uint32_t(split.vertices.size()));
    split.vertices.push_back(box.vertices[i]);
  }
  expect_mass(must_measure(split), 6000, {}, {6500, 5000, 2500});
}

// ------------------------------------------------------------------------------------------------------- bad meshes

TEST(Mass, OpenMeshesAreRefusedWithTheEdge) {
  TestMesh mesh = box_mesh({1, 1, 1});
  mesh.indices.erase(mesh.indices.begin(), mesh.indices.begin() + 3);
  // The triangle 0, 4, 6 is gone; the lowest one left with a free edge is 0, 6, 2.
  EXPECT_TRUE(contains(refusal(mesh), "edge from vertex 0 to 6 of triangle 0 is open"));
  const Result<Geometry> cooked = cook_mesh({mesh.vertices, mesh.indices});
  ASSERT_TRUE(cooked);
  const Result<MassProperties> mass = mass_properties(*cooked, 1000.0f);
  ASSERT_FALSE(mass);
  EXPECT_TRUE(contains(mass.error().message, "is open")) << mass.error().message;
}

TEST(Mass, InconsistentWindingIsRefusedWithTheEdge) {
  TestMesh mesh = box_mesh({1, 1, 1});
  // Triangle 4 is turned; the lowest of its neighbours is 3.
  std::swap(mesh.indices[13], mesh.indices[14]);
  EXPECT_TRUE(contains(refusal(mesh),
                       "edge from vertex 5 to 1 of triangle 3 is run the same way by another triangle"));
}

TEST(Mass, InsideOutAndFlatAreRefused) {
  TestMesh inverted;
  append(inverted, box_mesh({1, 1, 1}), true);
  EXPECT_TRUE(contains(refusal(inverted), "inside out (volume -8 m^3"));
  EXPECT_TRUE(contains(refusal(box_mesh({1, 0, 1})), "enclose")) << refusal(box_mesh({1, 0, 1}));
  const TestMesh sheet{{{0, 0, 0}, {1, 0, 0.3f}, {0, 1, 0.7f}}, {0, 1, 2, 0, 2, 1}};
  EXPECT_TRUE(contains(refusal(sheet), "enclose 0 m^3"));
}

TEST(Mass, OverlappingPartsAreRefused) {
  // Edges through faces.
  TestMesh mesh = box_mesh({1, 1, 1});
  append(mesh, box_mesh({0.5f, 0.5f, 0.5f}, {1, 1.1f, 0.9f}));
  EXPECT_TRUE(contains(refusal(mesh), "cross each other"));
  // Side faces in common planes: no edge passes a face.
  mesh = box_mesh({0.5f, 0.5f, 0.5f});
  append(mesh, box_mesh({0.5f, 0.5f, 0.5f}, {0.5f, 0, 0}));
  EXPECT_TRUE(contains(refusal(mesh), "behind and")) << refusal(mesh);
  // One inside the other, not as a hole.
  mesh = box_mesh({1, 1, 1});
  append(mesh, box_mesh({0.5f, 0.5f, 0.5f}));
  EXPECT_TRUE(contains(refusal(mesh), "2 times behind and 1 times before")) << refusal(mesh);
  // A smaller part beside, wound inwards.
  mesh = box_mesh({1, 1, 1});
  append(mesh, box_mesh({0.5f, 0.5f, 0.5f}, {3, 0, 0}), true);
  EXPECT_TRUE(contains(refusal(mesh), "0 times behind and -1") || contains(refusal(mesh), "-1 times"))
      << refusal(mesh);
  // A tube that passes through itself: a figure of eight.
  mesh = torus_mesh(64, 16, 1.0f, 0.25f);
  for (Vec3& v : mesh.vertices) {
    const float r = std::sqrt(v.x * v.x + v.z * v.z);
    v = {v.x * (r - 1.0f + v.z / r * v.z / r * 2.0f), v.y, v.x / r * v.z * 2.0f};
  }
  const Result<MassProperties> eight = mesh_mass(mesh.vertices, mesh.indices, 1.0f);
  EXPECT_FALSE(eight);
}

TEST(Mass, BadDataIsRefused) {
  const float nan = std::nanf("");
  TestMesh mesh = box_mesh({1, 1, 1});
  mesh.indices[7] = 8;
  EXPECT_TRUE(contains(refusal(mesh), "triangle 2 uses vertex 8"));
  mesh = box_mesh({1, 1, 1});
  mesh.vertices[5].y = nan;
  EXPECT_TRUE(contains(refusal(mesh), "vertex 5 is"));
  EXPECT_TRUE(contains(refusal({}), "0 indices"));
  mesh = box_mesh({1, 1, 1});
  mesh.indices.pop_back();
  EXPECT_TRUE(contains(refusal(mesh), "35 indices"));
  for (const float density : {0.0f, -1.0f, nan, INFINITY}) {
    const Result<MassProperties> mass = mass_properties(Sphere{1.0f}, density);
    ASSERT_FALSE(mass);
    EXPECT_EQ(mass.error().code, ErrorCode::invalid_argument);
    EXPECT_TRUE(contains(mass.error().message, "density is"));
  }
  EXPECT_FALSE(mass_properties(Sphere{0.0f}, 1.0f));
  EXPECT_FALSE(mass_properties(Sphere{1.0e9f}, 1.0e30f));  // more than a float holds
  EXPECT_FALSE(mass_properties(Sphere{1.0e-9f}, 1.0f));    // less
  EXPECT_FALSE(mass_properties(Plane{}, 1.0f));
  EXPECT_FALSE(mass_properties(Geometry{}, 1.0f));
  const std::vector<float> heights(9, 0.0f);
  const Result<Geometry> field = cook_height_field({heights, 3, 3, 1.0f});
  ASSERT_TRUE(field);
  EXPECT_FALSE(mass_properties(*field, 1.0f));
}

// ------------------------------------------------------------------------------------------------------------ voxels

TEST(Mass, VoxelsAgreeWithTheIntegrals) {
  const TestMesh torus = torus_mesh(64, 32, 1.0f, 0.25f);
  TestMesh hollow = box_mesh({1, 0.8f, 0.6f}, {3, 4, 5});
  append(hollow, box_mesh({0.5f, 0.4f, 0.3f}, {3.2f, 4, 5}), true);
  move(hollow, {{}, normalized(Quat{0.2f, 0.1f, 0.4f, 1.0f})});
  for (const TestMesh& mesh : {torus, hollow}) {
    const Result<MassProperties> voxels = voxel_mass(mesh.vertices, mesh.indices, 1000.0f, 96);
    ASSERT_TRUE(voxels);
    expect_same(*voxels, must_measure(mesh), 0.01);
  }
}

TEST(Mass, VoxelsBearHoles) {
  TestMesh torus = torus_mesh(64, 32, 1.0f, 0.25f);
  const MassProperties whole = must_measure(torus);
  // A few triangles less, here and there.
  for (const std::size_t at : {600u, 3000u, 9000u}) {
    torus.indices.erase(torus.indices.begin() + std::ptrdiff_t(at),
                        torus.indices.begin() + std::ptrdiff_t(at + 6));
  }
  EXPECT_TRUE(contains(refusal(torus), "is open"));
  const Result<MassProperties> voxels = voxel_mass(torus.vertices, torus.indices, 1000.0f, 96);
  ASSERT_TRUE(voxels);
  expect_same(*voxels, whole, 0.02);
}

TEST(Mass, VoxelsOfAlignedBoxesAndNothing) {
  const TestMesh box = box_mesh({0.5f, 1.0f, 1.5f}, {10, 20, 30});
  const Result<MassProperties> mass = voxel_mass(box.vertices, box.indices, 1000.0f, 60);
  ASSERT_TRUE(mass);
  expect_mass(*mass, 6000, {10, 20, 30}, {6500, 5000, 2500}, 1e-4);
  const TestMesh flat = box_mesh({1, 0, 1});
  EXPECT_FALSE(voxel_mass(flat.vertices, flat.indices, 1000.0f));
  EXPECT_FALSE(voxel_mass(box.vertices, box.indices, 1000.0f, 1));
  EXPECT_FALSE(voxel_mass(box.vertices, box.indices, 1000.0f, 100000));
  EXPECT_FALSE(voxel_mass({}, {}, 1000.0f));
}

// ----------------------------------------------------------------------------------------------------------- algebra

TEST(Mass, HalfWoodHalfLead) {
  const auto half = [](float density, float x) {
    return transformed(must_measure(Box{{0.5f, 0.5f, 0.5f}}, density), {{x, 0, 0}, {}});
  };
  const MassProperties parts[] = {half(600.0f, -0.5f), half(11340.0f, 0.5f)};
  const MassProperties mass = combined(parts);
  expect_mass(mass, 11940.0, {0.4497487f, 0, 0}, {1990.0f, 2559.84925f, 2559.84925f});
}

TEST(Mass, FarPartsDoNotCancel) {
  // Eight balls on the corners of a 2 m cube at (100, 100, 100).
  const MassProperties ball = must_measure(Sphere{0.5f});
  std::vector<MassProperties> near, far;
  for (int i = 0; i < 8; ++i) {
    const Vec3 p{(i & 1) ? 1.0f : -1.0f, (i & 2) ? 1.0f : -1.0f, (i & 4) ? 1.0f : -1.0f};
    near.push_back(transformed(ball, {p, {}}));
    far.push_back(transformed(ball, {p + Vec3{100, 100, 100}, {}}));
  }
  const double m = double(ball.mass);
  const float i = float(8 * (0.4 * m * 0.25 + 2 * m));
  expect_mass(combined(near), 8 * m, {}, {i, i, i});
  expect_mass(combined(far), 8 * m, {100, 100, 100}, {i, i, i}, 1e-5);
}

TEST(Mass, CombiningEqualsMeasuringTheWhole) {
  // A box cut in three slices, each turned about its own axis of symmetry.
  std::vector<MassProperties> slices;
  for (int i = 0; i < 3; ++i) {
    slices.push_back(transformed(must_measure(Box{{0.5f, 0.5f, 1.0f}}),
                                 {{float(i) - 1.0f, 0, 0}, {0, 0, std::sqrt(0.5f), std::sqrt(0.5f)}}));
  }
  expect_same(combined(slices), must_measure(Box{{1.5f, 0.5f, 1.0f}}), 1e-6);
  EXPECT_EQ(combined({}).mass, 0.0f);
}

TEST(Mass, PrincipalAxesUndoATurn) {
  std::mt19937 engine(7);
  const auto number = [&] { return float(engine() >> 8) / 8388608.0f - 1.0f; };
  for (int round = 0; round < 100; ++round) {
    const Quat q = normalized(Quat{number(), number(), number(), number()});
    MassProperties mass;
    mass.mass = 1.0f;
    mass.inertia = {2.0f, 3.0f, 4.0f, 0, 0, 0};
    const Sym3 turned = transformed(mass, {{}, q}).inertia;
    const PrincipalAxes axes = principal_axes(turned);
    EXPECT_NEAR(axes.moments.x, 2.0f, 2e-6f);
    EXPECT_NEAR(axes.moments.y, 3.0f, 2e-6f);
    EXPECT_NEAR(axes.moments.z, 4.0f, 2e-6f);
    const Mat3 r = to_matrix(axes.orientation);
    const Mat3 back = r * diagonal(axes.moments) * transpose(r);
    const Mat3 wanted = to_matrix(turned);
    for (const Vec3& difference : {back.x - wanted.x, back.y - wanted.y, back.z - wanted.z}) {
      EXPECT_LT(largest(absolute(difference)), 4e-6f);
    }
  }
}

TEST(Mass, InertiaThatNoBodyHasIsRefusedWithItsAxis) {
  EXPECT_EQ(check_inertia({1, 1, 1, 0, 0, 0}).code, ErrorCode::none);
  EXPECT_EQ(check_inertia({1, 2, 3, 0, 0, 0}).code, ErrorCode::none);        // a flat plate, just possible
  EXPECT_EQ(check_inertia({1, 2, 3.0002f, 0, 0, 0}).code, ErrorCode::none);  // within rounding
  EXPECT_TRUE(contains(check_inertia({1, 2, 3.01f, 0, 0, 0}).message, "axis z"));
  EXPECT_TRUE(contains(check_inertia({5, 2, 2, 0, 0, 0}).message, "axis x"));
  EXPECT_TRUE(contains(check_inertia({1, 9, 2, 0, 0, 0}).message, "axis y"));
  EXPECT_TRUE(contains(check_inertia({1, 9, 2, 0, 0, 0}).message, "1 + 2"));
  EXPECT_TRUE(contains(check_inertia({1, 1, -1, 0, 0, 0}).message, "zz is -1"));
  EXPECT_TRUE(contains(check_inertia({0, 1, 1, 0, 0, 0}).message, "xx is 0"));
  EXPECT_TRUE(contains(check_inertia({1, 1, 1, 0, std::nanf(""), 0}).message, "xz is"));
  EXPECT_TRUE(contains(check_inertia({1, 1, 1, 2, 0, 0}).message, "is -1 kg m^2"));  // not positive definite
  // Turned: the moments count, not the diagonal.
  MassProperties mass;
  mass.inertia = {1, 1, 3, 0, 0, 0};
  const Quat q = normalized(Quat{1, 0, 0, 1});  // z to -y
  EXPECT_TRUE(contains(check_inertia(transformed(mass, {{}, q}).inertia).message, "axis y"));
  EXPECT_EQ(check_inertia(must_measure(Box{{1, 1e-3f, 2}}).inertia).code, ErrorCode::none);
}

}  // namespace
}  // namespace gyre::mass_test
