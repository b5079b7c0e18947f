// Fills a world with what a scene describes. See world_builder.h.
#include "scene/world_builder.h"

#include <cmath>

namespace gyre {
namespace {

std::string pointer_to(const char* section, std::size_t index) {
  return std::string("/") + section + "/" + std::to_string(index);
}
std::string shape_pointer(std::size_t body, std::size_t shape) {
  return pointer_to("bodies", body) + "/shapes/" + std::to_string(shape);
}

template <class... Ts>
struct Overloaded : Ts... {
  using Ts::operator()...;
};
template <class... Ts>
Overloaded(Ts...) -> Overloaded<Ts...>;

}  // namespace

bool WorldBuilder::build() {
  mesh_cache_.resize(scene_.meshes.size());
  hull_cache_.resize(scene_.meshes.size());
  return add_pairs() && add_bodies() && add_joints() && add_couplings() && add_soft_matter() && add_fluids() &&
         add_fields();
}

bool WorldBuilder::fail(std::string pointer, std::string message) {
  error_ = SceneError{file_, 0, 0, std::move(pointer), std::move(message)};
  return false;
}

std::string WorldBuilder::last_refusal() const {
  const std::span<const Problem> problems = world_.problems();
  return problems.empty() ? "the engine refuses it" : problems.back().message;
}

bool WorldBuilder::add_pairs() {
  for (std::size_t i = 0; i < scene_.materials.size(); ++i) {
    const SceneMaterial& material = scene_.materials[i];
    if (material.surface_velocity == Vec3{} && material.one_way == Vec3{}) continue;
    const auto id = std::uint16_t(i + 1);
    if (!world_.set_surface_rule({id, material.surface, material.surface_velocity, material.one_way}))
      return fail(pointer_to("materials", i), last_refusal());
  }
  for (std::size_t i = 0; i < scene_.material_pairs.size(); ++i) {
    const SceneMaterialPair& pair = scene_.material_pairs[i];
    const Material& a = scene_.materials[std::size_t(pair.a)].surface;
    const Material& b = scene_.materials[std::size_t(pair.b)].surface;
    // What the pair does not say follows from the two materials as it would without the pair.
    const MaterialPair made{
        std::uint16_t(pair.a + 1), std::uint16_t(pair.b + 1),
        pair.static_friction.value_or(std::sqrt(a.static_friction * b.static_friction)),
        pair.dynamic_friction.value_or(std::sqrt(a.dynamic_friction * b.dynamic_friction)),
        pair.restitution.value_or(max(a.restitution, b.restitution))};
    if (!world_.set_material_pair(made)) return fail(pointer_to("material_pairs", i), last_refusal());
  }
  return true;
}

Material WorldBuilder::surface_of(const SceneShape& shape) const {
  Material out;
  if (shape.material >= 0) {
    out = scene_.materials[std::size_t(shape.material)].surface;
    out.id = std::uint16_t(shape.material + 1);
  }
  // One friction alone stands for both, unless the material already says what the other is.
  const bool alone = shape.material < 0;
  if (shape.static_friction) {
    out.static_friction = *shape.static_friction;
    out.dynamic_friction = alone ? *shape.static_friction : min(out.dynamic_friction, *shape.static_friction);
  }
  if (shape.dynamic_friction) {
    out.dynamic_friction = *shape.dynamic_friction;
    if (!shape.static_friction) {
      out.static_friction =
          alone ? *shape.dynamic_friction : max(out.static_friction, *shape.dynamic_friction);
    }
  }
  if (shape.restitution) out.restitution = *shape.restitution;
  if (shape.rolling_friction) out.rolling_friction = *shape.rolling_friction;
  if (shape.spinning_friction) out.spinning_friction = *shape.spinning_friction;
  return out;
}

bool WorldBuilder::cook(const SceneHull& hull, const std::string& pointer, Geometry& out) {
  if (hull.mesh >= 0 && hull_cache_[std::size_t(hull.mesh)]) {
    out = hull_cache_[std::size_t(hull.mesh)];
    return true;
  }
  const std::vector<Vec3>& points =
      hull.mesh >= 0 ? scene_.meshes[std::size_t(hull.mesh)].vertices : hull.points;
  Result<Geometry> made = cook_hull(points);
  if (!made) return fail(pointer + (hull.mesh >= 0 ? "/mesh" : "/points"), made.error().message);
  out = *made;
  if (hull.mesh >= 0) hull_cache_[std::size_t(hull.mesh)] = out;
  return true;
}

bool WorldBuilder::cook(const SceneTriangles& mesh, const std::string& pointer, Geometry& out) {
  Geometry& cached = mesh_cache_[std::size_t(mesh.mesh)];
  if (!cached) {
    const SceneMesh& data = scene_.meshes[std::size_t(mesh.mesh)];
    MeshDef def;
    def.vertices = data.vertices;
    def.indices = data.indices;
    Result<Geometry> made = cook_mesh(def);
    if (!made) return fail(pointer + "/mesh", made.error().message);
    cached = *made;
  }
  out = cached;
  return true;
}

bool WorldBuilder::cook(const SceneHeightField& field, const std::string& pointer, Geometry& out) {
  HeightFieldDef def;
  def.heights = field.heights;
  def.columns = field.columns;
  def.rows = field.rows;
  def.spacing = field.spacing;
  Result<Geometry> made = cook_height_field(def);
  if (!made) return fail(pointer + "/heights", made.error().message);
  out = *made;
  return true;
}

bool WorldBuilder::make_shape(std::size_t body, std::size_t index, ShapeDef& out) {
  const SceneShape& shape = scene_.bodies[body].shapes[index];
  const std::string pointer = shape_pointer(body, index);
  const auto cooked = [&](const auto& source) {
    Geometry geometry;
    if (!cook(source, pointer, geometry)) return false;
    out.geometry = geometry;
    return true;
  };
  const bool made = std::visit(Overloaded{
                                   [&](const SceneHull& hull) { return cooked(hull); },
                                   [&](const SceneTriangles& mesh) { return cooked(mesh); },
                                   [&](const SceneHeightField& field) { return cooked(field); },
                                   [&](const SceneDecomposition& hulls) {
                                     out.geometry = hulls.hull;
                                     return true;
                                   },
                                   [&](const auto& simple) {
                                     out.geometry = simple;
                                     return true;
                                   },
                               },
                               shape.geometry);
  if (!made) return false;
  out.local = shape.local;
  out.density = shape.material >= 0 ? scene_.materials[std::size_t(shape.material)].density : 1000.0f;
  if (shape.density) out.density = *shape.density;
  if (const auto* const hulls = std::get_if<SceneDecomposition>(&shape.geometry))
    out.density *= hulls->density_scale;
  out.material = surface_of(shape);
  out.filter = scene_.bodies[body].filter;
  out.sensor = scene_.bodies[body].sensor;
  return true;
}

// Of decomposed meshes that are closed the exact mass, centre and inertia are known, which those of their hulls only come near.
void WorldBuilder::take_solid_mass(std::size_t body, const std::vector<ShapeDef>& shapes,
                                   BodyDef& def) const {
  if (def.type != BodyType::dynamic || def.mass || def.center_of_mass || def.inertia) return;
  std::vector<MassProperties> parts;
  bool any = false;
  for (std::size_t k = 0; k < shapes.size(); ++k) {
    const auto* const hulls = std::get_if<SceneDecomposition>(&scene_.bodies[body].shapes[k].geometry);
    if ((hulls != nullptr && hulls->part > 0) || !(shapes[k].density > 0.0f)) continue;
    Result<MassProperties> mass = mass_properties(Sphere{}, 1.0f);
    if (hulls != nullptr) {
      const SceneMesh& mesh = scene_.meshes[std::size_t(hulls->mesh)];
      mass = mesh_mass(mesh.vertices, mesh.indices, shapes[k].density / hulls->density_scale);
      any = true;
    } else {
      mass = mass_properties(shapes[k].geometry, shapes[k].density);
    }
    if (!mass) return;
    parts.push_back(transformed(*mass, shapes[k].local));
  }
  if (!any) return;
  const MassProperties all = combined(parts);
  def.mass = all.mass;
  def.center_of_mass = all.center;
  def.inertia = all.inertia;
}

// Finds out which part of a refused body the engine does not take, by trying the parts alone in an empty world.
bool WorldBuilder::blame(std::size_t body, const BodyDef& def, const std::vector<ShapeDef>& shapes) {
  const std::string why = last_refusal();
  const std::string pointer = pointer_to("bodies", body);
  Result<World> scratch = World::create();
  if (!scratch) return fail(pointer, why);
  BodyDef bare;
  bare.type = def.type;
  const BodyId carrier = scratch->add_body(bare);
  for (std::size_t i = 0; carrier && i < shapes.size(); ++i) {
    if (!scratch->add_shape(carrier, shapes[i])) return fail(shape_pointer(body, i), why);
  }
  return fail(pointer, why);
}

bool WorldBuilder::add_bodies() {
  std::vector<ShapeDef> shapes;
  for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
    const SceneBody& body = scene_.bodies[i];
    shapes.assign(body.shapes.size(), {});
    for (std::size_t k = 0; k < shapes.size(); ++k) {
      if (!make_shape(i, k, shapes[k])) return false;
    }
    BodyDef def = body.def;
    def.user_data = i;
    take_solid_mass(i, shapes, def);
    const BodyId id = world_.add_body(def, shapes);
    if (!id) return blame(i, def, shapes);
    bodies_.push_back(id);
  }
  return true;
}

bool WorldBuilder::add_joints() {
  for (std::size_t i = 0; i < scene_.joints.size(); ++i) {
    const SceneJoint& joint = scene_.joints[i];
    JointDef def = joint.def;
    const auto set_bodies = [&](auto& d) {
      if (joint.a >= 0) d.a = bodies_[std::size_t(joint.a)];
      if (joint.b >= 0) d.b = bodies_[std::size_t(joint.b)];
    };
    std::visit(set_bodies, def);
    const JointId id = world_.add_joint(def);
    if (!id) return fail(pointer_to("joints", i), last_refusal());
    joints_.push_back(id);
  }
  return true;
}

bool WorldBuilder::add_couplings() {
  for (std::size_t i = 0; i < scene_.couplings.size(); ++i) {
    CouplingDef def;
    for (const SceneCouplingTerm& term : scene_.couplings[i].terms)
      def.terms.push_back({joints_[std::size_t(term.joint)], term.axis, term.coefficient});
    def.offset = scene_.couplings[i].offset;
    const CouplingId id = world_.add_coupling(def);
    if (!id) return fail(pointer_to("couplings", i), last_refusal());
    couplings_.push_back(id);
  }
  for (std::size_t i = 0; i < scene_.ignored_pairs.size(); ++i) {
    const auto& [a, b] = scene_.ignored_pairs[i];
    if (!world_.set_pair_ignored(bodies_[std::size_t(a)], bodies_[std::size_t(b)], true))
      return fail(pointer_to("ignored_pairs", i), last_refusal());
  }
  return true;
}

bool WorldBuilder::add_fields() {
  for (std::size_t i = 0; i < scene_.fields.size(); ++i) {
    if (!world_.add_field(scene_.fields[i])) return fail(pointer_to("force_fields", i), last_refusal());
  }
  return true;
}

}  // namespace gyre
