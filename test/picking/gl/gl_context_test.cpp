#include "picking/gl/gl_context.hpp"

#include <EGL/egl.h>
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "picking/gl/drawing.hpp"
#include "picking/gl/gl_context.hpp"
#include "test/refusals.hpp"

namespace organ_collision {
namespace {

// A box of 2 m by 2 m by 2 m around the origin.
ViewingVolume box() {
  return ViewingVolume::orthographic({Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(),
                                      Eigen::Matrix3d::Identity(), -1, 1, -1, 1, -1, 1});
}

/// A test with a context of each platform.
class GlContextOf : public testing::TestWithParam<GlPlatform> {
 protected:
  static GlContext context() { return GlContext(GetParam()); }
};

INSTANTIATE_TEST_SUITE_P(Platforms, GlContextOf,
                         testing::Values(GlPlatform::kOsmesa, GlPlatform::kEgl),
                         [](const auto& info) {
                           return info.param == GlPlatform::kOsmesa ? "Osmesa" : "Egl";
                         });

/// Whether GL returns a face at x from 0.5 to 0.6 m, clipped to `volume`.
bool sees_face(GlContext& context, const ViewingVolume& volume) {
  DrawnFaces face;
  face.add({Eigen::Vector3d(0.5, 0.0, 0.0), Eigen::Vector3d(0.5, 0.1, 0.1),
            Eigen::Vector3d(0.6, 0.1, 0.0)},
           0);
  std::vector<float> buffer(100);
  return draw_feedback(context, volume, face, buffer) > 0;
}

/// Lets GL drop the face of sees_face(), whose back is seen, in this context only.
void cull_face(GlContext& context) {
  context.make_current();
  context.functions().Enable(GL_CULL_FACE);
}

ViewingVolume box_without_face() {
  ViewingVolume cut = box();
  cut.add_user_plane({Eigen::Vector3d::UnitX(), 0.1});
  return cut;
}

// If a process has loaded libGL first, the names of all GL functions resolve to libGL, whose
// functions do nothing.
TEST_P(GlContextOf, WorksBesideAnotherLibGl) {
  if (std::getenv("LD_PRELOAD") == nullptr) GTEST_SKIP() << "runs where libGL is preloaded";
  const auto other = reinterpret_cast<decltype(&glGetString)>(dlsym(RTLD_DEFAULT, "glGetString"));
  ASSERT_NE(other, nullptr);
  if (GetParam() == GlPlatform::kOsmesa) {
    GlContext context = this->context();
    EXPECT_EQ(other(GL_VERSION), nullptr) << "the preloaded libGL was to know no context";
  }
  GlContext context = this->context();
  EXPECT_FALSE(context.version().empty());
  EXPECT_TRUE(sees_face(context, box()));
  EXPECT_FALSE(sees_face(context, box_without_face()));
}

TEST_P(GlContextOf, ReportsTheErrorAndWhereAndIsMadeAnew) {
  GlContext context = this->context();
  context.check("nothing");
  context.functions().Enable(0xdead);
  EXPECT_EQ(refusal_by<GlError>([&] { context.check("a test"); }), "OpenGL error 0x0500 in a test");
  EXPECT_TRUE(sees_face(context, box()));
}

TEST_P(GlContextOf, StateOfOneDoesNotReachAnother) {
  GlContext first = context(), second = context();
  EXPECT_TRUE(sees_face(first, box()));
  cull_face(first);
  EXPECT_FALSE(sees_face(first, box()));
  EXPECT_TRUE(sees_face(second, box()));
}

// EGL says that its context is current even if OSMesa's has taken its place.
TEST(GlContext, ContextsOfBothPlatformsAlternate) {
  GlContext osmesa(GlPlatform::kOsmesa), egl(GlPlatform::kEgl);
  cull_face(osmesa);
  for (const bool releases : {true, false, true}) {
    for (int i = 0; i < 3; ++i) {
      EXPECT_FALSE(sees_face(osmesa, box()));
      if (releases) osmesa.release();
      EXPECT_TRUE(sees_face(egl, box()));
      if (releases) egl.release();
    }
  }
}

// A context that another one has replaced is released as well: otherwise its platform does not
// give it to another thread. It also outlives the other one.
TEST(GlContext, ReplacedAndReleasedWorksInAnotherThread) {
  for (const GlPlatform other : {GlPlatform::kOsmesa, GlPlatform::kEgl}) {
    GlContext context(other == GlPlatform::kEgl ? GlPlatform::kOsmesa : GlPlatform::kEgl);
    for (int i = 0; i < 3; ++i) {
      EXPECT_TRUE(sees_face(context, box()));
      GlContext passing(other);
      EXPECT_TRUE(sees_face(passing, box()));
    }
    EXPECT_TRUE(sees_face(context, box()));
    GlContext second(other);
    EXPECT_TRUE(sees_face(second, box()));
    context.release();
    bool sees_elsewhere = false;
    std::thread([&] {
      sees_elsewhere = sees_face(context, box());
      context.release();
    }).join();
    EXPECT_TRUE(sees_elsewhere);
    EXPECT_TRUE(sees_face(second, box()));
  }
}

// EGL's framebuffer is destroyed behind the context's back. GL then draws nothing and says so, or
// the context cannot be made current any more.
TEST(GlContext, WithoutItsFramebufferFailsAndIsMadeAnew) {
  GlContext context(GlPlatform::kEgl);
  ASSERT_TRUE(sees_face(context, box()));
  void* const egl = dlopen("libEGL.so.1", RTLD_NOW);
  const auto current_display =
      reinterpret_cast<decltype(&eglGetCurrentDisplay)>(dlsym(egl, "eglGetCurrentDisplay"));
  const auto current_surface =
      reinterpret_cast<decltype(&eglGetCurrentSurface)>(dlsym(egl, "eglGetCurrentSurface"));
  const auto destroy_surface =
      reinterpret_cast<decltype(&eglDestroySurface)>(dlsym(egl, "eglDestroySurface"));
  EGLDisplay const display = current_display();
  EGLSurface const surface = current_surface(EGL_DRAW);
  context.release();
  ASSERT_EQ(destroy_surface(display, surface), static_cast<EGLBoolean>(EGL_TRUE));
  EXPECT_THROW(sees_face(context, box()), GlError);
  EXPECT_TRUE(sees_face(context, box()));
}

/// Sets an environment variable as long as it lives.
class ScopedVariable {
 public:
  ScopedVariable(const char* name, const char* value) : name_(name) {
    const char* const before = std::getenv(name);
    if (before != nullptr) before_ = before;
    setenv(name, value, 1);
  }
  ~ScopedVariable() {
    if (before_) setenv(name_, before_->c_str(), 1);
    if (!before_) unsetenv(name_);
  }
  ScopedVariable(const ScopedVariable&) = delete;
  ScopedVariable& operator=(const ScopedVariable&) = delete;

 private:
  const char* name_;
  std::optional<std::string> before_;
};

// With a driver that it does not know, OSMesa would end the process.
TEST_P(GlContextOf, RefusesDriversThatDoNotDrawOnTheCpu) {
  for (const char* driver : {"nonsense", "zink", "swr", "d3d12", "llvmpipe,softpipe"}) {
    const ScopedVariable variable("GALLIUM_DRIVER", driver);
    expect_words(refusal_by<GlError>([] { context(); }),
                 {"GALLIUM_DRIVER", driver, "llvmpipe", "softpipe", "picker: cpu"});
  }
  for (const char* driver : {"llvmpipe", "softpipe", ""}) {
    const ScopedVariable variable("GALLIUM_DRIVER", driver);
    GlContext context = this->context();
    EXPECT_TRUE(sees_face(context, box())) << driver;
  }
}

// What a system lacks is simulated by files in LD_LIBRARY_PATH that are no libraries.
TEST(GlContext, AutoTakesWhatThereIs) {
  const char* const missing = std::getenv("MISSING_GL");
  if (missing == nullptr) GTEST_SKIP() << "runs where a library is missing";
  const bool has_osmesa = std::string(missing).find("osmesa") == std::string::npos;
  const bool has_egl = std::string(missing).find("egl") == std::string::npos;
  if (!has_osmesa) {
    EXPECT_THROW(GlContext(GlPlatform::kOsmesa), GlError);
  }
  if (!has_egl) {
    EXPECT_THROW(GlContext(GlPlatform::kEgl), GlError);
  }
  if (has_osmesa || has_egl) {
    GlContext context;
    EXPECT_TRUE(sees_face(context, box()));
    return;
  }
  expect_words(refusal_by<GlError>([] { GlContext context; }),
               {"libOSMesa.so.8", "libEGL.so.1", "libosmesa6", "picker: cpu"});
}

}  // namespace
}  // namespace organ_collision
