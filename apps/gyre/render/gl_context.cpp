// OpenGL without a screen. See gl_context.h.
#include "render/gl_context.h"

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <cstdlib>

namespace gyre {
namespace {

constexpr const char* kNeeded =
    "; needed are the packages libegl1, libgl1 and libgl1-mesa-dri (Debian's names)";

// libepoxy ends the program when it finds no library, so they are looked for beforehand.
bool has_library(const char* name) {
  void* library = dlopen(name, RTLD_LAZY | RTLD_LOCAL);
  if (!library) return false;
  dlclose(library);
  return true;
}

}  // namespace

std::unique_ptr<GlContext> GlContext::create(std::string& error) {
  std::unique_ptr<GlContext> out(new GlContext);
  const std::string problem = out->start();
  if (problem.empty()) return out;
  error = "no picture can be drawn here: " + problem + kNeeded;
  return nullptr;
}

std::string GlContext::start() {
  if (!has_library("libEGL.so.1")) return "there is no libEGL.so.1";
  if (!has_library("libGL.so.1")) return "there is no libGL.so.1";
  // Drawn by the processor even where there is a graphics card: its pictures would differ. Who sets the variable decides.
  setenv("LIBGL_ALWAYS_SOFTWARE", "1", 0);
  if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless")) {
    return "EGL has no surfaceless platform";
  }
  const EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA,
                                                      static_cast<void*>(EGL_DEFAULT_DISPLAY), nullptr);
  if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr)) return "EGL does not start";
  display_ = display;
  if (!eglBindAPI(EGL_OPENGL_API)) return "EGL offers no OpenGL";
  constexpr EGLint kConfig[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT,
                                EGL_NONE};
  EGLConfig config = nullptr;
  EGLint configs = 0;
  if (!eglChooseConfig(display, kConfig, &config, 1, &configs) || configs == 0) return "EGL offers no OpenGL";
  constexpr EGLint kVersion[] = {EGL_CONTEXT_MAJOR_VERSION,
                                 3,
                                 EGL_CONTEXT_MINOR_VERSION,
                                 3,
                                 EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                 EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                 EGL_NONE};
  context_ = eglCreateContext(display, config, EGL_NO_CONTEXT, kVersion);
  if (context_ == EGL_NO_CONTEXT || !eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context_)) {
    return "OpenGL 3.3 cannot be had";
  }
  return {};
}

GlContext::~GlContext() {
  if (!display_) return;
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  if (context_) eglDestroyContext(display_, context_);
  // The display stays for the next context. Ending it would unload Mesa's driver, which loses memory when it goes.
}

}  // namespace gyre
