#include "scene.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

namespace organ_collision::bench {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kShapes = 8;
constexpr double kPi = 3.14159265358979323846;
constexpr double kDepth = 0.012;  // [m] from the point where the axis enters the organ to the tip

/// What moves within a step, and how thick the tool is [m].
struct Sizes {
  explicit Sizes(std::size_t faces)
      : radius(0.005 * std::sqrt(1224.0 / std::max<std::size_t>(faces, 1224))) {}
  double radius;
  double tip_step = 2.0 * radius;
  double organ_step = 0.4 * radius;  ///< radius of the circle on which each vertex goes round
};

std::size_t step_count(std::size_t faces) { return faces < 100'000 ? 64 : 16; }

Eigen::AlignedBox3d box_of(const std::vector<std::vector<float>>& shapes) {
  Eigen::AlignedBox3f box;
  for (const std::vector<float>& shape : shapes) {
    for (std::size_t i = 0; i < shape.size(); i += 3) {
      box.extend(Eigen::Map<const Eigen::Vector3f>(&shape[i]));
    }
  }
  const Vector3d air = Vector3d::Constant(1e-3);
  return {box.min().cast<double>() - air, box.max().cast<double>() + air};
}

/// Motions of a tool that enters through one of four trocars above the organ, pierces a face that
/// looks towards it, and moves sideways.
class Surgeon {
 public:
  Surgeon(const OrganSurface& organ, const Sizes& sizes) : organ_(organ), sizes_(sizes) {}

  ShaftMotion motion(const std::vector<float>& vertices) {
    while (true) {
      const Vector3d trocar(choose(0.1), choose(0.06), 0.15);
      const Triangle face = corners(organ_, vertices, random_() % organ_.face_count());
      const Vector3d entry = (face[0] + face[1] + face[2]) / 3.0;
      const Vector3d outward = (face[1] - face[0]).cross(face[2] - face[0]).normalized();
      const Vector3d inward = (entry - trocar).normalized();
      if (outward.dot(inward) > -0.5) continue;
      const Vector3d tip = entry + kDepth * inward;
      const Vector3d side = inward.cross(Vector3d(symmetric(), symmetric(), symmetric()));
      return {{trocar, tip - sizes_.tip_step * side.normalized()}, {trocar, tip}};
    }
  }

 private:
  double choose(double value) { return random_() % 2 == 0 ? value : -value; }
  double symmetric() { return std::uniform_real_distribution<double>(-1.0, 1.0)(random_); }

  const OrganSurface& organ_;
  Sizes sizes_;
  std::mt19937 random_{1999};
};

SceneStep make_step(const Scene& scene, std::size_t shape, const ShaftMotion& motion, double radius,
                    const Eigen::AlignedBox3d& box) {
  const auto checked = [&](const VolumeQuery& query) {
    return CheckedQuery{query, oracle(query, scene.organ, scene.shapes[shape])};
  };
  return {shape, checked({{motion.end, motion.end}, radius, box}), checked({motion, radius, box})};
}

bool has_usual_hits(const SceneStep& step, std::size_t faces) {
  const std::size_t low = faces == 4 ? 0 : 5, high = faces == 4 ? 3 : 25;
  const auto usual = [&](const CheckedQuery& query) {
    return query.answer.faces.size() >= low && query.answer.faces.size() <= high;
  };
  return usual(step.fixed) && usual(step.swept);
}

Answer renumbered(Answer answer, const Shuffle& shuffle) {
  for (std::vector<std::uint32_t>* faces : {&answer.faces, &answer.close}) {
    for (std::uint32_t& face : *faces) face = shuffle.face[face];
    std::sort(faces->begin(), faces->end());
  }
  return answer;
}

}  // namespace

Scene::Scene(std::size_t faces) : organ(make_organ(faces)) {
  const Sizes sizes(faces);
  for (std::size_t i = 0; i < kShapes; ++i) {
    shapes.push_back(deformed(organ.vertices, 2.0 * kPi * i / kShapes, sizes.organ_step));
  }
  const Eigen::AlignedBox3d box = box_of(shapes);
  Surgeon surgeon(organ, sizes);
  while (steps.size() < step_count(faces)) {
    const std::size_t shape = steps.size() % kShapes;
    const ShaftMotion motion = surgeon.motion(shapes[shape]);
    SceneStep step = make_step(*this, shape, motion, sizes.radius, box);
    if (!has_usual_hits(step, faces)) continue;
    steps.push_back(std::move(step));
    rigid_steps.push_back(make_step(*this, 0, motion, sizes.radius, box));
  }
}

Scene Scene::shuffled() const {
  std::mt19937 random(1224);
  const Shuffle shuffle(organ, random);
  Scene scene = *this;
  scene.organ = shuffle.apply(organ);
  for (std::vector<float>& shape : scene.shapes) shape = shuffle.apply(shape);
  for (std::vector<SceneStep>* all : {&scene.steps, &scene.rigid_steps}) {
    for (SceneStep& step : *all) {
      step.fixed.answer = renumbered(std::move(step.fixed.answer), shuffle);
      step.swept.answer = renumbered(std::move(step.swept.answer), shuffle);
    }
  }
  return scene;
}

}  // namespace organ_collision::bench
