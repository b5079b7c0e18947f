// The programs that run per vertex and per pixel. See shaders.h.
//
// One sample of the light: the sun, as a point on its disc, and one direction of the sky, each with a shadow map; the mean over
// many samples is a soft shadow and the light of a whole sky. Colours are linear here.
#include "render/shaders.h"

namespace gyre {

const char* const kShadowVertexShader = R"glsl(#version 330 core
layout(location = 0) in vec3 position;
uniform mat4 clip_from_world;
void main() { gl_Position = clip_from_world * vec4(position, 1.0); }
)glsl";

const char* const kShadowPixelShader = R"glsl(#version 330 core
void main() {}
)glsl";

const char* const kSceneVertexShader = R"glsl(#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 color;  // sRGB
layout(location = 3) in uint paint;
uniform mat4 clip_from_world;
out vec3 world_position;
out vec3 world_normal;
out vec3 albedo;
flat out uint painted;
vec3 to_linear(vec3 c) {
  return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), step(0.04045, c));
}
void main() {
  gl_Position = clip_from_world * vec4(position, 1.0);
  world_position = position;
  world_normal = normal;
  albedo = to_linear(color);
  painted = paint;
}
)glsl";

const char* const kScenePixelShader = R"glsl(#version 330 core
in vec3 world_position;
in vec3 world_normal;
in vec3 albedo;
flat in uint painted;
out vec4 result;

uniform vec3 eye;
uniform vec3 sun_direction;  // towards the light, as the sky's
uniform vec3 sky_direction;
uniform vec3 sun_color;
uniform vec3 sky_color;
uniform vec3 bounce_color;
uniform mat4 sun_from_world;  // to 0..1
uniform mat4 sky_from_world;
uniform float sun_texel;  // m
uniform float sky_texel;
uniform sampler2DShadow sun_map;
uniform sampler2DShadow sky_map;
uniform vec3 background_low;  // linear, at the bottom and the top of the picture
uniform vec3 background_high;
uniform float picture_height;
uniform vec3 fade_center;
uniform float fade_near;  // m from the centre: where the ground begins to go over into the background, and where it is gone
uniform float fade_far;
uniform vec3 grid_shift;  // of the world's grid against the origin, m
uniform float grid_cell;  // m
uniform float chance;     // 0 to 1, of this sample: what is to be seen through is drawn in some samples only

// How much of a light reaches the place. The place is moved off its surface by more than a cell of the map, so that no
// surface shadows itself. The maps of the samples are shifted against each other, which smooths the edges of their cells.
float reaches(sampler2DShadow map, mat4 from_world, float texel, vec3 normal, vec3 direction) {
  float slant = 1.0 - clamp(dot(normal, direction), 0.0, 1.0);
  vec3 place = world_position + normal * (texel * (0.8 + 1.8 * slant));
  vec3 spot = (from_world * vec4(place, 1.0)).xyz;
  if (any(lessThan(spot.xy, vec2(0.0))) || any(greaterThan(spot.xy, vec2(1.0)))) return 1.0;
  spot.z = clamp(spot.z, 0.0, 1.0);  // beyond all that casts a shadow is as good as right behind it
  return texture(map, spot);
}

// How much of a line of the grid covers this pixel: the lines are as wide as a pixel, and pale where they crowd.
float line(vec2 place, float cell, float pixels) {
  vec2 at = place / cell;
  vec2 width = max(fwidth(at), vec2(1e-6));
  vec2 away = abs(fract(at - 0.5) - 0.5) / width;
  vec2 cover = clamp(0.5 * pixels + 0.5 - away, 0.0, 1.0) * clamp(0.5 / width - 0.5, 0.0, 1.0);
  return max(cover.x, cover.y);
}

float grid(vec3 place, vec3 normal) {
  vec3 facing = abs(normal);
  vec2 flat_place = facing.y >= facing.x && facing.y >= facing.z ? place.xz : facing.x >= facing.z ? place.yz : place.xy;
  return max(0.10 * line(flat_place, grid_cell, 1.0), 0.22 * line(flat_place, 5.0 * grid_cell, 1.4));
}

void main() {
  vec3 normal = normalize(world_normal);
  if (!gl_FrontFacing) {
    if (painted == 3u) discard;
    normal = -normal;
  }
  if (painted == 4u) {
    result = vec4(albedo, 1.0);
    return;
  }
  float towards_sun = max(dot(normal, sun_direction), 0.0);
  float towards_sky = max(dot(normal, sky_direction), 0.0);
  float sun = towards_sun > 0.0 ? towards_sun * reaches(sun_map, sun_from_world, sun_texel, normal, sun_direction) : 0.0;
  // Directions are evenly spread over the half of all that lies above: twice the mean of the cosine is 1 for what faces up.
  float sky = towards_sky > 0.0 ? 2.0 * towards_sky * reaches(sky_map, sky_from_world, sky_texel, normal, sky_direction) : 0.0;
  vec3 light = sun * sun_color + sky * sky_color + (0.5 - 0.5 * normal.y) * bounce_color;
  vec3 color = albedo * light;
  vec3 background = mix(background_low, background_high, gl_FragCoord.y / picture_height);
  if (painted == 5u) {
    // Reflected light by C. Schlick, "An inexpensive BRDF model for physically-based rendering", 1994.
    float slant = pow(1.0 - clamp(dot(normal, normalize(eye - world_position)), 0.0, 1.0), 5.0);
    if (chance > mix(0.68, 1.0, slant)) discard;
    color = mix(color, background_high, 0.6 * slant);
  }
  if (painted == 0u || painted == 3u || painted == 5u) {
    vec3 half_way = normalize(sun_direction + normalize(eye - world_position));
    float gloss = pow(max(dot(normal, half_way), 0.0), 60.0);
    color += (painted == 3u ? 0.05 : 0.25) * gloss * (towards_sun > 0.0 ? sun / towards_sun : 0.0) * sun_color;
  } else {
    if (painted == 1u) color *= 1.0 - grid(world_position + grid_shift, normal);
    color = mix(color, background, smoothstep(fade_near, fade_far, distance(world_position, fade_center)));
  }
  result = vec4(color, 1.0);
}
)glsl";

}  // namespace gyre
