// Draws a list of triangles with the light of a sun and a sky. Every picture is the mean of many samples, each with another
// place within the pixel, another point of the sun's disc and another direction of the sky: edges are smooth, shadows are soft
// and corners are dark because of that, without any further trick.
#pragma once

#include "render/camera.h"
#include "render/draw_list.h"
#include "render/gl_context.h"
#include "render/picture.h"

#include <memory>
#include <string>

namespace gyre {

class Renderer {
 public:
  // `samples` a pixel, 1 to 1024. Null and an error in words if this machine cannot draw, or not as large.
  static std::unique_ptr<Renderer> create(int width, int height, int samples, std::string& error);
  ~Renderer();

  // The sun stands to the left of where the first camera looks, and stays there.
  Picture draw(const DrawList& list, const Camera& camera, const Subject& subject);

 private:
  struct Gl;
  explicit Renderer(std::unique_ptr<Gl> gl);
  std::unique_ptr<Gl> gl_;
};

}  // namespace gyre
