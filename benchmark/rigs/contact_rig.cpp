#include "contact_rig.hpp"

#include <algorithm>
#include <utility>

#include "benchmark/engines/shared_context.hpp"
#include "query/contact_refiner.hpp"
#include "stopwatch.hpp"

namespace organ_collision::bench {
namespace {

constexpr QueryMode kBoth[] = {QueryMode::kStatic, QueryMode::kSwept};

/// Of a step of one leg, for one face.
std::optional<FaceContact> refine_whole(const VolumeQuery& tool, const Triangle& before,
                                        const Triangle& now) {
  return refine({tool.motion, tool.radius, {tool.motion.end}}, {{before, now}, 0.0, 1.0, now});
}

}  // namespace

ContactRig::ContactRig(const Scene& scene)
    : scene_(scene),
      organ_(scene.shapes.back(), scene.organ.triangles),
      before_(organ_),
      picker_(make_picker(PickerKind::kFeedback, shared_context())) {
  const std::size_t affordable = std::max<std::size_t>(200'000 / scene.organ.face_count(), 1);
  const std::size_t steps = std::min(scene.steps.size(), affordable);
  check(steps, false);
  check(steps, true);
  findings_.hits /= 4.0 * static_cast<double>(steps);
}

void ContactRig::move_organ(const SceneStep& step) {
  std::swap(organ_, before_);
  organ_.move_vertices(scene_.shapes[step.shape]);
}

CollisionRequest ContactRig::request(const SceneStep& step, QueryMode mode,
                                     bool organ_moves) const {
  const VolumeQuery& tool = step.swept.query;
  CollisionRequest request;
  request.organ = &organ_;
  if (organ_moves && mode == QueryMode::kSwept) request.organ_before = &before_;
  request.path = {{0.0, tool.motion.start}, {1.0, tool.motion.end}};
  request.radius = tool.radius;
  request.mode = mode;
  return request;
}

void ContactRig::check(std::size_t steps, bool organ_moves) {
  for (std::size_t i = 0; i < steps; ++i) {
    const SceneStep& step = scene_.steps[i];
    move_organ(step);
    for (const QueryMode mode : kBoth) {
      const bool swept = mode == QueryMode::kSwept;
      const VolumeQuery& tool = swept ? step.swept.query : step.fixed.query;
      Answer answer;
      for (std::uint32_t face = 0; face < organ_.face_count(); ++face) {
        const Triangle now = organ_.triangle(face);
        const Triangle before = organ_moves && swept ? before_.triangle(face) : now;
        if (refine_whole(tool, before, now)) answer.faces.push_back(face);
      }
      query_.evaluate(request(step, mode, organ_moves), result_);
      std::vector<std::uint32_t> found;
      for (const FaceContact& contact : result_.contacts) found.push_back(contact.face);
      const Errors errors = compare(found, answer);
      findings_.errors.missed += errors.missed;
      findings_.errors.wrong += errors.wrong;
      findings_.hits += static_cast<double>(answer.faces.size());
    }
  }
}

ContactRig::Timed ContactRig::contacts(bool organ_moves) {
  const SceneStep& step = scene_.steps[next_++ % scene_.steps.size()];
  move_organ(step);
  Timed timed{0.0, 0};
  for (const CheckedQuery* checked : {&step.fixed, &step.swept}) {
    const bool moves = organ_moves && checked == &step.swept;
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

ContactRig::Timed ContactRig::step(bool organ_moves) {
  const SceneStep& step = scene_.steps[next_++ % scene_.steps.size()];
  CollisionRequest fixed = request(step, QueryMode::kStatic, organ_moves);
  CollisionRequest swept = request(step, QueryMode::kSwept, organ_moves);
  Timed timed{0.0, 0};
  Stopwatch watch;
  move_organ(step);
  for (const CollisionRequest* request : {&fixed, &swept}) {
    query_.evaluate(*request, result_);
    timed.contacts += result_.contacts.size();
  }
  timed.seconds = watch.lap();
  return timed;
}

}  // namespace organ_collision::bench
