// OpenGL without a screen or a display server: EGL on Mesa's surfaceless platform, drawn by the processor, so that pictures do not
// depend on a graphics card.
#pragma once

#include <memory>
#include <string>

namespace gyre {

class GlContext {
 public:
  // Null and an error in words if this machine has none.
  static std::unique_ptr<GlContext> create(std::string& error);
  ~GlContext();
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;

 private:
  GlContext() = default;
  std::string start();  // what failed; empty if nothing did

  void* display_ = nullptr;
  void* context_ = nullptr;
};

}  // namespace gyre
