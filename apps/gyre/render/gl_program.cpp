// Programs for the graphics card. See gl_program.h.
#include "render/gl_program.h"

namespace gyre {
namespace {

std::string compile(GLuint program, GLenum kind, const char* text) {
  const GLuint shader = glCreateShader(kind);
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  GLint good = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
  char log[512] = {};
  if (!good) glGetShaderInfoLog(shader, sizeof log, nullptr, log);
  glAttachShader(program, shader);
  glDeleteShader(shader);
  return good ? std::string() : std::string("a shader is refused: ") + log;
}

}  // namespace

GLuint make_program(const char* vertex, const char* pixel, std::string& error) {
  const GLuint program = glCreateProgram();
  error = compile(program, GL_VERTEX_SHADER, vertex);
  if (error.empty()) error = compile(program, GL_FRAGMENT_SHADER, pixel);
  if (!error.empty()) return program;
  glLinkProgram(program);
  GLint good = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &good);
  if (!good) error = "the shaders cannot be linked";
  return program;
}

}  // namespace gyre
