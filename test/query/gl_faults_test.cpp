// Tests collision_query.hpp when OpenGL reports an error during a query. This program stands
// between the package and OSMesa, and makes calls fail.
#include <GL/osmesa.h>
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <cstring>

#include "link_scenes.hpp"

namespace {

constexpr int kNever = -1;
int checks_until_error = kNever;
GLenum(GLAPIENTRY* real_get_error)() = nullptr;

GLenum GLAPIENTRY failing_get_error() {
  if (checks_until_error == kNever || checks_until_error-- > 0) return real_get_error();
  checks_until_error = kNever;
  return GL_OUT_OF_MEMORY;
}

}  // namespace

extern "C" OSMESAproc GLAPIENTRY OSMesaGetProcAddress(const char* name) {
  const auto real =
      reinterpret_cast<decltype(&OSMesaGetProcAddress)>(dlsym(RTLD_NEXT, "OSMesaGetProcAddress"));
  const OSMESAproc function = real(name);
  if (std::strcmp(name, "glGetError") != 0) return function;
  real_get_error = reinterpret_cast<decltype(real_get_error)>(function);
  return reinterpret_cast<OSMESAproc>(failing_get_error);
}

namespace organ_collision {
namespace {

using oracle::Random;

class GlFaultsWith : public CollisionQueryWith {
 protected:
  void TearDown() override { checks_until_error = kNever; }
};

// Legs, links and regions are drawn one after the other. Each draw is made to fail once.
TEST_P(GlFaultsWith, LeaveNoContactsBehindAndTheNextQueryIsWhole) {
  Random random(51);
  std::size_t failed = 0, found = 0;
  for (int i = 0; i < 12 && !HasFailure(); ++i) {
    LinkScene scene(true, random);
    scene.request.regions = i % 2 == 0;
    query_.evaluate(scene.request, result_);
    const CollisionResult whole = result_;
    found += whole.contacts.size();
    for (int checks = 0; checks < 40; ++checks) {
      checks_until_error = checks;
      try {
        query_.evaluate(scene.request, result_);
        EXPECT_NE(checks_until_error, kNever) << "an error was overlooked";
        break;
      } catch (const GlError&) {
        ++failed;
      }
      EXPECT_TRUE(result_.contacts.empty());
      EXPECT_TRUE(result_.regions.empty());
      query_.evaluate(scene.request, result_);
      expect_same(result_.contacts, whole.contacts, 0.0);
      EXPECT_EQ(result_.regions.size(), whole.regions.size());
    }
    checks_until_error = kNever;
  }
  EXPECT_GT(failed, 50U);
  EXPECT_GT(found, 100U);
}

INSTANTIATE_TEST_SUITE_P(Pickers, GlFaultsWith,
                         testing::Values(PickerKind::kFeedback, PickerKind::kSelect));

}  // namespace
}  // namespace organ_collision
