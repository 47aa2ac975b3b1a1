#include <EGL/egl.h>
#include <GL/gl.h>

#include <string>

#include "egl_displays.hpp"
#include "egl_functions.hpp"
#include "platform_context.hpp"

namespace organ_collision {
namespace {

class EglContext final : public PlatformContext {
 public:
  /// `display` must be initialized. Throws GlError.
  EglContext(EGLDisplay display, const GlFramebuffer& framebuffer) : display_(display) {
    try {
      create(framebuffer);
    } catch (...) {
      destroy();
      throw;
    }
  }
  ~EglContext() override {
    if (is_current()) release();
    destroy();
  }
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  bool is_current() const override { return egl().GetCurrentContext() == context_; }
  bool make_current() override {
    // Which kind of API the thread uses is a state of the thread.
    return egl().BindAPI(EGL_OPENGL_API) == EGL_TRUE &&
           egl().MakeCurrent(display_, surface_, surface_, context_) == EGL_TRUE;
  }
  void release() override {
    egl().MakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  }
  AnyFunction find_function(const char* name) const override { return egl().GetProcAddress(name); }

 private:
  void create(const GlFramebuffer& framebuffer) {
    if (egl().BindAPI(EGL_OPENGL_API) != EGL_TRUE) throw egl_error("EGL has no OpenGL");
    const EGLint wanted[] = {EGL_SURFACE_TYPE,
                             EGL_PBUFFER_BIT,
                             EGL_RENDERABLE_TYPE,
                             EGL_OPENGL_BIT,
                             EGL_RED_SIZE,
                             8,
                             EGL_GREEN_SIZE,
                             8,
                             EGL_BLUE_SIZE,
                             8,
                             EGL_ALPHA_SIZE,
                             8,
                             EGL_DEPTH_SIZE,
                             framebuffer.depth_bits,
                             EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (egl().ChooseConfig(display_, wanted, &config, 1, &count) != EGL_TRUE || count == 0) {
      throw egl_error("EGL has no OpenGL with a framebuffer in memory");
    }
    context_ = egl().CreateContext(display_, config, EGL_NO_CONTEXT, nullptr);
    if (context_ == EGL_NO_CONTEXT) throw egl_error("EGL gives no compatibility context");
    const EGLint size[] = {EGL_WIDTH, framebuffer.width, EGL_HEIGHT, framebuffer.height, EGL_NONE};
    surface_ = egl().CreatePbufferSurface(display_, config, size);
    if (surface_ == EGL_NO_SURFACE) throw egl_error("EGL gives no framebuffer in memory");
    if (!make_current()) throw egl_error("EGL cannot make its context current");
    check_renderer();
  }

  /// Faces are picked with the precision and the speed that are known of Mesa's renderers on the
  /// CPU. Other drivers may implement GL_SELECT and GL_FEEDBACK in other ways, or not at all.
  void check_renderer() {
    const auto get_string = reinterpret_cast<decltype(&glGetString)>(find_function("glGetString"));
    const GLubyte* const name = get_string != nullptr ? get_string(GL_RENDERER) : nullptr;
    const std::string renderer = name != nullptr ? reinterpret_cast<const char*>(name) : "nothing";
    if (renderer.find("llvmpipe") != std::string::npos) return;
    if (renderer.find("softpipe") != std::string::npos) return;
    release();
    throw GlError("EGL draws with \"" + renderer + "\", not with Mesa's llvmpipe on the CPU");
  }

  void destroy() {
    if (surface_ != EGL_NO_SURFACE) egl().DestroySurface(display_, surface_);
    if (context_ != EGL_NO_CONTEXT) egl().DestroyContext(display_, context_);
  }

  EGLDisplay display_;
  EGLContext context_ = EGL_NO_CONTEXT;
  EGLSurface surface_ = EGL_NO_SURFACE;
};

}  // namespace

std::unique_ptr<PlatformContext> new_egl_context(const GlFramebuffer& framebuffer) {
  std::string reason = "EGL knows neither devices without hardware nor a platform without surfaces";
  for (EGLDisplay display : software_displays()) {
    // A display stays initialized until the process ends: others may use the same one.
    if (egl().Initialize(display, nullptr, nullptr) != EGL_TRUE) {
      reason = egl_error("EGL cannot start Mesa's renderer on the CPU").what();
      continue;
    }
    try {
      return std::make_unique<EglContext>(display, framebuffer);
    } catch (const GlError& error) {
      reason = error.what();
    }
  }
  throw GlError(reason);
}

}  // namespace organ_collision
