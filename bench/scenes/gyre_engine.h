// Gyre in the benchmark scenes: what a user gets by default, 4 sub-steps.
#pragma once

#include <gyre/gyre.h>

#include <optional>
#include <vector>

#include "bench/scenes/engine.h"

namespace gyre::bench {

class GyreEngine final : public Engine {
 public:
  explicit GyreEngine(int substeps = 4) : substeps_(substeps) {}
  const char* name() const override { return substeps_ == 4 ? "gyre" : "gyre-other"; }
  std::string settings() const override { return std::to_string(substeps_) + " substeps, defaults"; }
  bool create(const Scene& scene, int threads, bool sleep, std::string& why_not) override;
  void step() override { world_->step(float(kDt)); }
  BodyState state(int body) override;
  bool cast_ray(V3 from, V3 by, double& fraction) override;

  World& world() { return *world_; }

 private:
  bool cook(const Scene& scene, std::string& why_not);
  AnyShape geometry_of(const Shape& shape) const;
  void add_bodies(const Scene& scene);
  void add_joints(const Scene& scene);

  int substeps_;
  std::optional<World> world_;
  std::vector<BodyId> ids_;
  std::vector<Geometry> hulls_, meshes_;
};

}  // namespace gyre::bench
