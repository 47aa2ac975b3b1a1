#include "gl_context.hpp"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "picking/volumes/viewing_volume.hpp"

namespace organ_collision {
namespace {

// The context that this package has made current last in this thread. Platforms do not know of each
// other: EGL says that its context is current even if a context of OSMesa has replaced it.
thread_local const PlatformContext* latest = nullptr;

/// Throws GlError if GALLIUM_DRIVER names another driver than Mesa's two for the CPU. Without this
/// check, OSMesa would end the process, and EGL would fail without a reason.
void check_driver() {
  const char* const driver = std::getenv("GALLIUM_DRIVER");
  if (driver == nullptr) return;
  for (const char* const legal : {"", "llvmpipe", "softpipe"}) {
    if (std::strcmp(driver, legal) == 0) return;
  }
  throw GlError(
      std::string("the environment variable GALLIUM_DRIVER is \"") + driver +
      "\": must be \"llvmpipe\" or \"softpipe\", which draw on the CPU, or not be set; or "
      "pick without OpenGL (picker: cpu)");
}

bool make_latest(PlatformContext& context) {
  // Otherwise EGL would do nothing for a context that it believes to be current.
  if (context.is_current()) context.release();
  latest = &context;
  return context.make_current();
}

/// Loads all functions. Throws GlError that names the first missing one.
GlFunctions load_functions(const PlatformContext& context) {
  GlFunctions functions;
#define ORGAN_COLLISION_LOAD(name)                                                                \
  functions.name = reinterpret_cast<decltype(functions.name)>(context.find_function("gl" #name)); \
  if (functions.name == nullptr) throw GlError("OpenGL has no function gl" #name);
  ORGAN_COLLISION_GL_FUNCTIONS(ORGAN_COLLISION_LOAD)
#undef ORGAN_COLLISION_LOAD
  return functions;
}

}  // namespace

GlContext::GlContext(GlPlatform platform) : platform_(platform) { make(); }

/// Makes a context of the first platform that gives a context which works.
void GlContext::make() {
  check_driver();
  std::string reasons;
  for (const GlPlatform platform : {GlPlatform::kOsmesa, GlPlatform::kEgl}) {
    if (platform_ != GlPlatform::kAuto && platform_ != platform) continue;
    const bool is_osmesa = platform == GlPlatform::kOsmesa;
    const char* const name = is_osmesa ? "OSMesa" : "EGL";
    try {
      return take(is_osmesa ? new_osmesa_context() : new_egl_context(), name);
    } catch (const GlError& error) {
      reasons += std::string(name) + ": " + error.what() + "; ";
    }
  }
  throw GlError("OpenGL gives no context to pick with: " + reasons +
                "install libosmesa6 (Mesa before 25.1), or libegl1 with Mesa's drivers, or pick "
                "without OpenGL (picker: cpu)");
}

/// Takes over a new context and leaves it current. If it does not work, throws GlError and changes
/// nothing in this object.
void GlContext::take(std::unique_ptr<PlatformContext> context, const char* platform) {
  if (!make_latest(*context)) throw GlError("the new context cannot be made current");
  const GlFunctions gl = load_functions(*context);
  const GLubyte* const version = gl.GetString(GL_VERSION);
  if (version == nullptr) {
    throw GlError(
        "OpenGL gives no version string, so its calls do nothing: another OpenGL library took its "
        "place; start this process without preloading libGL");
  }
  // Arrays and planes stay enabled, because each switch costs as much time as a face.
  gl.EnableClientState(GL_VERTEX_ARRAY);
  gl.EnableClientState(GL_TEXTURE_COORD_ARRAY);
  for (GLenum i = 0; i < ViewingVolume::kMaxUserPlanes; ++i) gl.Enable(GL_CLIP_PLANE0 + i);
  version_ = std::string(reinterpret_cast<const char*>(version)) + " on " + platform;
  context_ = std::move(context);
  functions_ = gl;
  has_failed_ = false;
}

bool GlContext::is_current() const { return latest == context_.get() && context_->is_current(); }

void GlContext::make_current() {
  if (has_failed_) {
    make();
  } else if (!is_current() && !make_latest(*context_)) {
    fail("OpenGL cannot make its context current: is it current in another thread?");
  }
}

void GlContext::release() {
  // Release it even if another context has replaced it: EGL gives no other thread a context that it
  // believes to be current.
  if (context_->is_current()) context_->release();
}

void GlContext::check(const char* where) {
  const GLenum error = functions_.GetError();
  if (error == GL_NO_ERROR) return;
  std::array<char, 16> code{};
  std::snprintf(code.data(), code.size(), "0x%04x", error);
  fail(std::string("OpenGL error ") + code.data() + " in " + where);
}

void GlContext::fail(const std::string& what) {
  has_failed_ = true;
  throw GlError(what);
}

}  // namespace organ_collision
