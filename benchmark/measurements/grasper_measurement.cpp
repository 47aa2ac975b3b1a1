#include "grasper_measurement.hpp"

#include <algorithm>

#include "benchmark/scenes/scene.hpp"
#include "benchmark/scenes/tool_motions.hpp"
#include "geometry/distance/surface_touch.hpp"
#include "stopwatch.hpp"

namespace organ_collision::bench {
namespace {

constexpr std::size_t kFaces = 1224;
constexpr double kTipStep = 0.001;  // [m] in a step, sideways at the point aimed at: 1 m/s at 1 kHz
constexpr double kJawStep = 0.02;   // [rad] of each jaw in a step
constexpr double kJawOpening = 0.3;  // [rad] at the start of a step
constexpr double kReach =
    0.024;  // [m] from the end of the shaft to the point that the motions aim at

ShaftAxis drawn_back(ShaftAxis axis) {
  axis.tip -= kReach * (axis.tip - axis.trocar).normalized();
  return axis;
}

std::vector<ToolPath> make_paths(const OrganSurface& surface) {
  SceneScale scale(kFaces);
  scale.tip_step = kTipStep;
  ToolMotions motions(surface, scale);
  std::vector<ToolPath> paths;
  for (std::size_t i = 0; i < step_count(kFaces); ++i) {
    const ShaftMotion motion = motions.next(surface.vertices);
    paths.push_back({Grasper::place(0.0, drawn_back(motion.start), kJawOpening),
                     Grasper::place(1.0, drawn_back(motion.end), kJawOpening - kJawStep)});
  }
  return paths;
}

bool touches(const LinkPart& part, const RigidMotion& motion, const Triangle& face) {
  const FaceMotion resting{face, face};
  if (!part.surface) return first_touch({part.core, motion}, resting, part.radius).has_value();
  for (std::size_t i = 0; i < part.surface->faces().size(); ++i) {
    const ConvexCore triangle(part.surface->triangle(i));
    if (first_touch({triangle, motion}, resting, part.radius)) return true;
  }
  return false;
}

}  // namespace

GrasperMeasurement::GrasperMeasurement()
    : surface_(make_organ(kFaces)),
      organ_(surface_.vertices, surface_.triangles),
      links_(Grasper::make_links()),
      paths_(make_paths(surface_)),
      fcl_(surface_, links_) {
  check();
}

CollisionRequest GrasperMeasurement::request(const ToolPath& path, QueryMode mode) const {
  CollisionRequest request;
  request.organ = &organ_;
  request.path = path;
  request.radius = Grasper::kRadius;
  request.links = &links_;
  request.mode = mode;
  return request;
}

/// Tests every face against every part.
Answer GrasperMeasurement::brute_force(const ToolPath& path, QueryMode mode) const {
  const ToolWaypoint& to = path.back();
  const ToolWaypoint& from = mode == QueryMode::kSwept ? path.front() : to;
  Answer answer;
  for (std::uint32_t face = 0; face < organ_.face_count(); ++face) {
    const Triangle corners = organ_.triangle(face);
    bool touched =
        first_touch(ShaftMotion{from.axis, to.axis}, {corners, corners}, Grasper::kRadius)
            .has_value();
    for (std::size_t link = 0; link < links_.size() && !touched; ++link) {
      const RigidMotion motion(from.links[link], to.links[link]);
      for (const LinkPart& part : links_[link].parts) {
        touched = touched || touches(part, motion, corners);
      }
    }
    if (touched) answer.faces.push_back(face);
  }
  return answer;
}

void GrasperMeasurement::check() {
  constexpr std::size_t kChecked = 16;
  const auto add = [](CheckSummary& summary, const std::vector<std::uint32_t>& found,
                      const Answer& answer, double share) {
    summary.add(compare(found, answer));
    summary.hits += share * static_cast<double>(answer.faces.size());
  };
  for (std::size_t i = 0; i < kChecked; ++i) {
    for (const QueryMode mode : {QueryMode::kStatic, QueryMode::kSwept}) {
      const Answer answer = brute_force(paths_[i], mode);
      query_.evaluate(request(paths_[i], mode), result_);
      faces_.clear();
      for (const FaceContact& contact : result_.contacts) faces_.push_back(contact.face);
      faces_.erase(std::unique(faces_.begin(), faces_.end()), faces_.end());
      add(summary_, faces_, answer, 0.5 / kChecked);
      if (mode == QueryMode::kStatic) {
        fcl_.query(paths_[i].back(), faces_);
        add(fcl_summary_, faces_, answer, 1.0 / kChecked);
      }
    }
  }
}

double GrasperMeasurement::query(QueryMode mode) {
  const CollisionRequest next = request(paths_[next_++ % paths_.size()], mode);
  Stopwatch watch;
  query_.evaluate(next, result_);
  return watch.lap();
}

double GrasperMeasurement::fcl_static_query() {
  const ToolPath& path = paths_[next_++ % paths_.size()];
  Stopwatch watch;
  fcl_.query(path.back(), faces_);
  return watch.lap();
}

}  // namespace organ_collision::bench
