#include "scene.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <memory>
#include <random>
#include <utility>

#include "tool_motions.hpp"

namespace organ_collision::bench {
namespace {

using Eigen::Vector3d;

// With so few shapes, each is in the third-level cache when it is used. This is also the case for a
// shape that a message has just delivered.
constexpr std::size_t kShapes = 4;
constexpr double kPi = 3.14159265358979323846;

Eigen::AlignedBox3d box_of(const std::vector<SharedVertices>& shapes) {
  Eigen::AlignedBox3f box;
  for (const SharedVertices& shape : shapes) {
    for (std::size_t i = 0; i < shape->size(); i += 3) {
      box.extend(Eigen::Map<const Eigen::Vector3f>(&(*shape)[i]));
    }
  }
  const Vector3d air = Vector3d::Constant(1e-3);
  return {box.min().cast<double>() - air, box.max().cast<double>() + air};
}

SceneStep make_step(const Scene& scene, std::size_t shape, const ShaftMotion& motion, double radius,
                    const Eigen::AlignedBox3d& box) {
  const auto checked = [&](const VolumeQuery& query) {
    return CheckedQuery{query, brute_force_answer(query, scene.organ, *scene.shapes[shape])};
  };
  return {shape, checked({{motion.end, motion.end}, radius, box}), checked({motion, radius, box})};
}

bool has_usual_hits(const SceneStep& step, std::size_t faces) {
  const std::size_t low = faces == 4 ? 0 : 5, high = faces == 4 ? 3 : 25;
  const auto usual = [&](const CheckedQuery& query) {
    return query.answer.faces.size() >= low && query.answer.faces.size() <= high;
  };
  return usual(step.static_query) && usual(step.swept_query);
}

Answer renumbered(Answer answer, const Shuffle& shuffle) {
  for (std::vector<std::uint32_t>* faces : {&answer.faces, &answer.close}) {
    for (std::uint32_t& face : *faces) face = shuffle.face[face];
    std::sort(faces->begin(), faces->end());
  }
  return answer;
}

}  // namespace

std::size_t step_count(std::size_t faces) { return faces < 100'000 ? 64 : 8; }

Scene::Scene(std::size_t faces) : organ(make_organ(faces)) {
  const SceneScale scale(faces);
  for (std::size_t i = 0; i < kShapes; ++i) {
    shapes.push_back(std::make_shared<std::vector<float>>(
        deformed(organ.vertices, 2.0 * kPi * i / kShapes, scale.organ_step)));
  }
  const Eigen::AlignedBox3d box = box_of(shapes);
  ToolMotions motions(organ, scale);
  while (steps.size() < step_count(faces)) {
    const std::size_t shape = steps.size() % kShapes;
    const ShaftMotion motion = motions.next(*shapes[shape]);
    SceneStep step = make_step(*this, shape, motion, scale.radius, box);
    if (!has_usual_hits(step, faces)) continue;
    steps.push_back(std::move(step));
    rigid_steps.push_back(make_step(*this, 0, motion, scale.radius, box));
  }
}

Scene Scene::shuffled() const {
  std::mt19937 random(1224);
  const Shuffle shuffle(organ, random);
  Scene scene = *this;
  scene.organ = shuffle.apply(organ);
  for (SharedVertices& shape : scene.shapes) {
    shape = std::make_shared<std::vector<float>>(shuffle.apply(*shape));
  }
  for (std::vector<SceneStep>* all : {&scene.steps, &scene.rigid_steps}) {
    for (SceneStep& step : *all) {
      step.static_query.answer = renumbered(std::move(step.static_query.answer), shuffle);
      step.swept_query.answer = renumbered(std::move(step.swept_query.answer), shuffle);
    }
  }
  return scene;
}

}  // namespace organ_collision::bench
