#pragma once

#include <array>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

namespace organ_collision {

/// How the candidate faces are found. All kinds lead to the same contacts.
enum class PickerKind { kFeedback, kSelect, kCpu };

/// A kind of picker, as users name it.
struct PickerName {
  const char* name;   ///< in parameters and options
  PickerKind value;   ///< the kind
  const char* about;  ///< what --help and the reference say of it
};

/// The names of all kinds, the default one first.
inline constexpr std::array<PickerName, 3> kPickerNames = {
    {{"feedback", PickerKind::kFeedback,
      "one draw call in the mode GL_FEEDBACK, in which each vertex carries the number of its face"},
     {"select", PickerKind::kSelect,
      "GL_SELECT, as in the 1999 paper: each face is drawn under its own name. Slow only in the "
      "paper's modes, where it draws all faces"},
     {"cpu", PickerKind::kCpu,
      "no OpenGL: outcodes alone; the paper's modes also clip in double precision"}}};

/// All kinds of pickers, the default one first.
std::vector<PickerKind> picker_kinds();
/// The kind with this name. Throws std::invalid_argument if there is none.
PickerKind picker_kind(const std::string& name);

/// Where the OpenGL context for picking comes from. Both platforms draw with Mesa on the CPU, and
/// pick the same faces.
enum class GlPlatform {
  kAuto,    ///< OSMesa if it gives a context, otherwise EGL
  kOsmesa,  ///< libOSMesa; Mesa 25.1 and later do not contain it
  kEgl      ///< libEGL with one of Mesa's software renderers; it draws into a few pixels in memory
};

/// A platform, as users name it.
struct GlPlatformName {
  const char* name;  ///< in parameters
  GlPlatform value;  ///< the platform
};

/// All platforms, the default one first.
inline constexpr std::array<GlPlatformName, 3> kGlPlatformNames = {
    {{"auto", GlPlatform::kAuto}, {"osmesa", GlPlatform::kOsmesa}, {"egl", GlPlatform::kEgl}}};

/// The platform with this name. Throws std::invalid_argument if there is none.
GlPlatform gl_platform(const std::string& name);

/// An OpenGL call failed, or OpenGL picking does not work in this process. what() says what to
/// install or change, if that is known.
class GlError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// How many faces a picker looked at one by one. Outcodes reject the others.
struct PickCounts {
  std::size_t drawn = 0;    ///< OpenGL clipped them to the viewing volume of the tool
  std::size_t undrawn = 0;  ///< decided without OpenGL: most of them have a corner in the volume
};

/// Which picker finds the candidate faces, and where its OpenGL comes from.
struct PickerSettings {
  /// Not explicit: a PickerKind alone is a setting, with OpenGL from any platform that works.
  // NOLINTNEXTLINE(google-explicit-constructor)
  PickerSettings(PickerKind its_kind = PickerKind::kFeedback, GlPlatform its_gl = GlPlatform::kAuto)
      : kind(its_kind), gl(its_gl) {}

  PickerKind kind;  ///< how the candidate faces are found
  GlPlatform gl;    ///< where OpenGL comes from; kCpu ignores it
};

}  // namespace organ_collision
