#include "grasper_cases.hpp"

#include <algorithm>

#include "benchmark/scenes/scene.hpp"
#include "cases.hpp"
#include "geometry/distance/first_touch.hpp"
#include "query/make_request.hpp"

namespace organ_collision::bench {
namespace {

constexpr std::size_t kFaces = 1224;
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
      motions_(grasper_motions(surface_, step_count(kFaces))),
      fcl_(surface_, motions_.radius, motions_.links) {
  check();
}

CollisionRequest GrasperMeasurement::request(const ToolPath& path, QueryMode mode) const {
  return make_request({&organ_}, {motions_.radius, &motions_.links}, {mode}, path);
}

/// Tests every face against every part.
Answer GrasperMeasurement::brute_force(const ToolPath& path, QueryMode mode) const {
  const ToolWaypoint& to = path.back();
  const ToolWaypoint& from = mode == QueryMode::kSwept ? path.front() : to;
  Answer answer;
  for (std::uint32_t face = 0; face < organ_.face_count(); ++face) {
    const Triangle corners = organ_.triangle(face);
    bool touched = first_touch(ShaftMotion{from.axis, to.axis}, {corners, corners}, motions_.radius)
                       .has_value();
    for (std::size_t link = 0; link < motions_.links.size() && !touched; ++link) {
      const RigidMotion motion(from.links[link], to.links[link]);
      for (const LinkPart& part : motions_.links[link].parts) {
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
      const Answer answer = brute_force(motions_.paths[i], mode);
      query_.evaluate(request(motions_.paths[i], mode), result_);
      faces_.clear();
      for (const FaceContact& contact : result_.contacts) faces_.push_back(contact.face);
      faces_.erase(std::unique(faces_.begin(), faces_.end()), faces_.end());
      add(summary_, faces_, answer, 0.5 / kChecked);
      if (mode == QueryMode::kStatic) {
        fcl_.query(motions_.paths[i].back(), faces_);
        add(fcl_summary_, faces_, answer, 1.0 / kChecked);
      }
    }
  }
}

double GrasperMeasurement::query(QueryMode mode) {
  const CollisionRequest next = request(motions_.paths[next_++ % motions_.paths.size()], mode);
  Stopwatch watch;
  query_.evaluate(next, result_);
  return watch.lap();
}

double GrasperMeasurement::fcl_static_query() {
  const ToolPath& path = motions_.paths[next_++ % motions_.paths.size()];
  Stopwatch watch;
  fcl_.query(path.back(), faces_);
  return watch.lap();
}

namespace {

struct PartEntry {
  const char* name;
  double (GrasperMeasurement::*run)();
  const CheckSummary& (GrasperMeasurement::*summary)() const;
};

constexpr PartEntry kParts[] = {
    {"grasper_static/ours/1224", &GrasperMeasurement::static_query, &GrasperMeasurement::summary},
    {"grasper_swept/ours/1224", &GrasperMeasurement::swept_query, &GrasperMeasurement::summary},
    {"grasper_static/fcl/1224", &GrasperMeasurement::fcl_static_query,
     &GrasperMeasurement::fcl_summary},
};

}  // namespace

void add_grasper_cases(MeasurementCache& cache) {
  for (const PartEntry& part : kParts) {
    add_case(part.name, step_count(1224), [&cache, part](benchmark::State& state) {
      GrasperMeasurement& measurement = cache.grasper();
      for ([[maybe_unused]] const auto _ : state) {
        state.SetIterationTime((measurement.*part.run)());
      }
      count_errors((measurement.*part.summary)(), state);
    });
  }
}

}  // namespace organ_collision::bench
