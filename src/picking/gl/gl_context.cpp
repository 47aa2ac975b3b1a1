#include "gl_context.hpp"

#include <GL/osmesa.h>

#include <cstdio>
#include <vector>

#include "gl_functions.hpp"
#include "picking/volumes/viewing_volume.hpp"

namespace organ_collision {

struct GlContext::State {
  OSMesaContext context;
  int width, height;
  std::vector<std::uint8_t> pixels;
  GlFunctions functions;
  std::string version;

  explicit State(const GlFramebuffer& framebuffer)
      : context(OSMesaCreateContextExt(OSMESA_RGBA, framebuffer.depth_bits, 0, 0, nullptr)),
        width(framebuffer.width),
        height(framebuffer.height),
        pixels(std::size_t{4} * width * height) {}
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() {
    if (context == nullptr) return;
    release();
    OSMesaDestroyContext(context);
  }

  bool is_current() const { return OSMesaGetCurrentContext() == context; }

  void release() {
    if (is_current()) OSMesaMakeCurrent(nullptr, nullptr, GL_UNSIGNED_BYTE, 0, 0);
  }
};

GlContext::GlContext(const GlFramebuffer& framebuffer)
    : state_(std::make_unique<State>(framebuffer)) {
  if (state_->context == nullptr) {
    throw GlError("OSMesa gives no compatibility context: install libosmesa6 (Mesa before 25.1)");
  }
  make_current();
  state_->functions = load_gl_functions();
  const GLubyte* version = state_->functions.GetString(GL_VERSION);
  if (version == nullptr) {
    throw GlError(
        "OpenGL gives no version string, so its calls do nothing: another OpenGL library took "
        "OSMesa's place; install libosmesa6 and start this process without preloading libGL");
  }
  state_->version = reinterpret_cast<const char*>(version);
  // They stay enabled, because each switch costs as much time as a face.
  state_->functions.EnableClientState(GL_VERTEX_ARRAY);
  state_->functions.EnableClientState(GL_TEXTURE_COORD_ARRAY);
  for (GLenum i = 0; i < ViewingVolume::kMaxUserPlanes; ++i)
    state_->functions.Enable(GL_CLIP_PLANE0 + i);
}

GlContext::~GlContext() = default;
GlContext::GlContext(GlContext&&) noexcept = default;
GlContext& GlContext::operator=(GlContext&&) noexcept = default;

void GlContext::make_current() {
  if (state_->is_current()) return;
  if (OSMesaMakeCurrent(state_->context, state_->pixels.data(), GL_UNSIGNED_BYTE, state_->width,
                        state_->height) != GL_TRUE) {
    throw GlError("OSMesa cannot make its context current: is it current in another thread?");
  }
}

void GlContext::release() { state_->release(); }

const std::string& GlContext::version() const { return state_->version; }

const GlFunctions& GlContext::functions() const { return state_->functions; }

const std::uint8_t* GlContext::pixels() const { return state_->pixels.data(); }

void GlContext::check(const char* where) const {
  const GLenum error = state_->functions.GetError();
  if (error == GL_NO_ERROR) return;
  char code[16];
  std::snprintf(code, sizeof code, "0x%04x", error);
  throw GlError(std::string("OpenGL error ") + code + " in " + where);
}

}  // namespace organ_collision
