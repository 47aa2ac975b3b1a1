#include "contact_cases.hpp"

#include <algorithm>
#include <utility>

#include "cases.hpp"
#include "query/make_request.hpp"
#include "query/moving_part.hpp"

namespace organ_collision::bench {
namespace {

constexpr QueryMode kModes[] = {QueryMode::kStatic, QueryMode::kSwept};

/// The contact of one face in a step with a single leg.
std::optional<FaceContact> refine_whole(const VolumeQuery& tool, const Triangle& before,
                                        const Triangle& now) {
  const auto touch = first_touch(tool.motion, {before, now}, tool.radius);
  if (!touch) return std::nullopt;
  const MovingShaft part(tool.motion, tool.radius, tool.motion.end);
  return part.contact(*touch, {before, now}, now);
}

}  // namespace

ContactMeasurement::ContactMeasurement(const Scene& scene)
    : scene_(scene),
      organ_(scene.shapes.back(), scene.organ.triangles),
      before_(organ_),
      picker_(make_picker(PickerKind::kFeedback)) {
  const std::size_t affordable = std::max<std::size_t>(200'000 / scene.organ.face_count(), 1);
  const std::size_t steps = std::min(scene.steps.size(), affordable);
  check(steps, false);
  check(steps, true);
  summary_.hits /= 4.0 * static_cast<double>(steps);
}

void ContactMeasurement::move_organ(const SceneStep& step) {
  std::swap(organ_, before_);
  organ_.move_vertices(scene_.shapes[step.shape]);
}

CollisionRequest ContactMeasurement::request(const SceneStep& step, QueryMode mode,
                                             bool organ_moves) const {
  const VolumeQuery& tool = step.swept_query.query;
  return make_request({&organ_, organ_moves ? &before_ : nullptr}, {tool.radius}, {mode},
                      {{0.0, tool.motion.start}, {1.0, tool.motion.end}});
}

void ContactMeasurement::check(std::size_t steps, bool organ_moves) {
  for (std::size_t i = 0; i < steps; ++i) {
    const SceneStep& step = scene_.steps[i];
    move_organ(step);
    for (const QueryMode mode : kModes) {
      const bool swept = mode == QueryMode::kSwept;
      const VolumeQuery& tool = swept ? step.swept_query.query : step.static_query.query;
      Answer answer;
      for (std::uint32_t face = 0; face < organ_.face_count(); ++face) {
        const Triangle now = organ_.triangle(face);
        const Triangle before = organ_moves && swept ? before_.triangle(face) : now;
        if (refine_whole(tool, before, now)) answer.faces.push_back(face);
      }
      query_.evaluate(request(step, mode, organ_moves), result_);
      std::vector<std::uint32_t> found;
      for (const FaceContact& contact : result_.contacts) found.push_back(contact.face);
      summary_.add(compare(found, answer));
      summary_.hits += static_cast<double>(answer.faces.size());
    }
  }
}

ContactMeasurement::Timed ContactMeasurement::contacts(bool organ_moves) {
  const SceneStep& step = scene_.steps[next_++ % scene_.steps.size()];
  move_organ(step);
  Timed timed{0.0, 0};
  for (const CheckedQuery* checked : {&step.static_query, &step.swept_query}) {
    const bool moves = organ_moves && checked == &step.swept_query;
    const VolumeQuery& tool = checked->query;
    const OrganMotion organ =
        moves ? OrganMotion(before_, before_.block_boxes(), organ_, 0.0, 1.0) : OrganMotion(organ_);
    picker_->pick(PartSweep(tool.motion, tool.radius), organ, candidates_);
    Stopwatch watch;
    for (const Candidate& candidate : candidates_) {
      const Triangle now = organ_.triangle(candidate.face);
      const Triangle before = moves ? before_.triangle(candidate.face) : now;
      timed.contacts += refine_whole(tool, before, now).has_value();
    }
    timed.seconds += watch.lap();
  }
  return timed;
}

ContactMeasurement::Timed ContactMeasurement::step(bool organ_moves) {
  const SceneStep& step = scene_.steps[next_++ % scene_.steps.size()];
  const CollisionRequest static_request = request(step, QueryMode::kStatic, organ_moves);
  const CollisionRequest swept_request = request(step, QueryMode::kSwept, organ_moves);
  Timed timed{0.0, 0};
  Stopwatch watch;
  move_organ(step);
  for (const CollisionRequest* request : {&static_request, &swept_request}) {
    query_.evaluate(*request, result_);
    timed.contacts += result_.contacts.size();
  }
  timed.seconds = watch.lap();
  return timed;
}

namespace {

struct PartEntry {
  const char* name;
  bool organ_moves;
  ContactMeasurement::Timed (ContactMeasurement::*run)(bool);
};

constexpr PartEntry kParts[] = {
    {"contacts", false, &ContactMeasurement::contacts},
    {"contacts_moving", true, &ContactMeasurement::contacts},
    {"step_contacts", false, &ContactMeasurement::step},
    {"step_moving", true, &ContactMeasurement::step},
};

}  // namespace

void add_contact_cases(MeasurementCache& cache, const SceneKey& key) {
  for (const PartEntry& part : kParts) {
    const auto run = [&cache, part, key](benchmark::State& state) {
      ContactMeasurement& measurement = cache.contacts(key);
      std::size_t contacts = 0;
      for ([[maybe_unused]] const auto _ : state) {
        const ContactMeasurement::Timed timed = (measurement.*part.run)(part.organ_moves);
        state.SetIterationTime(timed.seconds);
        contacts += timed.contacts;
      }
      count_errors(measurement.summary(), state);
      state.counters["contacts"] =
          benchmark::Counter(static_cast<double>(contacts), benchmark::Counter::kAvgIterations);
    };
    add_case(case_name(part.name, "ours", key), step_count(key.faces), run);
  }
}

}  // namespace organ_collision::bench
