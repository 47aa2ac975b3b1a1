#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/gl.h>
#include <dlfcn.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "gl_context.hpp"

// All EGL functions that this file calls, without the prefix egl.
// clang-format off
#define ORGAN_COLLISION_EGL_FUNCTIONS(F)                                                    \
  F(BindAPI) F(ChooseConfig) F(CreateContext) F(CreatePbufferSurface) F(DestroyContext)     \
  F(DestroySurface) F(GetCurrentContext) F(GetError) F(GetProcAddress) F(Initialize)        \
  F(MakeCurrent)
// clang-format on

namespace organ_collision {
namespace {

/// A shared library that is loaded when it is first needed, so that the package builds and runs
/// without it. It stays loaded until the process ends: Mesa does not survive being unloaded.
class SharedLibrary {
 public:
  /// Loads the library of this name, for example "libEGL.so.1". Throws GlError with the reason.
  explicit SharedLibrary(const char* name)
      : name_(name), handle_(dlopen(name, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE)) {
    if (handle_ == nullptr) throw GlError(dlerror());
  }

  /// Sets `function` to the library's function `name`. Throws GlError if there is none.
  template <typename Function>
  void load(const char* name, Function*& function) const {
    function = reinterpret_cast<Function*>(dlsym(handle_, name));
    if (function == nullptr) throw GlError(std::string(name_) + " has no function " + name);
  }

 private:
  const char* name_;
  void* handle_;
};

/// The functions of libOSMesa that this file calls, as in GL/osmesa.h. They are declared here
/// because systems without OSMesa do not have that header.
struct OsmesaFunctions {
  using Context = struct OsmesaContextHandle*;  // opaque

  OsmesaFunctions() {
    const SharedLibrary library("libOSMesa.so.8");
    library.load("OSMesaCreateContextExt", create_context);
    library.load("OSMesaDestroyContext", destroy_context);
    library.load("OSMesaMakeCurrent", make_current);
    library.load("OSMesaGetCurrentContext", current_context);
    library.load("OSMesaGetProcAddress", find_function);
  }

  Context (*create_context)(GLenum format, GLint depth_bits, GLint stencil_bits, GLint accum_bits,
                            Context shared);
  void (*destroy_context)(Context context);
  GLboolean (*make_current)(Context context, void* pixels, GLenum type, GLsizei width,
                            GLsizei height);
  Context (*current_context)();
  PlatformContext::AnyFunction (*find_function)(const char* name);
};

const OsmesaFunctions& osmesa() {
  static const OsmesaFunctions functions;
  return functions;
}

class OsmesaContext final : public PlatformContext {
 public:
  OsmesaContext() : context_(osmesa().create_context(GL_RGBA /* OSMESA_RGBA */, 0, 0, 0, nullptr)) {
    if (context_ == nullptr) throw GlError("OSMesa gives no compatibility context");
  }
  ~OsmesaContext() override {
    if (is_current()) release();
    osmesa().destroy_context(context_);
  }
  OsmesaContext(const OsmesaContext&) = delete;
  OsmesaContext& operator=(const OsmesaContext&) = delete;

  bool is_current() const override { return osmesa().current_context() == context_; }
  bool make_current() override {
    return osmesa().make_current(context_, pixels_.data(), GL_UNSIGNED_BYTE, kFramebufferSide,
                                 kFramebufferSide) == GL_TRUE;
  }
  void release() override { osmesa().make_current(nullptr, nullptr, GL_UNSIGNED_BYTE, 0, 0); }
  AnyFunction find_function(const char* name) const override {
    return osmesa().find_function(name);
  }

 private:
  OsmesaFunctions::Context context_;
  std::array<std::uint8_t, std::size_t{4} * kFramebufferSide * kFramebufferSide> pixels_{};
};

/// Pointers to the functions of libEGL. Their types come from egl.h. libEGL is not linked, but
/// loaded when it is first needed.
struct EglFunctions {
  EglFunctions() {
    const SharedLibrary library("libEGL.so.1");
#define ORGAN_COLLISION_LOAD(name) library.load("egl" #name, name);
    ORGAN_COLLISION_EGL_FUNCTIONS(ORGAN_COLLISION_LOAD)
#undef ORGAN_COLLISION_LOAD
  }

#define ORGAN_COLLISION_DECLARE(name) decltype(&egl##name) name = nullptr;
  ORGAN_COLLISION_EGL_FUNCTIONS(ORGAN_COLLISION_DECLARE)
#undef ORGAN_COLLISION_DECLARE
};

/// The functions of the libEGL of this process. Throws GlError if there is none.
const EglFunctions& egl() {
  static const EglFunctions functions;
  return functions;
}

/// An error whose text ends with EGL's error code of the last call.
GlError egl_error(const std::string& what) {
  std::array<char, 16> code{};
  std::snprintf(code.data(), code.size(), "0x%04x", egl().GetError());
  return GlError(what + " (EGL error " + code.data() + ")");
}

template <typename Function>
Function extension_function(const char* name) {
  return reinterpret_cast<Function>(egl().GetProcAddress(name));
}

/// The displays on which EGL may draw without a window, not initialized. First come the displays of
/// devices that draw on the CPU: no driver of a graphics card can serve them. Last comes the
/// display of Mesa's platform without surfaces, where Mesa may use a graphics card. Throws GlError
/// if there is no libEGL.
std::vector<EGLDisplay> software_displays() {
  const auto platform_display =
      extension_function<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
  const auto query_devices = extension_function<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
  const auto query_string =
      extension_function<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
  if (platform_display == nullptr) return {};
  std::array<EGLDeviceEXT, 64> devices{};
  EGLint count = 0;
  if (query_devices == nullptr || query_string == nullptr ||
      query_devices(static_cast<EGLint>(devices.size()), devices.data(), &count) != EGL_TRUE) {
    count = 0;
  }
  std::vector<EGLDisplay> displays;
  for (auto device = devices.begin(); device != devices.begin() + count; ++device) {
    const char* const extensions = query_string(*device, EGL_EXTENSIONS);
    if (extensions == nullptr || std::strstr(extensions, "EGL_MESA_device_software") == nullptr) {
      continue;
    }
    displays.push_back(platform_display(EGL_PLATFORM_DEVICE_EXT, *device, nullptr));
  }
  displays.push_back(platform_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
  return displays;
}

class EglContext final : public PlatformContext {
 public:
  /// `display` must be initialized. create() follows, before any other function.
  explicit EglContext(EGLDisplay display) : display_(display) {}
  ~EglContext() override {
    if (context_ == EGL_NO_CONTEXT) return;
    if (is_current()) release();
    if (surface_ != EGL_NO_SURFACE) egl().DestroySurface(display_, surface_);
    egl().DestroyContext(display_, context_);
  }
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  /// Throws GlError.
  void create() {
    if (egl().BindAPI(EGL_OPENGL_API) != EGL_TRUE) throw egl_error("EGL has no OpenGL");
    const std::array<std::array<EGLint, 2>, 8> wanted = {{{EGL_SURFACE_TYPE, EGL_PBUFFER_BIT},
                                                          {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT},
                                                          {EGL_RED_SIZE, 8},
                                                          {EGL_GREEN_SIZE, 8},
                                                          {EGL_BLUE_SIZE, 8},
                                                          {EGL_ALPHA_SIZE, 8},
                                                          {EGL_DEPTH_SIZE, 0},
                                                          {EGL_NONE, 0}}};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (egl().ChooseConfig(display_, wanted.front().data(), &config, 1, &count) != EGL_TRUE ||
        count == 0) {
      throw egl_error("EGL has no OpenGL with a framebuffer in memory");
    }
    context_ = egl().CreateContext(display_, config, EGL_NO_CONTEXT, nullptr);
    if (context_ == EGL_NO_CONTEXT) throw egl_error("EGL gives no compatibility context");
    const EGLint size[] = {EGL_WIDTH, kFramebufferSide, EGL_HEIGHT, kFramebufferSide, EGL_NONE};
    surface_ = egl().CreatePbufferSurface(display_, config, size);
    if (surface_ == EGL_NO_SURFACE) throw egl_error("EGL gives no framebuffer in memory");
    if (!make_current()) throw egl_error("EGL cannot make its context current");
    check_renderer();
  }

  bool is_current() const override { return egl().GetCurrentContext() == context_; }
  bool make_current() override {
    // Each thread has its own choice of the API (OpenGL or OpenGL ES), so it is set here.
    return egl().BindAPI(EGL_OPENGL_API) == EGL_TRUE &&
           egl().MakeCurrent(display_, surface_, surface_, context_) == EGL_TRUE;
  }
  void release() override {
    egl().MakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  }
  AnyFunction find_function(const char* name) const override { return egl().GetProcAddress(name); }

 private:
  /// Throws GlError unless a Mesa renderer on the CPU draws: its precision and its speed are known.
  /// Other drivers may implement GL_SELECT and GL_FEEDBACK in other ways, or not at all.
  void check_renderer() {
    const auto get_string = reinterpret_cast<decltype(&glGetString)>(find_function("glGetString"));
    const GLubyte* const name = get_string != nullptr ? get_string(GL_RENDERER) : nullptr;
    const std::string renderer = name != nullptr ? reinterpret_cast<const char*>(name) : "nothing";
    if (renderer.find("llvmpipe") != std::string::npos) return;
    if (renderer.find("softpipe") != std::string::npos) return;
    throw GlError("EGL draws with \"" + renderer + "\", not with Mesa's llvmpipe on the CPU");
  }

  EGLDisplay display_;
  EGLContext context_ = EGL_NO_CONTEXT;
  EGLSurface surface_ = EGL_NO_SURFACE;
};

}  // namespace

std::unique_ptr<PlatformContext> new_osmesa_context() { return std::make_unique<OsmesaContext>(); }

std::unique_ptr<PlatformContext> new_egl_context() {
  std::string reason = "EGL knows neither devices without hardware nor a platform without surfaces";
  for (EGLDisplay display : software_displays()) {
    // A display stays initialized until the process ends, because other code may use it, too.
    if (egl().Initialize(display, nullptr, nullptr) != EGL_TRUE) {
      reason = egl_error("EGL cannot start Mesa's renderer on the CPU").what();
      continue;
    }
    try {
      auto context = std::make_unique<EglContext>(display);
      context->create();
      return context;
    } catch (const GlError& error) {
      reason = error.what();
    }
  }
  throw GlError(reason);
}

}  // namespace organ_collision
