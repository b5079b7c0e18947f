// The last error of each thread, shapes of any kind, and recordings whose bytes go to a function of the program.
#include "capi/convert.h"

#include <cstdio>
#include <string>

#ifndef GYRE_VERSION
#define GYRE_VERSION "0"
#endif

namespace gyre {
namespace {

struct LastError {
  ErrorCode code = ErrorCode::none;
  std::string text;
};
LastError& last_error() {
  static thread_local LastError error;
  return error;
}

Geometry geometry_of(const GyreGeometry* geometry) {
  return geometry != nullptr ? *geometry->value : Geometry();
}

}  // namespace

namespace c {

void refuse_text(ErrorCode code, const std::string& text) { last_error() = {code, text}; }
void refuse(const Error& error) { refuse_text(error.code, error.message); }
void refuse_null(const char* function) {
  refuse(make_error(ErrorCode::invalid_argument, "%s: a handle is NULL, or its world is gone", function));
}
void refuse_size(const char* name, std::size_t found, std::size_t most) {
  refuse(make_error(
      ErrorCode::invalid_argument,
      "%s: size is %zu, expected 4 to %zu: fill it by its _init function, with the header of this version",
      name, found, most));
}
void refuse_command(const World& world) {
  const std::span<const Problem> problems = world.problems();
  if (problems.empty()) {
    refuse_text(ErrorCode::invalid_argument, "refused");
  } else {
    refuse_text(problems.back().code, problems.back().message);
  }
}
GyreErrorCode checked(const Error& error) {
  if (!error.ok()) refuse(error);
  return same<GyreErrorCode>(error.code);
}

}  // namespace c

void take(const GyreAnyShape& in, AnyShape& out) {
  switch (in.kind) {
    case GYRE_SHAPE_KIND_SPHERE:
      out = c::same<Sphere>(in.as.sphere);
      break;
    case GYRE_SHAPE_KIND_BOX:
      out = c::same<Box>(in.as.box);
      break;
    case GYRE_SHAPE_KIND_CAPSULE:
      out = c::same<Capsule>(in.as.capsule);
      break;
    case GYRE_SHAPE_KIND_CYLINDER:
      out = c::same<Cylinder>(in.as.cylinder);
      break;
    case GYRE_SHAPE_KIND_CONE:
      out = c::same<Cone>(in.as.cone);
      break;
    case GYRE_SHAPE_KIND_PLANE:
      out = c::same<Plane>(in.as.plane);
      break;
    case GYRE_SHAPE_KIND_HULL:
    case GYRE_SHAPE_KIND_MESH:
    case GYRE_SHAPE_KIND_HEIGHT_FIELD:
      out = geometry_of(in.as.geometry);
      break;
    default:
      out = Geometry();  // which the engine refuses
  }
}

void give(const AnyShape& in, GyreAnyShape& out, c::Arena&) {
  if (const auto* geometry = std::get_if<Geometry>(&in)) {
    out.kind = c::same<GyreShapeKind>(geometry->kind());
    out.as.geometry = *geometry ? new GyreGeometry(*geometry) : nullptr;
  } else if (const auto* sphere = std::get_if<Sphere>(&in)) {
    out.kind = GYRE_SHAPE_KIND_SPHERE, c::copy(*sphere, out.as.sphere);
  } else if (const auto* box = std::get_if<Box>(&in)) {
    out.kind = GYRE_SHAPE_KIND_BOX, c::copy(*box, out.as.box);
  } else if (const auto* capsule = std::get_if<Capsule>(&in)) {
    out.kind = GYRE_SHAPE_KIND_CAPSULE, c::copy(*capsule, out.as.capsule);
  } else if (const auto* cylinder = std::get_if<Cylinder>(&in)) {
    out.kind = GYRE_SHAPE_KIND_CYLINDER, c::copy(*cylinder, out.as.cylinder);
  } else if (const auto* cone = std::get_if<Cone>(&in)) {
    out.kind = GYRE_SHAPE_KIND_CONE, c::copy(*cone, out.as.cone);
  } else if (const auto* plane = std::get_if<Plane>(&in)) {
    out.kind = GYRE_SHAPE_KIND_PLANE, c::copy(*plane, out.as.plane);
  }
}

}  // namespace gyre

using namespace gyre;
using namespace gyre::c;

GyreWorld::~GyreWorld() {
  for (GyreRecorder* recorder : recorders) {
    recorder->own.reset();
    recorder->value = nullptr;
    recorder->world = nullptr;
  }
}
GyreRecorder::~GyreRecorder() {
  if (world != nullptr) std::erase(world->recorders, this);
}

extern "C" {

const char* gyre_last_error(void) noexcept { return last_error().text.c_str(); }
GyreErrorCode gyre_last_error_code(void) noexcept { return same<GyreErrorCode>(last_error().code); }
const char* gyre_version(void) noexcept { return GYRE_VERSION; }

GyreRecorder* gyre_recorder_create(GyreWorld* world, GyreWriteFunction write, void* user,
                                   const GyreRecordOptions* options) noexcept {
  if (world == nullptr || write == nullptr) {
    refuse_null("gyre_recorder_create");
    return nullptr;
  }
  RecordOptions options_in;
  if (!take_definition(options, options_in, "GyreRecordOptions")) return nullptr;
  auto recorder = std::make_unique<GyreRecorder>();
  recorder->sink.function = write;
  recorder->sink.user = user;
  recorder->value = &recorder->own.emplace(*world->value, recorder->sink, options_in);
  if (recorder->value->failed()) {
    refuse(make_error(ErrorCode::invalid_argument,
                      "record: another recorder records this world, an option is out of range, or nothing "
                      "could be written"));
    return nullptr;
  }
  recorder->world = world;
  world->recorders.push_back(recorder.get());
  return recorder.release();
}

}  // extern "C"
