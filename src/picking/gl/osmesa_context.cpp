#include <GL/gl.h>

#include <array>
#include <cstddef>
#include <cstdint>

#include "gl_context.hpp"

namespace organ_collision {
namespace {

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

}  // namespace

std::unique_ptr<PlatformContext> new_osmesa_context() { return std::make_unique<OsmesaContext>(); }

}  // namespace organ_collision
