#include "scripted_organ.hpp"

#include <cmath>
#include <utility>

namespace organ_collision::oracle {
namespace {

using Eigen::Vector3d;

constexpr double kTick = 1e-3;  // [s]

}  // namespace

OrganMotion random_motion(double speed, double reach, Random& random) {
  OrganMotion motion;
  const double shares[] = {random.uniform(0.1, 1.0), random.uniform(0.1, 1.0),
                           random.uniform(0.1, 1.0)};
  const double share = speed / (shares[0] + shares[1] + shares[2]);
  const double sway = random.scale(1e-3, 0.02), turn = random.scale(0.01, 0.15);
  const double wave = random.scale(2e-4, 5e-3);
  motion.sway = sway * random.direction();
  motion.sway_rate = shares[0] * share / sway;
  motion.turn = turn * random.direction();
  motion.turn_rate = shares[1] * share / (turn * reach);
  motion.wave = wave * random.direction();
  motion.wave_rate = shares[2] * share / wave;
  motion.wave_number = random.uniform(20.0, 60.0) * random.direction();
  motion.ticks_per_shape = static_cast<int>(random.scale(1.0, 100.0));
  motion.moves_frame = random.chance(0.3);
  return motion;
}

ScriptedOrgan::ScriptedOrgan(std::string name, const GridSurface& rest, const OrganMotion& motion)
    : rest_(rest),
      motion_(motion),
      topology_(std::make_shared<SurfaceTopology>(rest.faces, rest.vertices)) {
  organ_.topology = topology_.get();
  organ_.name = std::move(name);
  organ_.shape = std::make_shared<TriangleMesh>(rest.vertices, rest.triangles());
  move_vertices(0.0);
}

ProxyOrgan ScriptedOrgan::at(long tick) {
  const long shape = tick / motion_.ticks_per_shape;
  if (shape != shape_ && motion_.changes_shape()) {
    shape_ = shape;
    move_vertices(kTick * static_cast<double>(shape * motion_.ticks_per_shape));
  }
  if (motion_.moves_frame) {
    organ_.T_organ_proxy = rigid(kTick * static_cast<double>(tick)).inverse();
  }
  return organ_;
}

Eigen::Isometry3d ScriptedOrgan::rigid(double seconds) const {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  const double angle = motion_.turn.norm();
  if (angle > 0.0) {
    pose.rotate(
        Eigen::AngleAxisd(angle * std::sin(motion_.turn_rate * seconds), motion_.turn / angle));
  }
  pose.translation() = std::sin(motion_.sway_rate * seconds) * motion_.sway;
  return pose;
}

void ScriptedOrgan::move_vertices(double seconds) {
  const Eigen::Isometry3d pose =
      motion_.moves_frame ? Eigen::Isometry3d::Identity() : rigid(seconds);
  const bool waves = !motion_.wave.isZero();
  std::vector<float> vertices = rest_.vertices;
  for (std::size_t i = 0; i < vertices.size(); i += 3) {
    Eigen::Map<Eigen::Vector3f> vertex(&vertices[i]);
    Vector3d at = vertex.cast<double>();
    if (waves) {
      at += std::sin(motion_.wave_number.dot(at) + motion_.wave_rate * seconds) * motion_.wave;
    }
    vertex = (pose * at).cast<float>();
  }
  const auto shape = std::make_shared<TriangleMesh>(*organ_.shape);
  shape->move_vertices(std::move(vertices));
  organ_.shape = shape;
}

}  // namespace organ_collision::oracle
