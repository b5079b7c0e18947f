// Draws smoke. See smoke_painter.h.
#include "render/smoke_painter.h"

#include "render/gl_program.h"
#include "render/picture.h"

#include <algorithm>

namespace gyre {
namespace {

const char* const kSmokeVertexShader = R"glsl(#version 330 core
layout(location = 0) in vec3 position;
uniform mat4 clip_from_world;
uniform vec3 low;
uniform vec3 size;
out vec3 cell;
out vec3 world_position;
void main() {
  cell = (position - low) / size;
  world_position = position;
  gl_Position = clip_from_world * vec4(position, 1.0);
}
)glsl";

// Smoke takes light on the way to the eye and gives back what of the sun and the sky reaches it. Warm gas glows. The result is multiplied
// with its share of the pixel already.
const char* const kSmokePixelShader = R"glsl(#version 330 core
in vec3 cell;
in vec3 world_position;
out vec4 result;
uniform sampler3D voxels;
uniform sampler2DShadow sun_map;
uniform mat4 sun_from_world;  // to 0..1
uniform vec3 color;           // linear
uniform vec3 sun_color;
uniform vec3 sky_color;
uniform vec3 eye;
uniform vec3 forward;
uniform float extinction;  // 1/m
uniform float thickness;   // m, along the view
void main() {
  vec4 here = texture(voxels, cell);
  vec3 way = world_position - eye;
  float length_here = thickness * length(way) / max(dot(way, forward), 1e-6);
  float covers = 1.0 - exp(-extinction * length_here * (here.r + 0.1 * here.g));
  if (covers < 0.001) discard;
  vec3 spot = (sun_from_world * vec4(world_position, 1.0)).xyz;
  bool known = all(greaterThanEqual(spot, vec3(0.0))) && all(lessThanEqual(spot, vec3(1.0)));
  float reaches = known ? texture(sun_map, spot) : 1.0;
  vec3 smoke = mix(color, vec3(1.0, 0.42, 0.12), 0.8 * here.g);
  vec3 light = smoke * (sky_color + here.b * reaches * sun_color) + here.g * here.g * vec3(0.55, 0.2, 0.03);
  result = covers * vec4(light, 1.0);
}
)glsl";

}  // namespace

std::string SmokePainter::create() {
  std::string error;
  program_ = make_program(kSmokeVertexShader, kSmokePixelShader, error);
  glGenVertexArrays(1, &vertex_array_);
  glGenBuffers(1, &vertices_);
  return error;
}

void SmokePainter::set(std::vector<SmokeVolume> volumes, Vec3 sun) {
  volumes_ = std::move(volumes);
  const auto before = GLsizei(textures_.size());
  if (before > 0) glDeleteTextures(before, textures_.data());
  textures_.resize(volumes_.size());
  if (volumes_.empty()) return;
  glGenTextures(GLsizei(textures_.size()), textures_.data());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  for (std::size_t i = 0; i < volumes_.size(); ++i) {
    light_smoke(volumes_[i], sun);
    glBindTexture(GL_TEXTURE_3D, textures_[i]);
    for (const GLenum filter : {GLenum(GL_TEXTURE_MIN_FILTER), GLenum(GL_TEXTURE_MAG_FILTER)})
      glTexParameteri(GL_TEXTURE_3D, filter, GL_LINEAR);
    for (const GLenum side :
         {GLenum(GL_TEXTURE_WRAP_S), GLenum(GL_TEXTURE_WRAP_T), GLenum(GL_TEXTURE_WRAP_R)})
      glTexParameteri(GL_TEXTURE_3D, side, GL_CLAMP_TO_EDGE);
    const std::array<int, 3>& cells = volumes_[i].cells;
    glTexImage3D(GL_TEXTURE_3D, 0, GL_RGBA8, cells[0], cells[1], cells[2], 0, GL_RGBA, GL_UNSIGNED_BYTE,
                 volumes_[i].voxels.data());
  }
}

void SmokePainter::draw(const Mat4& clip, Vec3 eye, Vec3 forward, const SmokeLight& light, int slices,
                        float shift) const {
  const auto place = [&](const char* name) { return glGetUniformLocation(program_, name); };
  const auto set = [&](const char* name, Vec3 value) { glUniform3f(place(name), value.x, value.y, value.z); };
  glUseProgram(program_);
  glBindVertexArray(vertex_array_);
  glBindBuffer(GL_ARRAY_BUFFER, vertices_);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(Vec3), nullptr);
  glEnableVertexAttribArray(0);
  glUniformMatrix4fv(place("clip_from_world"), 1, GL_FALSE, clip.elements);
  glUniformMatrix4fv(place("sun_from_world"), 1, GL_FALSE, light.sun_from_world.elements);
  set("sun_color", light.sun);
  set("sky_color", light.sky);
  set("eye", eye);
  set("forward", forward);
  glUniform1i(place("voxels"), 2);
  glUniform1i(place("sun_map"), 0);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, light.sun_map);
  glActiveTexture(GL_TEXTURE2);
  glDepthMask(GL_FALSE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  for (std::size_t i = 0; i < volumes_.size(); ++i) {
    const SmokeVolume& volume = volumes_[i];
    const SmokeSlices cut = cut_smoke(volume.box, eye, forward, slices, shift);
    glBindTexture(GL_TEXTURE_3D, textures_[i]);
    set("low", volume.box.low);
    set("size", volume.box.high - volume.box.low);
    set("color",
        {linear_light(volume.color.red), linear_light(volume.color.green), linear_light(volume.color.blue)});
    glUniform1f(place("extinction"), volume.extinction);
    glUniform1f(place("thickness"), cut.thickness);
    glBufferData(GL_ARRAY_BUFFER, GLsizeiptr(cut.triangles.size() * sizeof(Vec3)), cut.triangles.data(),
                 GL_STREAM_DRAW);
    glDrawArrays(GL_TRIANGLES, 0, GLsizei(cut.triangles.size()));
  }
  glDisable(GL_BLEND);
  glDepthMask(GL_TRUE);
}

}  // namespace gyre
