// Draws a list of triangles. See renderer.h.
#include "render/renderer.h"

#include "render/gl_program.h"
#include "render/light_samples.h"
#include "render/shaders.h"
#include "render/smoke_painter.h"
#include "formats/turning.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

namespace gyre {
namespace {

constexpr Vec3 kSunColor{1.06f, 1.02f, 0.95f};
constexpr Vec3 kSkyColor{0.37f, 0.40f, 0.44f};
constexpr Vec3 kBounceColor{0.17f, 0.165f, 0.16f};
constexpr std::uint8_t kBackgroundLow[] = {238, 241, 244}, kBackgroundHigh[] = {205, 217, 230};
constexpr float kSunRise = 0.9f;      // rad above the horizon
constexpr float kSunAside = -0.85f;   // rad from the camera's azimuth
constexpr float kGlassShare = 0.22f;  // of the samples show what can be seen through

Vec3 light_of(const std::uint8_t (&color)[3]) {
  return {linear_light(color[0]), linear_light(color[1]), linear_light(color[2])};
}

// A depth texture to draw into and to compare with.
struct ShadowMap {
  GLuint texture = 0, target = 0;
  int size = 0;

  void create(int cells) {
    size = cells;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT32F, size, size, 0, GL_DEPTH_COMPONENT, GL_FLOAT,
                 nullptr);
    for (const GLenum filter : {GLenum(GL_TEXTURE_MIN_FILTER), GLenum(GL_TEXTURE_MAG_FILTER)}) {
      glTexParameteri(GL_TEXTURE_2D, filter, GL_LINEAR);
    }
    for (const GLenum side : {GLenum(GL_TEXTURE_WRAP_S), GLenum(GL_TEXTURE_WRAP_T)}) {
      glTexParameteri(GL_TEXTURE_2D, side, GL_CLAMP_TO_EDGE);
    }
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
    glGenFramebuffers(1, &target);
    glBindFramebuffer(GL_FRAMEBUFFER, target);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, texture, 0);
    glDrawBuffer(GL_NONE);
    glReadBuffer(GL_NONE);
  }
};

// A light's way to its shadow map.
struct LightView {
  Vec3 direction;
  Mat4 clip_from_world, map_from_world;
  float texel = 0;  // m
};

// `shift`: by how much of a cell, -1 to 1, the map is moved.
LightView view_from(Vec3 direction, const Aabb& casters, int cells, float shift_x, float shift_y) {
  const CameraAxes axes = axes_towards(direction);
  // A little more than the casters, so that none of them lies on the edge.
  Aabb bounds = box_along(axes, casters);
  bounds = grow(bounds, 0.01f * largest(bounds.high - bounds.low));
  const Vec3 size = (1.0f / float(cells)) * (bounds.high - bounds.low);
  const Vec3 shift{shift_x * size.x, shift_y * size.y, 0};
  bounds = {bounds.low + shift, bounds.high + shift};
  LightView view;
  view.direction = direction;
  view.clip_from_world = shadow_matrix(axes, bounds);
  view.map_from_world = view.clip_from_world;
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 3; ++row) {
      float& element = view.map_from_world.elements[4 * column + row];
      element = 0.5f * element + (column == 3 ? 0.5f : 0.0f);
    }
  }
  view.texel = max(bounds.high.x - bounds.low.x, bounds.high.y - bounds.low.y) / float(cells);
  return view;
}

// Cells of 1, 2 or 5 times a power of ten, about a tenth of the subject.
float grid_cell_for(float radius) {
  float cell = 1e-4f;
  constexpr float kSteps[] = {2.0f, 2.5f, 2.0f};
  for (int i = 0; cell < 0.11f * radius && i < 60; ++i) cell *= kSteps[i % 3];
  return cell;
}

}  // namespace

struct Renderer::Gl {
  std::unique_ptr<GlContext> context;
  int width = 0, height = 0, samples = 1;
  GLuint shadow_program = 0, scene_program = 0;
  GLuint target = 0, color = 0, depth = 0;
  GLuint vertex_array = 0, vertices = 0, indices = 0;
  ShadowMap sun_map, sky_map;
  std::optional<Vec3> sun;
  SmokePainter smoke;
  std::vector<float> sums, sample;

  std::string create();
  void upload(const DrawList& list);
  void draw_shadows(const ShadowMap& map, const LightView& view, std::size_t solid) const;
  void set_scene(const Camera& camera, const Subject& subject) const;
  void draw_scene(const Mat4& clip, const LightView& sun_view, const LightView& sky_view) const;
  void draw_smoke(const Mat4& clip, const Camera& camera, const Subject& subject, const LightView& sun_view,
                  float chance) const;
  void add_sample();
  GLint place(const char* name) const { return glGetUniformLocation(scene_program, name); }
  void set(const char* name, float value) const { glUniform1f(place(name), value); }
  void set(const char* name, Vec3 value) const { glUniform3f(place(name), value.x, value.y, value.z); }
  void set(const char* name, const Mat4& value) const {
    glUniformMatrix4fv(place(name), 1, GL_FALSE, value.elements);
  }
};

std::string Renderer::Gl::create() {
  GLint largest = 0;
  glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &largest);
  if (width > largest || height > largest)
    return "OpenGL draws at most " + std::to_string(largest) + " pixels a side";
  std::string error;
  shadow_program = make_program(kShadowVertexShader, kShadowPixelShader, error);
  if (error.empty()) scene_program = make_program(kSceneVertexShader, kScenePixelShader, error);
  if (error.empty()) error = smoke.create();
  if (!error.empty()) return error;
  const bool large = std::int64_t(width) * height > 300'000;
  sun_map.create(large ? 2048 : 1024);
  sky_map.create(large ? 1024 : 512);

  glGenRenderbuffers(1, &color);
  glBindRenderbuffer(GL_RENDERBUFFER, color);
  glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA32F, width, height);
  glGenRenderbuffers(1, &depth);
  glBindRenderbuffer(GL_RENDERBUFFER, depth);
  glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT32F, width, height);
  glGenFramebuffers(1, &target);
  glBindFramebuffer(GL_FRAMEBUFFER, target);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, color);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    return "OpenGL has no target of floats";

  glGenVertexArrays(1, &vertex_array);
  glBindVertexArray(vertex_array);
  glGenBuffers(1, &vertices);
  glGenBuffers(1, &indices);
  glBindBuffer(GL_ARRAY_BUFFER, vertices);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices);
  const auto at = [](std::size_t offset) { return reinterpret_cast<const void*>(offset); };
  constexpr GLsizei kStride = sizeof(DrawVertex);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, kStride, at(offsetof(DrawVertex, position)));
  glVertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, kStride, at(offsetof(DrawVertex, normal)));
  glVertexAttribPointer(2, 3, GL_UNSIGNED_BYTE, GL_TRUE, kStride, at(offsetof(DrawVertex, color)));
  glVertexAttribIPointer(3, 1, GL_UNSIGNED_BYTE, kStride, at(offsetof(DrawVertex, paint)));
  for (GLuint i = 0; i < 4; ++i) glEnableVertexAttribArray(i);
  glEnable(GL_DEPTH_TEST);
  return glGetError() == GL_NO_ERROR ? std::string() : "OpenGL refuses its set-up";
}

void Renderer::Gl::upload(const DrawList& list) {
  glBufferData(GL_ARRAY_BUFFER, GLsizeiptr(list.vertices.size() * sizeof(DrawVertex)), list.vertices.data(),
               GL_STREAM_DRAW);
  std::vector<std::uint32_t> all = list.solid;
  all.insert(all.end(), list.ground.begin(), list.ground.end());
  all.insert(all.end(), list.shadowless.begin(), list.shadowless.end());
  all.insert(all.end(), list.glass.begin(), list.glass.end());
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, GLsizeiptr(all.size() * sizeof all[0]), all.data(), GL_STREAM_DRAW);
}

void Renderer::Gl::draw_shadows(const ShadowMap& map, const LightView& view, std::size_t solid) const {
  glBindFramebuffer(GL_FRAMEBUFFER, map.target);
  glViewport(0, 0, map.size, map.size);
  glClear(GL_DEPTH_BUFFER_BIT);
  glUseProgram(shadow_program);
  glUniformMatrix4fv(glGetUniformLocation(shadow_program, "clip_from_world"), 1, GL_FALSE,
                     view.clip_from_world.elements);
  glDrawElements(GL_TRIANGLES, GLsizei(solid), GL_UNSIGNED_INT, nullptr);
}

// What is the same for all samples of a picture.
void Renderer::Gl::set_scene(const Camera& camera, const Subject& subject) const {
  glUseProgram(scene_program);
  set("eye", difference(camera.eye, subject.origin));
  set("sun_color", kSunColor);
  set("sky_color", kSkyColor);
  set("bounce_color", kBounceColor);
  set("background_low", light_of(kBackgroundLow));
  set("background_high", light_of(kBackgroundHigh));
  set("picture_height", float(height));
  set("fade_center", Vec3{});
  set("fade_near", 2.5f * subject.radius);
  set("fade_far", 14.0f * subject.radius);
  const float cell = grid_cell_for(subject.radius);
  const double period = 5.0 * double(cell);
  const auto shift = [&](double place) { return float(place - period * std::floor(place / period)); };
  set("grid_shift", Vec3{shift(subject.origin.x), shift(subject.origin.y), shift(subject.origin.z)});
  set("grid_cell", cell);
  glUniform1i(place("sun_map"), 0);
  glUniform1i(place("sky_map"), 1);
}

void Renderer::Gl::draw_scene(const Mat4& clip, const LightView& sun_view, const LightView& sky_view) const {
  glUseProgram(scene_program);
  set("clip_from_world", clip);
  set("sun_direction", sun_view.direction);
  set("sky_direction", sky_view.direction);
  set("sun_from_world", sun_view.map_from_world);
  set("sky_from_world", sky_view.map_from_world);
  set("sun_texel", sun_view.texel);
  set("sky_texel", sky_view.texel);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, sun_map.texture);
  glActiveTexture(GL_TEXTURE1);
  glBindTexture(GL_TEXTURE_2D, sky_map.texture);
}

// The more samples a picture has, the fewer slices each of them needs, as they lie elsewhere in each.
void Renderer::Gl::draw_smoke(const Mat4& clip, const Camera& camera, const Subject& subject,
                              const LightView& sun_view, float chance) const {
  const SmokeLight light{0.5f * kSunColor, 0.45f * kSkyColor, sun_view.map_from_world, sun_map.texture};
  const int slices = std::clamp(256 / samples, 20, 96);
  smoke.draw(clip, difference(camera.eye, subject.origin), -axes_of(camera).back, light, slices, chance);
  glBindVertexArray(vertex_array);
  glBindBuffer(GL_ARRAY_BUFFER, vertices);
}

// Where nothing was drawn, and behind smoke, there is the background, from the bottom to the top of the picture as in the shader.
void Renderer::Gl::add_sample() {
  const Vec3 low = light_of(kBackgroundLow), high = light_of(kBackgroundHigh);
  for (int row = 0; row < height; ++row) {
    const Vec3 background = lerp(low, high, (float(row) + 0.5f) / float(height));
    const std::size_t first = 4 * std::size_t(row) * std::size_t(width);
    for (std::size_t k = first; k < first + 4 * std::size_t(width); k += 4) {
      const float clear = 1.0f - sample[k + 3];
      for (int part = 0; part < 3; ++part)
        sums[k + std::size_t(part)] += sample[k + std::size_t(part)] + clear * background[part];
    }
  }
}

Renderer::Renderer(std::unique_ptr<Gl> gl) : gl_(std::move(gl)) {}
Renderer::~Renderer() = default;

std::unique_ptr<Renderer> Renderer::create(int width, int height, int samples, std::string& error) {
  auto gl = std::make_unique<Gl>();
  gl->context = GlContext::create(error);
  if (!gl->context) return nullptr;
  gl->width = width;
  gl->height = height;
  gl->samples = samples;
  error = gl->create();
  if (!error.empty()) {
    error = "no picture can be drawn here: " + error;
    return nullptr;
  }
  const std::size_t floats = 4 * std::size_t(width) * std::size_t(height);
  gl->sums.resize(floats);
  gl->sample.resize(floats);
  return std::unique_ptr<Renderer>(new Renderer(std::move(gl)));
}

Picture Renderer::draw(const DrawList& list, const Camera& camera, const Subject& subject) {
  Gl& gl = *gl_;
  gl.upload(list);
  Aabb casters{};
  bool any = false;
  for (const std::uint32_t index : list.solid) {
    const Vec3 p = list.vertices[index].position;
    casters = any ? Aabb{min(casters.low, p), max(casters.high, p)} : Aabb{p, p};
    any = true;
  }
  const Vec3 back = axes_of(camera).back;
  if (!gl.sun) {
    const float azimuth = gyre::atan2(back.x, back.z) + kSunAside;
    const Turn turn = turn_of(azimuth), rise = turn_of(kSunRise);
    gl.sun = Vec3{rise.cosine * turn.sine, rise.sine, rise.cosine * turn.cosine};
  }
  const float away = float(length(camera.eye - subject.origin));
  const ClipRange range{0.02f * away, away + 100.0f * subject.radius};
  gl.set_scene(camera, subject);
  gl.smoke.set(list.smoke, *gl.sun);
  std::fill(gl.sums.begin(), gl.sums.end(), 0.0f);
  for (int i = 0; i < gl.samples; ++i) {
    const LightSample light = light_sample(i, gl.samples, *gl.sun);
    const LightView sun = view_from(light.sun, casters, gl.sun_map.size, light.pixel_x, light.pixel_y);
    const LightView sky = view_from(light.sky, casters, gl.sky_map.size, light.pixel_y, light.pixel_x);
    gl.draw_shadows(gl.sun_map, sun, list.solid.size());
    gl.draw_shadows(gl.sky_map, sky, list.solid.size());
    glBindFramebuffer(GL_FRAMEBUFFER, gl.target);
    glViewport(0, 0, gl.width, gl.height);
    glClear(GL_DEPTH_BUFFER_BIT | GL_COLOR_BUFFER_BIT);
    const Mat4 clip = clip_matrix(camera, subject.origin, range, light.pixel_x, light.pixel_y);
    gl.draw_scene(clip, sun, sky);
    gl.set("chance", light.chance);
    std::size_t count = list.solid.size() + list.ground.size() + list.shadowless.size();
    if (light.chance < kGlassShare) count += list.glass.size();
    glDrawElements(GL_TRIANGLES, GLsizei(count), GL_UNSIGNED_INT, nullptr);
    if (!gl.smoke.empty()) gl.draw_smoke(clip, camera, subject, sun, light.chance);
    glReadPixels(0, 0, gl.width, gl.height, GL_RGBA, GL_FLOAT, gl.sample.data());
    gl.add_sample();
  }
  return develop(gl.sums, gl.width, gl.height, gl.samples);
}

}  // namespace gyre
