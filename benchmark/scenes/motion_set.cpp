#include "motion_set.hpp"

#include <stdexcept>

#include "grasper.hpp"
#include "tool_motions.hpp"

namespace organ_collision::bench {
namespace {

constexpr double kTipStep = 0.001;   // [m] of the grasper, sideways at the point aimed at
constexpr double kJawStep = 0.02;    // [rad] of each jaw in a motion
constexpr double kJawOpening = 0.3;  // [rad] at the start of a motion
constexpr double kReach =
    0.024;  // [m] from the end of the shaft to the point that the motions aim at

ShaftAxis drawn_back(ShaftAxis axis) {
  axis.tip -= kReach * (axis.tip - axis.trocar).normalized();
  return axis;
}

}  // namespace

MotionSet shaft_motions(const OrganSurface& organ, std::size_t count) {
  const SceneScale scale(organ.face_count());
  ToolMotions motions(organ, scale);
  MotionSet set{scale.radius, {}, {}};
  for (std::size_t i = 0; i < count; ++i) {
    const ShaftMotion motion = motions.next(organ.vertices);
    set.paths.push_back({{0.0, motion.start, {}}, {1.0, motion.end, {}}});
  }
  return set;
}

MotionSet grasper_motions(const OrganSurface& organ, std::size_t count) {
  SceneScale scale(organ.face_count());
  scale.tip_step = kTipStep;
  ToolMotions motions(organ, scale);
  MotionSet set{Grasper::kRadius, Grasper::make_links(), {}};
  for (std::size_t i = 0; i < count; ++i) {
    const ShaftMotion motion = motions.next(organ.vertices);
    set.paths.push_back({Grasper::place(0.0, drawn_back(motion.start), kJawOpening),
                         Grasper::place(1.0, drawn_back(motion.end), kJawOpening - kJawStep)});
  }
  return set;
}

MotionSet motions_of(const std::string& tool, const OrganSurface& organ, std::size_t count) {
  if (tool == "shaft") return shaft_motions(organ, count);
  if (tool == "grasper") return grasper_motions(organ, count);
  throw std::invalid_argument("the tool is '" + tool + "'; legal are shaft and grasper");
}

}  // namespace organ_collision::bench
