#pragma once

#include <dlfcn.h>

#include <memory>
#include <string>

#include "organ_collision/picking/gl_error.hpp"
#include "organ_collision/picking/gl_platform.hpp"

namespace organ_collision {

/// [pixel] Width and height of the framebuffer of a context, which has four bytes a pixel and no
/// depth. Picking draws no pixels, but GL requires a framebuffer.
inline constexpr int kFramebufferSide = 4;

/// An OpenGL context (compatibility profile) of one platform.
class PlatformContext {
 public:
  using AnyFunction = void (*)();

  virtual ~PlatformContext() = default;

  virtual bool is_current() const = 0;
  /// Returns whether the context is then current in the calling thread.
  virtual bool make_current() = 0;
  /// Leaves the calling thread without a current context. This context must be current.
  virtual void release() = 0;
  /// The GL function of this name, for example "glBegin", or null.
  virtual AnyFunction find_function(const char* name) const = 0;
};

// Both functions throw GlError if the platform gives no context.
std::unique_ptr<PlatformContext> new_osmesa_context();
std::unique_ptr<PlatformContext> new_egl_context();

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

}  // namespace organ_collision
