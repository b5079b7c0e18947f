// The public function: settings, mesh to model, cutting, joining, cooking. See gyre/decomposition.h.
#include "geometry/decomposition/decomposition.h"

#include "base/float_mode.h"
#include "base/hash.h"
#include "geometry/shape/cooked.h"

#include <cstring>
#include <memory>

namespace gyre {
namespace {

// Part of the key. It must be incremented whenever the hulls of any mesh change.
constexpr std::uint64_t kMethodVersion = 2;
// A surface is a sheet if more than this fraction of it is close to holes.
constexpr double kMaxOpen = 0.15;

Error check_settings(const DecompositionDef& def) {
  if (!(def.concavity >= 0.001f && def.concavity <= 1.0f)) {
    return make_error(ErrorCode::invalid_argument,
                      "concavity is %g; allowed are 0.001 to 1 (times the size of the mesh)",
                      double(def.concavity));
  }
  if (def.max_hulls < 1 || def.max_hulls > 1024)
    return make_error(ErrorCode::invalid_argument, "max_hulls is %d; allowed are 1 to 1024", def.max_hulls);
  if (def.max_hull_vertices < 8 || def.max_hull_vertices > 255) {
    return make_error(ErrorCode::invalid_argument, "max_hull_vertices is %d; allowed are 8 to 255",
                      def.max_hull_vertices);
  }
  if (int(def.meaning) >= kSurfaceMeaningCount) {
    return make_error(ErrorCode::invalid_argument, "meaning is %d; allowed are automatic, solid and shell",
                      int(def.meaning));
  }
  if (!(def.shell_thickness >= 0.0f && is_finite(def.shell_thickness))) {
    return make_error(ErrorCode::invalid_argument,
                      "shell_thickness is %g m; allowed are 0 (automatic) and above",
                      double(def.shell_thickness));
  }
  if (def.threads < 0)
    return make_error(ErrorCode::invalid_argument, "threads is %d; allowed are 0 (all cores) and above",
                      def.threads);
  return {};
}

Error cancelled() {
  return make_error(ErrorCode::cancelled, "decomposition: stopped by its progress callback");
}

// The model with its field and samples: the original, or a shell around it.
struct Prepared {
  Model model;
  std::unique_ptr<SurfaceField> field;
  SampledSolid solid;
};

void prepare(const DecompositionDef& def, TaskSystem& tasks, Prepared& out) {
  const Model& model = out.model;
  out.field = std::make_unique<SurfaceField>(model.vertices, model.indices);
  out.solid.model = &model;
  out.solid.field = out.field.get();
  out.solid.tolerance = double(def.concavity) * model.size;
  constexpr double kMinSamples = 4000.0, kMaxSamples = 60000.0;  // on the whole surface
  out.solid.spacing = min(max(0.4 * out.solid.tolerance, std::sqrt(model.area / kMaxSamples)),
                          std::sqrt(model.area / kMinSamples));
  sample_surface(tasks, out.solid);
}

// Half the thickness of the shell, in the model's coordinates.
double half_thickness(const DecompositionDef& def, const Model& model) {
  if (def.shell_thickness > 0.0f) return 0.5 * double(def.shell_thickness) * model.scale;
  return 0.25 * double(def.concavity) * model.size;
}

Error prepare_solid(const DecompositionDef& def, TaskSystem& tasks, Prepared& out) {
  prepare(def, tasks, out);
  MeshFindings& findings = out.model.findings;
  findings.openness = float(out.solid.openness);
  const bool sheet = def.meaning == SurfaceMeaning::shell ||
                     (def.meaning == SurfaceMeaning::automatic && out.solid.openness > kMaxOpen);
  if (!sheet) {
    if (!out.solid.samples.empty()) return {};
    return make_error(
        ErrorCode::invalid_geometry,
        "decomposition: the triangles enclose no volume; allowed are surfaces that do, or meaning = shell");
  }
  const double half = half_thickness(def, out.model);
  if (half > 0.25 * out.model.size) {
    return make_error(ErrorCode::invalid_argument,
                      "shell_thickness is %g m; allowed is up to half the size of the mesh, %g m",
                      2.0 * half / out.model.scale, 0.5 * out.model.size / out.model.scale);
  }
  findings.shell = true;
  thicken(out.model, half);
  // The sheets of a shell may touch each other anywhere, so it is one group.
  out.model.group.assign(out.model.triangle_count(), 0);
  out.model.group_count = 1;
  prepare(def, tasks, out);
  return {};
}

Result<Geometry> cook_piece(const DecompositionDef& def, const SampledSolid& solid, const ConvexBody& body) {
  // A plate whose corners are left out is a wedge, so the tolerance is small against the thickness too.
  const double tolerance = min(0.05 * solid.tolerance, 0.1 * body.thickness());
  const ConvexBody reduced = make_body(body.vertices, {def.max_hull_vertices, tolerance, 0.0});
  std::vector<Vec3> points;
  for (const DVec3& p : reduced.vertices) points.push_back(to_float(solid.model->to_metres(p)));
  return cook_hull(points);
}

// The final hull in the model's coordinates.
ConvexBody body_of(const SampledSolid& solid, const Geometry& hull) {
  std::vector<DVec3> points;
  for (const Vec3& p : view_hull(hull).vertices)
    points.push_back(solid.model->scale * (DVec3(p) - solid.model->origin));
  return make_body(points, {255, 0.0, 0.0});
}

}  // namespace

const char* to_string(SurfaceMeaning meaning) {
  constexpr const char* kNames[kSurfaceMeaningCount] = {"automatic", "solid", "shell"};
  return int(meaning) < kSurfaceMeaningCount ? kNames[int(meaning)] : "unknown";
}

bool DecompositionProgress::report_progress(double done) {
  if (stopped_ || def_.progress == nullptr) return !stopped_;
  reported_ = max(reported_, float(done));
  stopped_ = !def_.progress(def_.user, reported_);
  return !stopped_;
}

Result<Decomposition> decompose(const DecompositionDef& def) {
  const FloatMode mode;
  if (const Error error = check_settings(def)) return error;
  DecompositionProgress progress(def);
  if (!progress.report_progress(0.0)) return cancelled();
  Result<Model> model = make_model(def);
  if (!model) return model.error();
  TaskSystem tasks(def.threads);
  Prepared prepared;
  prepared.model = std::move(*model);
  if (const Error error = prepare_solid(def, tasks, prepared)) return error;
  const SampledSolid& solid = prepared.solid;
  if (!progress.report_progress(0.1)) return cancelled();

  // More parts than final hulls, so that joining has a choice.
  const int limit = max(4 * def.max_hulls, 64);
  std::vector<ConvexBody> pieces = cut_up(solid, tasks, limit, progress);
  join_pieces(solid, tasks, def.max_hulls, pieces, progress);
  if (progress.stopped() || !progress.report_progress(0.9)) return cancelled();

  Decomposition out;
  std::vector<ConvexBody> bodies;
  for (const ConvexBody& piece : pieces) {
    const Result<Geometry> hull = cook_piece(def, solid, piece);
    if (!hull) continue;  // thinner than a hull can be
    out.hulls.push_back(*hull);
    bodies.push_back(body_of(solid, *hull));
  }
  if (out.hulls.empty())
    return make_error(ErrorCode::invalid_geometry,
                      "decomposition: the mesh is flat; allowed are meshes that span a volume");
  out.stats.mesh = prepared.model.findings;
  out.stats.size = float(prepared.model.size / prepared.model.scale);
  if (prepared.model.findings.shell)
    out.stats.shell_thickness = float(2.0 * half_thickness(def, prepared.model) / prepared.model.scale);
  measure_pieces(solid, tasks, bodies, out.stats);
  if (!progress.report_progress(1.0)) return cancelled();
  return out;
}

std::uint64_t decomposition_key(const DecompositionDef& def) {
  Hasher hasher;
  const auto add_float = [&](float value) {
    std::uint32_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    hasher.add(std::uint64_t(bits));
  };
  hasher.add(kMethodVersion);
  hasher.add(std::uint64_t(def.vertices.size()));
  for (const Vec3& p : def.vertices) {
    for (int axis = 0; axis < 3; ++axis) add_float(p[axis]);
  }
  hasher.add(std::uint64_t(def.indices.size()));
  for (const std::uint32_t i : def.indices) hasher.add(std::uint64_t(i));
  add_float(def.concavity);
  add_float(def.shell_thickness);
  hasher.add(std::uint64_t(def.max_hulls));
  hasher.add(std::uint64_t(def.max_hull_vertices));
  hasher.add(std::uint64_t(def.meaning));
  return hasher.value();
}

}  // namespace gyre
