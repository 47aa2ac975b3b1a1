#include "organ_collision/picking/picker_settings.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

namespace organ_collision {
namespace {

TEST(PickerSettings, KindsHaveNames) {
  EXPECT_EQ(picker_kind("feedback"), PickerKind::kFeedback);
  EXPECT_EQ(picker_kind("select"), PickerKind::kSelect);
  EXPECT_EQ(picker_kind("cpu"), PickerKind::kCpu);
}

TEST(PickerSettings, PlatformsHaveNames) {
  EXPECT_EQ(gl_platform("auto"), GlPlatform::kAuto);
  EXPECT_EQ(gl_platform("osmesa"), GlPlatform::kOsmesa);
  EXPECT_EQ(gl_platform("egl"), GlPlatform::kEgl);
}

/// Expects that parse(name) throws, and names the value and what is legal.
template <typename Parse>
void expect_refused(Parse parse, const std::string& name, const std::string& legal) {
  try {
    parse(name);
    FAIL() << name;
  } catch (const std::invalid_argument& error) {
    const std::string what = error.what();
    EXPECT_NE(what.find("\"" + name + "\""), std::string::npos) << what;
    EXPECT_NE(what.find(legal), std::string::npos) << what;
  }
}

TEST(PickerSettings, OtherNamesAreRefused) {
  for (const char* name : {"", "Feedback", "both", "GPU"}) {
    expect_refused(picker_kind, name, "\"feedback\", \"select\" or \"cpu\"");
    expect_refused(gl_platform, name, "\"auto\", \"osmesa\" or \"egl\"");
  }
}

TEST(PickerSettings, AreFeedbackWithAnyOpenGlByDefault) {
  EXPECT_EQ(PickerSettings().kind, PickerKind::kFeedback);
  EXPECT_EQ(PickerSettings(PickerKind::kSelect).gl, GlPlatform::kAuto);
}

}  // namespace
}  // namespace organ_collision
