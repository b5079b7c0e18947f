#include "dynamics/fluid/fluid_solids.h"

#include "base/hash.h"
#include "geometry/query/point_query.h"
#include "math/rotation.h"
#include "task/parallel.h"

#include <cmath>
#include <cstring>
#include <span>
#include <utility>

namespace gyre {

namespace {

constexpr int kPointRows = 8;     // of points in a block of work
constexpr float kClosed = 0.01f;  // a face that is open by less is closed, as for the pressure
constexpr std::size_t kMaxLabels = 32767;

// Where points of the grid are, in the world and in the arrays: corners of cells or their centres. Along a flat axis they stand in the middle
// of the cell, so that a plane flow sees the section there.
struct PointGrid {
  int count[3];
  Vec3 cell;
  DVec3 corner;
  bool flat[3];

  double offset;             // of the first point from the lower corner, in cells
  float reach_cells;         // distances are found up to so many edges
  int first[3] = {0, 0, 0};  // the first cell from the corner

  static PointGrid of_corners(const GasBox& box) { return PointGrid(box, 1, 0.0, 2.0f); }
  static PointGrid of_centers(const GasBox& box) { return PointGrid(box, 0, 0.5, 4.0f); }
  // The part of the grid within a window.
  PointGrid part(const GasBox& whole, const FluidWindow& window) const {
    PointGrid result = *this;
    for (int axis = 0; axis < 3; ++axis) {
      result.first[axis] = window.first[axis];
      result.count[axis] = window.box.cells[axis] + count[axis] - whole.cells[axis];
    }
    return result;
  }
  std::size_t size() const { return std::size_t(count[0]) * std::size_t(count[1]) * std::size_t(count[2]); }
  std::size_t at(int i, int j, int k) const {
    return std::size_t(i) + std::size_t(count[0]) * (std::size_t(j) + std::size_t(count[1]) * std::size_t(k));
  }
  double along(int axis, int n) const { return flat[axis] ? 0.5 : double(first[axis] + n) + offset; }
  DVec3 place(int i, int j, int k) const {
    return corner +
           DVec3{along(0, i) * double(cell.x), along(1, j) * double(cell.y), along(2, k) * double(cell.z)};
  }
  float edge(int axis) const { return axis == 0 ? cell.x : axis == 1 ? cell.y : cell.z; }
  float reach() const { return reach_cells * max(cell.x, max(cell.y, cell.z)); }

 private:
  PointGrid(const GasBox& box, int more, double before, float cells)
      : cell(box.cell), corner(box.corner), offset(before), reach_cells(cells) {
    for (int axis = 0; axis < 3; ++axis) count[axis] = box.cells[axis] + more, flat[axis] = box.flat(axis);
  }
};

bool has_solid_motion(const RigidWorld& w, std::uint32_t body) {
  return w.bodies.flags[body].type != BodyType::fixed;
}

std::uint64_t add_key(std::uint64_t key, double number) {
  return mix_bits(key + __builtin_bit_cast(std::uint64_t, number));
}
std::uint64_t add_shape_key(std::uint64_t key, const RigidWorld& w, std::uint32_t shape,
                            const NearShape& near) {
  key = mix_bits(key + (std::uint64_t(shape) << 32 | w.shapes.ids.generation(shape)));
  for (const double number : {near.pose.position.x, near.pose.position.y, near.pose.position.z})
    key = add_key(key, number);
  const Quat& q = near.pose.orientation;
  for (const float number : {q.x, q.y, q.z, q.w}) key = add_key(key, double(number));
  return key;
}

// The points of an axis within a box that is grown by the reach.
void points_within(const PointGrid& grid, int axis, double low, double high, int& begin, int& end) {
  const double origin = axis == 0 ? grid.corner.x : axis == 1 ? grid.corner.y : grid.corner.z;
  const double edge = double(grid.edge(axis)), reach = double(grid.reach());
  begin = 0, end = grid.count[axis];
  if (grid.flat[axis]) return;
  const double before = double(grid.first[axis]);
  const double first = std::ceil((low - reach - origin) / edge) - before,
               last = std::floor((high + reach - origin) / edge) - before;
  begin = first > 0.0 ? (first < double(end) ? int(first) : end) : 0;
  if (last < double(end - 1)) end = last < double(begin) ? begin : int(last) + 1;
}

void add_shape(const PointGrid& grid, const NearShape& near, TaskSystem& tasks, GridDistances& out) {
  int begin[3], end[3];
  const double low[3] = {double(near.box.low.x), double(near.box.low.y), double(near.box.low.z)};
  const double high[3] = {double(near.box.high.x), double(near.box.high.y), double(near.box.high.z)};
  for (int axis = 0; axis < 3; ++axis)
    points_within(grid, axis, low[axis], high[axis], begin[axis], end[axis]);
  const int rows_y = end[1] - begin[1], rows_z = end[2] - begin[2];
  if (rows_y <= 0 || rows_z <= 0 || end[0] <= begin[0]) return;
  const DQuat turn = to_double(near.pose.orientation);
  const float reach = grid.reach();
  // Of a mesh or height field also what is deep inside is asked for: the whole of the box is within this distance.
  const double far = double(reach) + length(DVec3(near.box.high) - DVec3(near.box.low)) +
                     length(grid.place(grid.count[0], grid.count[1], grid.count[2]) - grid.corner);
  for_blocks(tasks, rows_y * rows_z, kPointRows, [&](int first, int last, int) {
    for (int row = first; row < last; ++row) {
      const int k = begin[2] + row / rows_y, j = begin[1] + row % rows_y;
      if ((grid.flat[1] && j > 0) || (grid.flat[2] && k > 0)) continue;
      for (int i = begin[0]; i < end[0]; ++i) {
        if (grid.flat[0] && i > 0) continue;
        const DVec3 local = rotate_inverse(turn, grid.place(i, j, k) - near.pose.position);
        PointDistance found;
        if (!find_point_distance(*near.shape, local, far, found) || !(found.distance < double(reach)))
          continue;
        const std::size_t at = grid.at(i, j, k);
        const float distance = max(float(found.distance), -reach);
        if (!(distance < out.distance[at])) continue;
        out.distance[at] = distance;
        out.body[at] = near.body;
      }
    }
  });
}

// The second point along a flat axis is as the first.
void copy_flat_points(const PointGrid& grid, GridDistances& out) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!grid.flat[axis]) continue;
    for (int k = 0; k < grid.count[2]; ++k) {
      for (int j = 0; j < grid.count[1]; ++j) {
        for (int i = 0; i < grid.count[0]; ++i) {
          const int n[3] = {i, j, k};
          if (n[axis] == 0) continue;
          const std::size_t from = grid.at(axis == 0 ? 0 : i, axis == 1 ? 0 : j, axis == 2 ? 0 : k);
          out.distance[grid.at(i, j, k)] = out.distance[from], out.body[grid.at(i, j, k)] = out.body[from];
        }
      }
    }
  }
}

void clear_distances(const PointGrid& grid, GridDistances& out) {
  out.distance.clear(), out.body.clear();
  out.distance.resize(grid.size(), grid.reach());
  out.body.resize(grid.size(), kNoIndex);
}

// The part of a triangle in which what is linear between the values at its corners is negative.
float negative_part(float a, float b, float c) {
  const int count = (a < 0.0f ? 1 : 0) + (b < 0.0f ? 1 : 0) + (c < 0.0f ? 1 : 0);
  if (count == 0) return 0.0f;
  if (count == 3) return 1.0f;
  // The corner that differs in sign from the two others comes first.
  const bool negative = count == 1;
  if ((b < 0.0f) == negative)
    std::swap(a, b);
  else if ((c < 0.0f) == negative)
    std::swap(a, c);
  const float part = (a / (a - b)) * (a / (a - c));
  return negative ? part : 1.0f - part;
}
// Of a rectangle with the corners a, b, c, d in a round: the mean of its two ways into triangles, so that no diagonal is preferred.
float negative_part(float a, float b, float c, float d) {
  return 0.25f *
         (negative_part(a, b, c) + negative_part(a, c, d) + negative_part(a, b, d) + negative_part(b, c, d));
}

class FaceCutter {
 public:
  FaceCutter(const RigidWorld& w, const FluidEntry& entry, const PointGrid& corners, FluidSolids& out)
      : w_(w),
        frame_(entry.frame()),
        box_(entry.box()),
        grid_(corners),
        shape_(out.window.shape),
        out_(out) {}

  // Faces across an axis: the open part, the label and the velocity of the solid there.
  void cut(int axis, TaskSystem& tasks) {
    const int b = axis == 0 ? 1 : 0, c = axis == 2 ? 1 : 2;
    int count[3];
    for (int n = 0; n < 3; ++n) count[n] = shape_.cells[n] + (n == axis ? 1 : 0);
    for_blocks(tasks, count[1] * count[2], kPointRows, [&](int first, int last, int) {
      for (int row = first; row < last; ++row) {
        const int k = row / count[1], j = row % count[1];
        if (!out_.solids.may_cut(shape_, j, k)) continue;
        for (int i = 0; i < count[0]; ++i) {
          int at[3] = {i, j, k};
          std::size_t corner[4];
          corner[0] = grid_.at(at[0], at[1], at[2]);
          ++at[b];
          corner[1] = grid_.at(at[0], at[1], at[2]);
          ++at[c];
          corner[2] = grid_.at(at[0], at[1], at[2]);
          --at[b];
          corner[3] = grid_.at(at[0], at[1], at[2]);
          set_face(axis, i, j, k, corner);
        }
      }
    });
  }

 private:
  void set_face(int axis, int i, int j, int k, const std::size_t (&corner)[4]) {
    const Array<float>& d = out_.corners.all.distance;
    const std::size_t c = std::size_t(shape_.at(i, j, k));
    std::size_t nearest = corner[0];
    for (const std::size_t one : corner)
      if (d[one] < d[nearest]) nearest = one;
    if (!(d[nearest] < 0.0f)) return;
    out_.solids.open[axis][c] = 1.0f - negative_part(d[corner[0]], d[corner[1]], d[corner[2]], d[corner[3]]);
    const std::uint32_t body = out_.corners.all.body[nearest];
    const std::int16_t label = out_.label_of[body];
    out_.solids.label[axis][c] = label;
    const DVec3 half{axis == 0 ? 0.0 : 0.5, axis == 1 ? 0.0 : 0.5, axis == 2 ? 0.0 : 0.5};
    const DVec3 at =
        point_to_world(frame_, grid_.corner + DVec3{(grid_.first[0] + i + half.x) * double(grid_.cell.x),
                                                    (grid_.first[1] + j + half.y) * double(grid_.cell.y),
                                                    (grid_.first[2] + k + half.z) * double(grid_.cell.z)});
    Vec3 velocity{};
    if (has_solid_motion(w_, body)) {
      const BodyMotion& motion = w_.bodies.motion[body];
      const DVec3 center = w_.bodies.poses[body].center, in_box = point_to_frame(frame_, at);
      const DVec3 shift = image_shift(box_, in_box, point_to_frame(frame_, center));
      const Vec3 arm = difference(at, center) + to_float(vector_to_world(frame_, shift));
      velocity = motion.linear_velocity + cross(motion.angular_velocity, arm);
    } else if (frame_ == nullptr || !frame_->moves()) {
      return;
    }
    velocity = velocity_to_frame(frame_, at, velocity);
    out_.solids.velocity[axis][c] = axis == 0 ? velocity.x : axis == 1 ? velocity.y : velocity.z;
  }

  const RigidWorld& w_;
  const FluidFrame* frame_;
  const GasBox& box_;
  PointGrid grid_;
  const GridShape& shape_;
  FluidSolids& out_;
};

// Rows near a corner within a solid.
void find_near_rows(const PointGrid& grid, TaskSystem& tasks, FluidSolids& out) {
  const int rows_y = grid.count[1], rows = rows_y * grid.count[2];
  out.within_row.resize_uninitialized(std::size_t(rows));
  for_blocks(tasks, rows, kPointRows, [&](int first, int last, int) {
    for (int row = first; row < last; ++row) {
      const float* const distance =
          out.corners.all.distance.data() + std::size_t(row) * std::size_t(grid.count[0]);
      int any = 0;
      for (int i = 0; i < grid.count[0]; ++i) any |= distance[i] < 0.0f ? 1 : 0;
      out.within_row[row] = std::uint8_t(any);
    }
  });
  out.solids.near.resize_uninitialized(std::size_t(rows));
  for (int row = 0; row < rows; ++row) {
    const int above = row % rows_y + 1 < rows_y ? row + 1 : row, beyond = row + rows_y < rows ? rows_y : 0;
    out.solids.near[row] = std::uint8_t(out.within_row[row] | out.within_row[above] |
                                        out.within_row[row + beyond] | out.within_row[above + beyond]);
  }
}

// A cell all of whose faces are closed lies within a solid.
void mark_solid_cells(const GridShape& shape, TaskSystem& tasks, GasSolids& solids) {
  for_blocks(tasks, shape.rows(), kPointRows, [&](int first, int last, int) {
    for (int row = first; row < last; ++row) {
      const int k = row / shape.cells[1], j = row % shape.cells[1];
      if (!solids.may_cut(shape, j, k)) continue;
      const int begin = shape.row(j, k);
      for (int c = begin; c < begin + shape.cells[0]; ++c) {
        bool closed = true;
        for (int axis = 0; axis < 3; ++axis) {
          const Array<float>& open = solids.open[axis];
          closed =
              closed && open[std::size_t(c)] < kClosed && open[std::size_t(c + shape.stride(axis))] < kClosed;
        }
        if (closed) solids.solid[std::size_t(c)] = 1;
      }
    }
  });
}

// Numbers the bodies that the corners name, in the order of their indices.
void number_bodies(const RigidWorld& w, FluidSolids& out) {
  out.label_of.resize(w.bodies.flags.size(), std::int16_t(-1));
  for (std::int16_t& label : out.label_of) label = -1;
  for (const NearShape& near : out.fixed) out.label_of[near.body] = 0;
  for (const NearShape& near : out.moving) out.label_of[near.body] = 0;
  out.bodies.clear();
  for (std::uint32_t body = 0; body < out.label_of.size(); ++body) {
    if (out.label_of[body] < 0) continue;
    // So many bodies in one fluid share the last label.
    if (out.bodies.size() < kMaxLabels) out.bodies.push_back(body);
    out.label_of[body] = std::int16_t(out.bodies.size() - 1);
  }
}

// The distances of fixed shapes at the points of a window.
void copy_part(const PointGrid& whole, const PointGrid& grid, SolidDistances& out) {
  out.all.distance.resize_uninitialized(grid.size()), out.all.body.resize_uninitialized(grid.size());
  const std::size_t count = std::size_t(grid.count[0]);
  for (int k = 0; k < grid.count[2]; ++k) {
    for (int j = 0; j < grid.count[1]; ++j) {
      const std::size_t to = grid.at(0, j, k);
      const std::size_t from = whole.at(grid.first[0], grid.first[1] + j, grid.first[2] + k);
      std::memcpy(out.all.distance.data() + to, out.fixed.distance.data() + from, count * sizeof(float));
      std::memcpy(out.all.body.data() + to, out.fixed.body.data() + from, count * sizeof(std::uint32_t));
    }
  }
}

// The distances of all shapes at the points of a window. Returns true if they are not those of the last step. Those of fixed shapes are found
// in all of the box, since windows move and fixed shapes do not.
bool find_distances(const PointGrid& whole, const PointGrid& grid, bool same_window, TaskSystem& tasks,
                    const FluidSolids& solids, SolidDistances& out) {
  if (out.all.key == solids.all_key && same_window) return false;
  if (solids.fixed.empty()) {
    out.fixed = {};
    clear_distances(grid, out.all);
  } else {
    if (out.fixed.key != solids.fixed_key) {
      clear_distances(whole, out.fixed);
      for (const NearShape& near : solids.fixed) add_shape(whole, near, tasks, out.fixed);
      copy_flat_points(whole, out.fixed);
      out.fixed.key = solids.fixed_key;
    }
    copy_part(whole, grid, out);
  }
  for (const NearShape& near : solids.moving) add_shape(grid, near, tasks, out.all);
  copy_flat_points(grid, out.all);
  out.all.key = solids.all_key;
  return true;
}

// A liquid also asks for the distance and the label of the nearest solid at each centre.
void set_center_distances(const PointGrid& grid, const GridShape& shape, FluidSolids& out) {
  const std::size_t size = std::size_t(shape.size);
  GasSolids& solids = out.solids;
  solids.distance.clear(), solids.distance.resize(size, grid.reach());
  solids.nearest.clear(), solids.nearest.resize(size, std::int16_t(-1));
  for (int k = 0; k < shape.cells[2]; ++k) {
    for (int j = 0; j < shape.cells[1]; ++j) {
      for (int i = 0; i < shape.cells[0]; ++i) {
        const std::size_t from = grid.at(i, j, k), c = std::size_t(shape.at(i, j, k));
        const std::uint32_t body = out.centers.all.body[from];
        if (body == kNoIndex) continue;
        solids.distance[c] = out.centers.all.distance[from];
        solids.nearest[c] = out.label_of[body];
        if (solids.distance[c] < 0.0f) solids.solid[c] = 1;
      }
    }
  }
  const GasBox& box = out.window.box;
  const bool periodic[3] = {box.periodic(0), box.periodic(1), box.periodic(2)};
  if (periodic[0] || periodic[1] || periodic[2]) wrap_ghosts(shape, periodic, solids.distance.data());
}

bool do_boxes_meet(const Aabb& a, const Aabb& b) {
  return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y && b.low.y <= a.high.y &&
         a.low.z <= b.high.z && b.low.z <= a.high.z;
}

// A periodic box repeats what is in it: a shape that crosses a periodic side is there on the opposite side too. Calls fn(image) for those images
// that are within `reach`.
template <class Fn>
void for_images(const GasBox& box, const NearShape& near, const Aabb& inside, const Aabb& reach, Fn&& fn) {
  if (!box.periodic(0) && !box.periodic(1) && !box.periodic(2)) return;
  const Aabb exact = bounds(*near.shape, Transform{to_float(near.pose.position), near.pose.orientation});
  if (!do_boxes_meet(exact, inside)) return;
  int most[3];
  double length[3];
  for (int axis = 0; axis < 3; ++axis) {
    most[axis] = box.periodic(axis) && !box.flat(axis) ? 1 : 0;
    length[axis] = box.cells[axis] * double(axis == 0 ? box.cell.x : axis == 1 ? box.cell.y : box.cell.z);
  }
  for (int k = -most[2]; k <= most[2]; ++k) {
    for (int j = -most[1]; j <= most[1]; ++j) {
      for (int i = -most[0]; i <= most[0]; ++i) {
        if (i == 0 && j == 0 && k == 0) continue;
        const DVec3 shift{i * length[0], j * length[1], k * length[2]};
        NearShape image = near;
        image.pose.position += shift;
        image.box = Aabb{exact.low + to_float(shift), exact.high + to_float(shift)};
        if (do_boxes_meet(image.box, reach)) fn(image);
      }
    }
  }
}

}  // namespace

void find_near_shapes(const RigidWorld& w, const FluidEntry& entry, FluidSolids& out) {
  const GasBox& box = entry.box();
  const FluidFrame* const frame = entry.frame();
  const double reach =
      double(entry.is_liquid() ? PointGrid::of_centers(box).reach() : PointGrid::of_corners(box).reach());
  const DVec3 margin{reach, reach, reach};
  const DVec3 upper = box.corner + DVec3{box.cells[0] * double(box.cell.x), box.cells[1] * double(box.cell.y),
                                         box.cells[2] * double(box.cell.z)};
  const Aabb whole{to_float(box.corner - margin), to_float(upper + margin)};
  const Aabb inside{to_float(box.corner), to_float(upper)};
  out.fixed.clear(), out.moving.clear();
  out.fixed_key = out.all_key = 1;
  w.shapes.ids.for_each_live([&](std::uint32_t one) {
    const Proxy& proxy = w.shapes.proxies[one];
    if (proxy.sensor || (frame == nullptr && !do_boxes_meet(proxy.fat_box, whole))) return;
    const std::uint32_t body = w.shapes.bodies[one];
    NearShape near{&w.shapes.colliders[one].shape, body,
                   origin_pose(w.bodies, body) * w.shapes.body_from_shape[one], proxy.fat_box};
    if (frame != nullptr) {
      near.pose = pose_to_frame(frame, near.pose);
      near.box = bounds(*near.shape, Transform{to_float(near.pose.position), near.pose.orientation});
      if (!do_boxes_meet(near.box, whole)) return;
    }
    const bool moves = has_solid_motion(w, body);
    out.all_key = add_shape_key(out.all_key, w, one, near);
    if (!moves) out.fixed_key = add_shape_key(out.fixed_key, w, one, near);
    auto& list = moves ? out.moving : out.fixed;
    list.push_back(near);
    for_images(box, near, inside, whole, [&](const NearShape& image) { list.push_back(image); });
  });
  out.bodies.clear();
  if (!out.fixed.empty() || !out.moving.empty()) number_bodies(w, out);
}

void cut_fluid_cells(const RigidWorld& w, const FluidEntry& entry, const FluidWindow& window,
                     TaskSystem& tasks, FluidSolids& out) {
  const GridShape& shape = window.shape;
  const bool is_liquid = entry.is_liquid();
  bool same_shape = true, same_window = true;
  for (int axis = 0; axis < 3; ++axis) {
    same_shape = same_shape && out.window.box.cells[axis] == window.box.cells[axis];
    same_window = same_window && out.window.first[axis] == window.first[axis];
  }
  same_window = same_window && same_shape;
  out.window = window;
  const std::uint64_t revision = out.solids.revision;
  if (!same_shape) out.solids = GasSolids{}, out.solids.revision = revision;
  if (out.fixed.empty() && out.moving.empty()) {
    if (out.solids.labels != 0) clear_solids(shape, 0, out.solids), ++out.solids.revision;
    out.solids.distance.clear(), out.solids.nearest.clear();
    out.corners.all.key = out.centers.all.key = 0;
    return;
  }
  const GasBox& box = entry.box();
  const PointGrid all_corners = PointGrid::of_corners(box), all_centers = PointGrid::of_centers(box);
  const PointGrid corners = all_corners.part(box, window), centers = all_centers.part(box, window);
  const bool changed = find_distances(all_corners, corners, same_window, tasks, out, out.corners);
  if (is_liquid) find_distances(all_centers, centers, same_window, tasks, out, out.centers);
  clear_solids(shape, int(out.bodies.size()), out.solids);
  out.solids.revision = revision + (changed ? 1 : 0);
  find_near_rows(corners, tasks, out);
  FaceCutter cutter(w, entry, corners, out);
  for (int axis = 0; axis < 3; ++axis) cutter.cut(axis, tasks);
  mark_solid_cells(shape, tasks, out.solids);
  if (is_liquid) set_center_distances(centers, shape, out);
}

}  // namespace gyre
