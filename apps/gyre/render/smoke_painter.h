// Draws smoke over what is drawn already, behind whose depth it does not appear.
#pragma once

#include "render/camera.h"
#include "render/smoke.h"

#include <epoxy/gl.h>

#include <string>
#include <vector>

namespace gyre {

// The light that falls on smoke.
struct SmokeLight {
  Vec3 sun, sky;               // colours
  const Mat4& sun_from_world;  // to 0..1
  GLuint sun_map;              // a depth texture of what casts shadows
};

class SmokePainter {
 public:
  // An error in words, empty if there is none.
  std::string create();
  // For one picture: with the light of a sun that does not move in it.
  void set(std::vector<SmokeVolume> volumes, Vec3 sun);
  // One sample of the picture. `shift`, 0 to 1, is another for each of them.
  void draw(const Mat4& clip, Vec3 eye, Vec3 forward, const SmokeLight& light, int slices, float shift) const;
  bool empty() const { return volumes_.empty(); }

 private:
  std::vector<SmokeVolume> volumes_;
  std::vector<GLuint> textures_;
  GLuint program_ = 0, vertex_array_ = 0, vertices_ = 0;
};

}  // namespace gyre
