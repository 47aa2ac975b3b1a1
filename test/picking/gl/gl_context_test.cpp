#include "picking/gl/gl_context.hpp"

#include <dlfcn.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "picking/gl/gl_functions.hpp"
#include "picking/pickers/picker.hpp"

namespace organ_collision {
namespace {

// A box of 2 m by 2 m by 2 m around the origin.
ViewingVolume box() {
  return ViewingVolume::orthographic({Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(),
                                      Eigen::Matrix3d::Identity(), -1, 1, -1, 1, -1, 1});
}

std::size_t picked(GlContext& context, const ViewingVolume& volume) {
  const TriangleMesh mesh({0.5F, 0, 0, 0.6F, 0.1F, 0, 0.5F, 0.1F, 0.1F}, {0, 1, 2});
  std::vector<Candidate> candidates;
  make_picker(PickerKind::kFeedback, context)->pick(volume, mesh, candidates);
  return candidates.size();
}

TEST(GlContext, TellsItsVersion) {
  const GlContext context;
  EXPECT_NE(context.version().find("Mesa"), std::string::npos) << context.version();
}

// If a process has loaded libGL first, the names of all GL functions resolve to libGL, whose
// functions do nothing.
TEST(GlContext, WorksBesideAnotherLibGl) {
  if (std::getenv("LD_PRELOAD") == nullptr) GTEST_SKIP() << "runs where libGL is preloaded";
  const auto other = reinterpret_cast<decltype(&glGetString)>(dlsym(RTLD_DEFAULT, "glGetString"));
  ASSERT_NE(other, nullptr);
  GlContext context;
  EXPECT_EQ(other(GL_VERSION), nullptr) << "the preloaded libGL was to know no context";
  EXPECT_FALSE(context.version().empty());
  EXPECT_EQ(picked(context, box()), 1u);
}

TEST(GlContext, ReportsTheErrorAndWhere) {
  const GlContext context;
  context.check("nothing");
  context.functions().Enable(0xdead);
  try {
    context.check("a test");
    FAIL() << "no error was thrown";
  } catch (const GlError& error) {
    EXPECT_STREQ(error.what(), "OpenGL error 0x0500 in a test");
  }
  context.check("the next query");
}

TEST(GlContext, ContextsAlternateAndKeepTheirOwnState) {
  GlContext first, second;
  ViewingVolume cut = box();
  cut.add_user_plane({Eigen::Vector3d::UnitX(), 0.1});
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(picked(first, box()), 1u);
    EXPECT_EQ(picked(second, cut), 0u);
  }
}

TEST(GlContext, StateOfOneDoesNotReachAnother) {
  GlContext first, second;
  first.make_current();
  const auto front_face = reinterpret_cast<decltype(&glFrontFace)>(find_gl_function("glFrontFace"));
  front_face(GL_CW);
  first.functions().Enable(GL_CULL_FACE);
  EXPECT_THROW(picked(first, box()), GlError) << "the self-check of the picker was to notice";
  EXPECT_EQ(picked(second, box()), 1u);
  first.make_current();
  front_face(GL_CCW);
  EXPECT_EQ(picked(first, box()), 1u);
}

TEST(GlContext, Moves) {
  GlContext first;
  const std::string version = first.version();
  GlContext second = std::move(first);
  EXPECT_EQ(picked(second, box()), 1u);
  GlContext third;
  third = std::move(second);
  EXPECT_EQ(picked(third, box()), 1u);
  EXPECT_EQ(third.version(), version);
}

TEST(GlContext, ReleasesOnlyItself) {
  GlContext first, second;
  first.make_current();
  second.release();
  EXPECT_NE(first.functions().GetString(GL_VERSION), nullptr);
  first.release();
  EXPECT_EQ(first.functions().GetString(GL_VERSION), nullptr);
  first.make_current();
  EXPECT_NE(first.functions().GetString(GL_VERSION), nullptr);
}

TEST(GlContext, ReleasedInOneThreadWorksInAnother) {
  GlContext context;
  EXPECT_EQ(picked(context, box()), 1u);
  context.release();
  std::size_t elsewhere = 0;
  std::thread([&] {
    elsewhere = picked(context, box());
    context.release();
  }).join();
  EXPECT_EQ(elsewhere, 1u);
  EXPECT_EQ(picked(context, box()), 1u);
}

TEST(GlContext, IsMadeAndDestroyedManyTimes) {
  for (int i = 0; i < 8; ++i) {
    GlContext context;
    ASSERT_EQ(picked(context, box()), 1u);
  }
}

TEST(GlContext, OneForEachThreadSideBySide) {
  std::vector<std::size_t> totals(3, 0);
  std::vector<std::thread> threads;
  for (std::size_t& total : totals) {
    threads.emplace_back([&total] {
      GlContext context;
      for (int i = 0; i < 20; ++i) total += picked(context, box());
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(totals, std::vector<std::size_t>(3, 20));
}

}  // namespace
}  // namespace organ_collision
