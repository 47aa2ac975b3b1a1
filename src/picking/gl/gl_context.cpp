#include "gl_context.hpp"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "picking/volumes/viewing_volume.hpp"

namespace organ_collision {

AnyGlFunction find_gl_function(const PlatformContext& context, const char* name) {
  const AnyGlFunction function = context.find_function(name);
  if (function == nullptr) throw GlError(std::string("OpenGL has no function ") + name);
  return function;
}

GlFunctions load_gl_functions(const PlatformContext& context) {
  GlFunctions functions;
#define ORGAN_COLLISION_LOAD(name) \
  functions.name =                 \
      reinterpret_cast<decltype(functions.name)>(find_gl_function(context, "gl" #name));
  ORGAN_COLLISION_GL_FUNCTIONS(ORGAN_COLLISION_LOAD)
#undef ORGAN_COLLISION_LOAD
  return functions;
}

namespace {

struct Source {
  GlPlatform platform;
  const char* name;
  std::unique_ptr<PlatformContext> (*create)(const GlFramebuffer&);
};

constexpr std::array<Source, 2> kSources = {{{GlPlatform::kOsmesa, "OSMesa", new_osmesa_context},
                                             {GlPlatform::kEgl, "EGL", new_egl_context}}};

// What this package has made current last in this thread. Platforms do not know of each other: EGL
// says that its context is current even if OSMesa's has taken its place.
thread_local const PlatformContext* latest = nullptr;

/// Throws GlError if the environment names a driver that Mesa does not know as one for the CPU.
/// OSMesa would end the process, and EGL would give no reason.
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
  // EGL does nothing for a context that it takes for current.
  if (context.is_current()) context.release();
  latest = &context;
  return context.make_current();
}

}  // namespace

struct GlContext::State {
  explicit State(const Source& source, const GlFramebuffer& framebuffer);

  std::unique_ptr<PlatformContext> context;
  GlFunctions functions;
};

/// Leaves the context current. Throws GlError if it does not work.
GlContext::State::State(const Source& source, const GlFramebuffer& framebuffer)
    : context(source.create(framebuffer)) {
  if (!make_latest(*context)) throw GlError("the new context cannot be made current");
  functions = load_gl_functions(*context);
  if (functions.GetString(GL_VERSION) == nullptr) {
    throw GlError(
        "OpenGL gives no version string, so its calls do nothing: another OpenGL library took its "
        "place; start this process without preloading libGL");
  }
  // They stay enabled, because each switch costs as much time as a face.
  functions.EnableClientState(GL_VERTEX_ARRAY);
  functions.EnableClientState(GL_TEXTURE_COORD_ARRAY);
  for (GLenum i = 0; i < ViewingVolume::kMaxUserPlanes; ++i) functions.Enable(GL_CLIP_PLANE0 + i);
}

GlContext::GlContext(GlPlatform platform, const GlFramebuffer& framebuffer)
    : platform_(platform), framebuffer_(framebuffer) {
  make();
}

GlContext::~GlContext() = default;
GlContext::GlContext(GlContext&&) noexcept = default;
GlContext& GlContext::operator=(GlContext&&) noexcept = default;

/// Makes a context of the first platform whose contexts work.
void GlContext::make() {
  check_driver();
  std::string reasons;
  for (const Source& source : kSources) {
    if (platform_ != GlPlatform::kAuto && platform_ != source.platform) continue;
    try {
      state_ = std::make_unique<State>(source, framebuffer_);
      const GLubyte* const version = functions().GetString(GL_VERSION);
      version_ = std::string(reinterpret_cast<const char*>(version)) + " on " + source.name;
      has_failed_ = false;
      return;
    } catch (const GlError& error) {
      reasons += std::string(source.name) + ": " + error.what() + "; ";
    }
  }
  throw GlError("OpenGL gives no context to pick with: " + reasons +
                "install libosmesa6 (Mesa before 25.1), or libegl1 with Mesa's drivers, or pick "
                "without OpenGL (picker: cpu)");
}

bool GlContext::is_current() const {
  return latest == state_->context.get() && state_->context->is_current();
}

void GlContext::make_current() {
  if (has_failed_) {
    make();
  } else if (!is_current() && !make_latest(*state_->context)) {
    fail("OpenGL cannot make its context current: is it current in another thread?");
  }
}

void GlContext::release() {
  // Even if another one has taken its place: EGL gives no other thread what it takes for current.
  if (state_->context->is_current()) state_->context->release();
}

const GlFunctions& GlContext::functions() const { return state_->functions; }

AnyGlFunction GlContext::find_function(const char* name) const {
  return find_gl_function(*state_->context, name);
}

void GlContext::check(const char* where) {
  const GLenum error = state_->functions.GetError();
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
