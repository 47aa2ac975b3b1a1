#pragma once

#include <GL/gl.h>

#include <memory>
#include <string>

#include "organ_collision/picking/gl_error.hpp"
#include "organ_collision/picking/gl_platform.hpp"
#include "platform_context.hpp"

// Every GL function that picking calls, without its gl prefix.
// clang-format off
#define ORGAN_COLLISION_GL_FUNCTIONS(F)                                                       \
  F(ClipPlane) F(DepthRange) F(DrawArrays) F(Enable) F(EnableClientState) F(FeedbackBuffer)   \
  F(GetError) F(GetString) F(InitNames) F(LoadIdentity) F(LoadMatrixd) F(LoadName)            \
  F(PushName) F(RenderMode) F(SelectBuffer) F(TexCoordPointer) F(VertexPointer)
// clang-format on

namespace organ_collision {

/// Pointers to the GL functions that a context provides. Only the types come from the prototypes in
/// gl.h; libGL is not linked.
struct GlFunctions {
#define ORGAN_COLLISION_DECLARE(name) decltype(&gl##name) name = nullptr;
  ORGAN_COLLISION_GL_FUNCTIONS(ORGAN_COLLISION_DECLARE)
#undef ORGAN_COLLISION_DECLARE
};

/// Loads all these functions. Throws GlError, naming the first one that is missing.
GlFunctions load_gl_functions(const PlatformContext& context);

using AnyGlFunction = PlatformContext::AnyFunction;

/// The function of this name, for example "glBegin". Throws GlError if the context has none.
AnyGlFunction find_gl_function(const PlatformContext& context, const char* name);

/// A compatibility context without a window, its framebuffer, and the GL functions loaded from it.
/// The functions are loaded and never linked: in a process that loaded libGL first, linked
/// functions silently do nothing.
///
/// Move-only. Belongs to one thread at a time. The constructor, make_current and every picker leave
/// the context current in the calling thread. Release it there before another thread uses or
/// destroys it.
class GlContext {
 public:
  /// Throws GlError with all reasons if no platform that is asked for gives a context that works.
  explicit GlContext(GlPlatform platform = GlPlatform::kAuto,
                     const GlFramebuffer& framebuffer = {});
  ~GlContext();
  GlContext(GlContext&&) noexcept;
  GlContext& operator=(GlContext&&) noexcept;

  /// Makes this context current in the calling thread; cheap when it already is. Makes it anew if
  /// it has failed before. Throws GlError.
  void make_current();
  bool is_current() const;
  /// If this context is current in the calling thread, the thread has no current context
  /// afterwards.
  void release();

  /// GL_VERSION and the platform, as "4.5 (Compatibility Profile) Mesa 22.3.6 on OSMesa". Valid as
  /// long as this object is not moved.
  const std::string& version() const { return version_; }
  /// The functions of this context. Valid until it is made anew.
  const GlFunctions& functions() const;
  /// The function of this name, for example "glBegin". Throws GlError if GL has none.
  AnyGlFunction find_function(const char* name) const;

  /// If GL reports an error, fails with `where` and the error's code.
  void check(const char* where);
  /// Throws GlError, and has the next make_current() make this context anew.
  [[noreturn]] void fail(const std::string& what);

 private:
  struct State;

  void make();

  GlPlatform platform_;
  GlFramebuffer framebuffer_;
  std::unique_ptr<State> state_;
  std::string version_;
  bool has_failed_ = false;
};

}  // namespace organ_collision
