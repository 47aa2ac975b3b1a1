#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "organ_collision/picking/gl_error.hpp"

namespace organ_collision {

struct GlFunctions;

/// What a context draws into. Picking draws nothing, but OSMesa requires a framebuffer.
struct GlFramebuffer {
  int width = 4, height = 4;  ///< [pixel]
  int depth_bits = 0;         ///< 0: without depth buffer
};

/// An OSMesa compatibility context without a window, its framebuffer, and the GL functions loaded
/// from it. The functions are loaded and never linked: in a process that loaded libGL first, linked
/// functions silently do nothing.
///
/// Move-only. Belongs to one thread at a time. The constructor, make_current and every picker leave
/// the context current in the calling thread. Release it there before another thread uses or
/// destroys it.
class GlContext {
 public:
  /// Throws GlError if OSMesa gives no context or no version string, or lacks a GL function.
  explicit GlContext(const GlFramebuffer& framebuffer = {});
  ~GlContext();
  GlContext(GlContext&&) noexcept;
  GlContext& operator=(GlContext&&) noexcept;

  /// Makes this context current in the calling thread; cheap when it already is.
  void make_current();
  /// If this context is current in the calling thread, the thread has no current context
  /// afterwards.
  void release();

  /// GL_VERSION, for example "4.5 (Compatibility Profile) Mesa 22.3.6".
  const std::string& version() const;
  /// The functions of this context. Valid as long as the context lives.
  const GlFunctions& functions() const;
  /// The framebuffer: rows from bottom to top, with four bytes (red, green, blue, alpha) a pixel.
  /// Call GL's Finish before reading it. Valid as long as the context lives.
  const std::uint8_t* pixels() const;

  /// Throws GlError naming `where` and the error code if GL reports one.
  void check(const char* where) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Makes a context current in the calling thread. The destructor releases the context, so that any
/// thread may use or destroy it next.
class ScopedCurrentContext {
 public:
  explicit ScopedCurrentContext(GlContext& context) : context_(context) { context_.make_current(); }
  ~ScopedCurrentContext() { context_.release(); }
  ScopedCurrentContext(const ScopedCurrentContext&) = delete;
  ScopedCurrentContext& operator=(const ScopedCurrentContext&) = delete;

 private:
  GlContext& context_;
};

}  // namespace organ_collision
