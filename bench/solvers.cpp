// The solvers of contacts and joints on twelve scenes, for docs/numerics.md: prints a line of numbers for each scene and way.
//
//   solvers [--seconds S] [SCENE...]
//
// Columns: scene, way, sub-steps, milliseconds of processor time a step (median), deepest overlap (m), widest joint (m), farthest that anything
// moved from where it was built (m), largest residual (N s), rows of the largest island, joints and contacts as the run ended.
// Overlap, joints and residual are the worst of the second half of the run. tools/make_solver_comparison.py draws them.
#include <gyre/gyre.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <string>
#include <vector>

namespace gyre {
namespace {

constexpr float kStep = 1.0f / 60.0f;

struct Link {
  BodyId a, b;
  Vec3 local_a, local_b;
};

// A world that is being built, and what is measured in it.
struct Stage {
  World world;
  std::vector<BodyId> bodies;
  std::vector<DVec3> built;
  std::vector<Link> links;

  BodyId add(const AnyShape& shape, DVec3 place, float density = 1000.0f, float friction = 0.6f,
             Quat turn = {}) {
    BodyDef def;
    def.pose = {place, turn};
    const Material material{.static_friction = friction, .dynamic_friction = friction};
    bodies.push_back(world.add_body(def, {.geometry = shape, .density = density, .material = material}));
    built.push_back(place);
    return bodies.back();
  }
  void add_ground(float friction = 0.6f) {
    const Material material{.static_friction = friction, .dynamic_friction = friction};
    world.add_body({.type = BodyType::fixed}, {.geometry = Plane{}, .material = material});
  }
  void link(BodyId a, BodyId b, DVec3 anchor) {
    world.add_joint(BallDef{.a = a, .b = b, .anchor = anchor});
    const auto local = [&](BodyId body) {
      if (!body) return to_float(anchor);
      const Pose pose = world.pose(body);
      return rotate(conjugate(pose.orientation), to_float(anchor - pose.position));
    };
    links.push_back({a, b, local(a), local(b)});
  }
  double widest() const {
    double most = 0.0;
    for (const Link& link : links) {
      const auto at = [&](BodyId body, Vec3 local) { return body ? world.pose(body) * local : DVec3(local); };
      most = std::max(most, length(at(link.a, link.local_a) - at(link.b, link.local_b)));
    }
    return most;
  }
  double farthest() const {
    double most = 0.0;
    for (std::size_t i = 0; i < bodies.size(); ++i)
      most = std::max(most, length(world.pose(bodies[i]).position - built[i]));
    return most;
  }
};

void build_cube(Stage& s) {
  s.add_ground();
  s.add(Box{{0.5f, 0.5f, 0.5f}}, {0, 0.5, 0});
}
void build_stack(Stage& s) {
  s.add_ground();
  for (int i = 0; i < 10; ++i) s.add(Box{{0.5f, 0.5f, 0.5f}}, {0, 0.5 + i, 0});
}
void build_heavy_stack(Stage& s) {
  s.add_ground();
  for (int i = 0; i < 5; ++i) s.add(Box{{0.5f, 0.5f, 0.5f}}, {0, 0.5 + i, 0}, i == 4 ? 1.0e6f : 1.0e3f);
}
void build_wall_of(Stage& s, int rows, int columns) {
  s.add_ground();
  for (int row = 0; row < rows; ++row)
    for (int i = 0; i < columns; ++i)
      s.add(Box{{0.5f, 0.25f, 0.25f}}, {1.0 * i + (row % 2) * 0.5, 0.25 + 0.5 * row, 0});
}
void build_wall(Stage& s) { build_wall_of(s, 5, 4); }
void build_large_wall(Stage& s) { build_wall_of(s, 8, 6); }
void build_huge_wall(Stage& s) { build_wall_of(s, 16, 12); }
void build_pyramid_of(Stage& s, int rows) {
  s.add_ground();
  for (int row = 0; row < rows; ++row)
    for (int i = 0; i < rows - row; ++i) s.add(Box{{0.5f, 0.5f, 0.5f}}, {1.1 * i + 0.55 * row, 0.5 + row, 0});
}
void build_pyramid(Stage& s) { build_pyramid_of(s, 5); }
void build_large_pyramid(Stage& s) { build_pyramid_of(s, 9); }
void build_huge_pyramid(Stage& s) { build_pyramid_of(s, 20); }
void build_arch(Stage& s) {
  s.add_ground(0.7f);
  const int stones = 13;
  const double radius = 3.0, half = 0.225;
  for (int i = 0; i < stones; ++i) {
    const double begin = double(kPi) * i / stones, end = double(kPi) * (i + 1) / stones,
                 middle = 0.5 * (begin + end);
    const DVec3 center{radius * std::cos(middle), radius * std::sin(middle), 0};
    std::vector<Vec3> corners;
    for (const double r : {radius - half, radius + half})
      for (const double angle : {begin, end})
        for (const double z : {-0.4, 0.4})
          corners.push_back(to_float(DVec3{r * std::cos(angle), r * std::sin(angle), z} - center));
    s.add(*cook_hull(corners), center, 2400, 0.7f);
  }
}
void build_incline(Stage& s) {
  const Quat tilt = from_axis_angle({0, 0, 1}, 0.4f);  // tan 0.4 rad = 0.42
  BodyDef ground;
  ground.type = BodyType::fixed;
  ground.pose.orientation = tilt;
  s.world.add_body(ground, {.geometry = Box{{20, 1, 20}},
                            .material = {.static_friction = 0.6f, .dynamic_friction = 0.6f}});
  for (int i = 0; i < 5; ++i)
    s.add(Box{{0.5f, 0.25f, 0.5f}}, DVec3(rotate(tilt, {0, 1.25f + 0.5f * float(i), 0})), 1000, 0.6f, tilt);
}
void build_pile_of(Stage& s, int count) {
  s.add_ground();
  for (int i = 0; i < count; ++i) {
    const DVec3 place{0.7 * (i % 4) + 0.05 * (i % 3), 0.6 + 0.8 * (i / 16),
                      0.7 * (i / 4 % 4) + 0.03 * (i % 5)};
    if (i % 2 == 0) s.add(Sphere{0.3f}, place);
    if (i % 2 == 1) s.add(Box{{0.3f, 0.25f, 0.3f}}, place);
  }
}
void build_pile(Stage& s) { build_pile_of(s, 40); }
void build_large_pile(Stage& s) { build_pile_of(s, 100); }
void build_huge_pile(Stage& s) { build_pile_of(s, 320); }
void build_domino(Stage& s) {
  s.add_ground();
  for (int i = 0; i < 10; ++i) s.add(Box{{0.05f, 0.5f, 0.25f}}, {0.4 * i, 0.5, 0});
  s.world.set_velocity(s.bodies[0], {}, {0, 0, -2});
}
void build_chain(Stage& s) {
  BodyId last{};
  for (int i = 0; i < 20; ++i) {
    const bool is_load = i == 19;
    const BodyId body = s.add(Capsule{0.05f, 0.2f}, {0, -0.25 - 0.5 * i, 0}, is_load ? 1.0e6f : 1.0e3f);
    s.link(last, body, {0, -0.5 * i, 0});
    last = body;
  }
}
void build_swing(Stage& s) {
  BodyId last{};
  for (int i = 0; i < 10; ++i) {
    const BodyId body = s.add(Box{{0.2f, 0.05f, 0.05f}}, {0.25 + 0.5 * i, 0, 0});
    s.link(last, body, {0.5 * i, 0, 0});
    last = body;
  }
}
void build_bridge(Stage& s) {
  BodyId last{};
  for (int i = 0; i < 16; ++i) {
    const BodyId body = s.add(Box{{0.24f, 0.05f, 0.5f}}, {0.25 + 0.5 * i, 0, 0});
    for (const double z : {-0.4, 0.4}) s.link(last, body, {0.5 * i, 0, z});
    last = body;
  }
  for (const double z : {-0.4, 0.4}) s.link(last, {}, {8.0, 0, z});
  for (int i = 0; i < 4; ++i) s.add(Box{{0.3f, 0.3f, 0.3f}}, {2.0 + 1.2 * i, 0.4, 0}, 2000);
}

struct NamedScene {
  const char* name;
  void (*build)(Stage&);
};
constexpr NamedScene kAllScenes[] = {
    {"cube", build_cube},       {"stack", build_stack},     {"heavy_stack", build_heavy_stack},
    {"wall", build_wall},       {"pyramid", build_pyramid}, {"arch", build_arch},
    {"incline", build_incline}, {"pile", build_pile},       {"dominoes", build_domino},
    {"chain", build_chain},     {"swing", build_swing},     {"bridge", build_bridge},
};
// Measured where asked for by name: islands of one to several thousand rows.
constexpr NamedScene kLargeScenes[] = {
    {"large_wall", build_large_wall},     {"large_pyramid", build_large_pyramid},
    {"large_pile", build_large_pile},     {"huge_wall", build_huge_wall},
    {"huge_pyramid", build_huge_pyramid}, {"huge_pile", build_huge_pile},
};

struct Way {
  const char* name;
  SolverKind kind;
  SolverOptions options{};
  int substeps = 4;
};
constexpr Way kWays[] = {
    {"soft_step", SolverKind::soft_step},
    {"sequential_10", SolverKind::sequential_impulses},
    {"sequential_50", SolverKind::sequential_impulses, {.iterations = 50}},
    {"lcp_automatic", SolverKind::lcp},
    {"lcp_dantzig",
     SolverKind::lcp,
     {.lcp_method = LcpMethod::dantzig, .friction_sides = 4, .direct_rows = 130}},
    {"lcp_lemke", SolverKind::lcp, {.lcp_method = LcpMethod::lemke, .friction_sides = 4, .direct_rows = 100}},
    {"lcp_nncg", SolverKind::lcp, {.lcp_method = LcpMethod::nncg}},
};

void measure(const NamedScene& scene, const Way& way, double seconds) {
  WorldDef def;
  def.sleeping = false;
  def.stepping.substeps = way.substeps;
  def.stepping.solver = way.kind;
  def.stepping.solver_options = way.options;
  Result<World> made = World::create(def);
  if (!made) {
    std::fprintf(stderr, "%s\n", made.error().message);
    std::exit(1);
  }
  Stage stage{*std::move(made), {}, {}, {}};
  scene.build(stage);
  const int steps = int(std::lround(seconds / double(kStep)));
  std::vector<double> times;
  double overlap = 0.0, widest = 0.0, residual = 0.0;
  int rows = 0, direct = 0, islands = 0;
  for (int i = 0; i < steps; ++i) {
    const std::clock_t begin = std::clock();
    stage.world.step(kStep);
    times.push_back(1000.0 * double(std::clock() - begin) / double(CLOCKS_PER_SEC));
    const SolverStats reading = stage.world.solver_stats();
    rows = std::max(rows, reading.largest_rows);
    if (2 * i < steps) continue;
    direct += reading.direct_islands, islands += reading.islands;
    overlap = std::max(overlap, double(stage.world.max_penetration()));
    widest = std::max(widest, stage.widest());
    residual = std::max(residual, reading.residual);
  }
  std::sort(times.begin(), times.end());
  std::printf("%s,%s,%d,%.4f,%.3e,%.3e,%.3e,%.3e,%d,%.2f\n", scene.name, way.name, way.substeps,
              times[times.size() / 2], overlap, widest, stage.farthest(), residual, rows,
              islands > 0 ? double(direct) / islands : 0.0);
  std::fflush(stdout);
}

}  // namespace
}  // namespace gyre

int main(int count, char** words) {
  double seconds = 3.0;
  std::vector<std::string> wanted, ways;
  for (int i = 1; i < count; ++i) {
    if (std::strcmp(words[i], "--seconds") == 0 && i + 1 < count) {
      seconds = std::atof(words[++i]);
    } else if (std::strcmp(words[i], "--way") == 0 && i + 1 < count) {
      ways.push_back(words[++i]);
    } else {
      wanted.push_back(words[i]);
    }
  }
  std::printf("scene,way,substeps,step_ms,overlap,widest,farthest,residual,rows,direct\n");
  const auto is_wanted = [](const std::vector<std::string>& names, const char* name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  const auto measure = [&](const gyre::NamedScene& scene) {
    for (const gyre::Way& way : gyre::kWays) {
      if (ways.empty() || is_wanted(ways, way.name)) gyre::measure(scene, way, seconds);
    }
  };
  for (const gyre::NamedScene& scene : gyre::kAllScenes) {
    if (wanted.empty() || is_wanted(wanted, scene.name)) measure(scene);
  }
  for (const gyre::NamedScene& scene : gyre::kLargeScenes) {
    if (is_wanted(wanted, scene.name)) measure(scene);
  }
  return 0;
}
