#pragma once

#include <GL/gl.h>

#include <memory>
#include <string>

#include "organ_collision/picking/picker_settings.hpp"

// All GL functions that picking calls, without the prefix gl.
// clang-format off
#define ORGAN_COLLISION_GL_FUNCTIONS(F)                                                       \
  F(ClipPlane) F(DepthRange) F(DrawArrays) F(Enable) F(EnableClientState) F(FeedbackBuffer)   \
  F(GetError) F(GetString) F(InitNames) F(LoadIdentity) F(LoadMatrixd) F(LoadName)            \
  F(PassThrough) F(PushName) F(RenderMode) F(SelectBuffer) F(TexCoordPointer) F(VertexPointer)
// clang-format on

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

/// Pointers to the GL functions that a context provides. Their types come from gl.h. libGL is not
/// linked.
struct GlFunctions {
#define ORGAN_COLLISION_DECLARE(name) decltype(&gl##name) name = nullptr;
  ORGAN_COLLISION_GL_FUNCTIONS(ORGAN_COLLISION_DECLARE)
#undef ORGAN_COLLISION_DECLARE
};

/// An OpenGL context (compatibility profile) without a window, its framebuffer, and its GL
/// functions. The functions are loaded from the context: in a process that loaded libGL first,
/// linked functions silently do nothing.
///
/// Move-only. Belongs to one thread at a time. The constructor, make_current and every picker leave
/// the context current in the calling thread. Release the context there before another thread uses
/// or destroys it.
class GlContext {
 public:
  /// Throws GlError, with the reason of each platform, if no platform gives a context that works.
  explicit GlContext(GlPlatform platform = GlPlatform::kAuto);

  /// Makes this context current in the calling thread; this is cheap if it is current already. If
  /// the context has failed before, a new one replaces it. Throws GlError.
  void make_current();
  bool is_current() const;
  /// If this context is current in the calling thread, the thread then has no current context.
  void release();

  /// GL_VERSION and the platform, as "4.5 (Compatibility Profile) Mesa 22.3.6 on OSMesa". Valid as
  /// long as this object is not moved.
  const std::string& version() const { return version_; }
  /// The functions of this context. Valid until a new context replaces it.
  const GlFunctions& functions() const { return functions_; }

  /// If GL reports an error, fails with `where` and the error's code.
  void check(const char* where);
  /// Throws GlError. The next make_current() replaces this context by a new one.
  [[noreturn]] void fail(const std::string& what);

 private:
  void make();
  void take(std::unique_ptr<PlatformContext> context, const char* platform);

  GlPlatform platform_;
  std::unique_ptr<PlatformContext> context_;
  GlFunctions functions_;
  std::string version_;
  bool has_failed_ = false;
};

}  // namespace organ_collision
