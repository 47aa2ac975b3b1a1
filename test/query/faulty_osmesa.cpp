// A library that takes the place of OSMesa. It passes all calls on to the real one, and makes
// chosen ones fail.
#include "faulty_osmesa.hpp"

#include <GL/gl.h>
#include <dlfcn.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <cstring>

using faulty_osmesa::Duration;
using faulty_osmesa::Fault;

namespace {

using Context = struct RealContext*;
using AnyFunction = void (*)();

Fault fault = Fault::kNone;
Duration duration = Duration::kOnce;
int calls_before_fault = 0;
int contexts = 0;
bool is_in_faulty_draw = false;
bool is_error_pending = false;
GLfloat* feedback = nullptr;  ///< the buffers that GL writes to
GLuint* hits = nullptr;

void* find(const char* name) {
  static void* const library = dlopen(REAL_OSMESA, RTLD_NOW | RTLD_LOCAL);
  void* const function = library != nullptr ? dlsym(library, name) : nullptr;
  if (function == nullptr) std::abort();
  return function;
}

template <typename Function>
Function* real(const char* name, Function*) {
  return reinterpret_cast<Function*>(find(name));
}

/// Whether the fault befalls this call, of those that it may befall.
bool befalls_now() {
  const int before = calls_before_fault--;
  return before == 0 || (before < 0 && duration == Duration::kForGood);
}

void take_context() {
  using Create = Context(GLenum, GLint, GLint, GLint, Context);
  using MakeCurrent = GLboolean(Context, void*, GLenum, GLsizei, GLsizei);
  static Context const other =
      real("OSMesaCreateContextExt", static_cast<Create*>(nullptr))(GL_RGBA, 0, 0, 0, nullptr);
  static std::array<std::uint8_t, 64> pixels;
  real("OSMesaMakeCurrent", static_cast<MakeCurrent*>(nullptr))(other, pixels.data(),
                                                                GL_UNSIGNED_BYTE, 4, 4);
}

GLint APIENTRY render_mode(GLenum mode) {
  if (mode != GL_RENDER) {
    is_in_faulty_draw = fault != Fault::kStaysAway && befalls_now();
    if (is_in_faulty_draw && fault == Fault::kIsTaken) take_context();
  }
  const GLint count = real("glRenderMode", &glRenderMode)(mode);
  if (mode != GL_RENDER || !is_in_faulty_draw) return count;
  is_in_faulty_draw = false;
  is_error_pending = fault == Fault::kReportsError;
  if (fault == Fault::kReturnsGarbage && count > 0) {
    if (feedback != nullptr) feedback[0] = 0.5F;  // a token
    if (hits != nullptr) hits[3] = 0x7fffffff;    // a face
  }
  return fault == Fault::kReturnsTooMuch ? 1 << 30 : count;
}

void APIENTRY feedback_buffer(GLsizei size, GLenum type, GLfloat* buffer) {
  feedback = buffer;
  hits = nullptr;
  real("glFeedbackBuffer", &glFeedbackBuffer)(size, type, buffer);
}

void APIENTRY select_buffer(GLsizei size, GLuint* buffer) {
  hits = buffer;
  feedback = nullptr;
  real("glSelectBuffer", &glSelectBuffer)(size, buffer);
}

void APIENTRY draw_arrays(GLenum mode, GLint first, GLsizei count) {
  if (is_in_faulty_draw && fault == Fault::kDrawsNothing) return;
  real("glDrawArrays", &glDrawArrays)(mode, first, count);
}

GLenum APIENTRY get_error() {
  if (!is_error_pending) return real("glGetError", &glGetError)();
  is_error_pending = false;
  return GL_OUT_OF_MEMORY;
}

}  // namespace

void faulty_osmesa::befall(Fault its_fault, int number, Duration its_duration) {
  fault = its_fault;
  duration = its_duration;
  calls_before_fault = number;
  is_in_faulty_draw = is_error_pending = false;
}

bool faulty_osmesa::has_befallen() { return calls_before_fault < 0; }

int faulty_osmesa::living_contexts() { return contexts; }

extern "C" {

Context OSMesaCreateContextExt(GLenum format, GLint depth, GLint stencil, GLint accum,
                               Context shared) {
  Context const context = real("OSMesaCreateContextExt", &OSMesaCreateContextExt)(
      format, depth, stencil, accum, shared);
  if (context != nullptr) ++contexts;
  return context;
}

void OSMesaDestroyContext(Context context) {
  if (context != nullptr) --contexts;
  real("OSMesaDestroyContext", &OSMesaDestroyContext)(context);
}

GLboolean OSMesaMakeCurrent(Context context, void* pixels, GLenum type, GLsizei width,
                            GLsizei height) {
  if (context != nullptr && fault == Fault::kStaysAway && befalls_now()) return GL_FALSE;
  return real("OSMesaMakeCurrent", &OSMesaMakeCurrent)(context, pixels, type, width, height);
}

Context OSMesaGetCurrentContext() {
  return real("OSMesaGetCurrentContext", &OSMesaGetCurrentContext)();
}

AnyFunction OSMesaGetProcAddress(const char* name) {
  if (std::strcmp(name, "glRenderMode") == 0) return reinterpret_cast<AnyFunction>(render_mode);
  if (std::strcmp(name, "glFeedbackBuffer") == 0) {
    return reinterpret_cast<AnyFunction>(feedback_buffer);
  }
  if (std::strcmp(name, "glSelectBuffer") == 0) return reinterpret_cast<AnyFunction>(select_buffer);
  if (std::strcmp(name, "glDrawArrays") == 0) return reinterpret_cast<AnyFunction>(draw_arrays);
  if (std::strcmp(name, "glGetError") == 0) return reinterpret_cast<AnyFunction>(get_error);
  return real("OSMesaGetProcAddress", &OSMesaGetProcAddress)(name);
}

}  // extern "C"
