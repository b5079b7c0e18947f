// The programs that run per vertex and per pixel (GLSL 3.30).
#pragma once

namespace gyre {

extern const char* const kShadowVertexShader;
extern const char* const kShadowPixelShader;
extern const char* const kSceneVertexShader;
extern const char* const kScenePixelShader;

}  // namespace gyre
