#include "scenes.hpp"

#include <algorithm>
#include <stdexcept>

#include "surfaces.hpp"
#include "test/closed_surfaces.hpp"

namespace organ_collision::oracle {
namespace {

using Eigen::Vector3d;

enum class Tissue { kClosed, kFolds, kPockets, kTube, kClosedOrFolds, kTwo };
enum class Tool { kShaft, kShaftWithJaws, kBall, kFreeShaft, kBoxJaws, kBallJaws, kMeshJaws };

struct Kind {
  const char* name;
  Tissue tissue;
  Tool tool;
  bool moves;
};

constexpr Kind kKinds[] = {
    {"closed", Tissue::kClosed, Tool::kShaft, false},
    {"folds", Tissue::kFolds, Tool::kShaft, false},
    {"pockets", Tissue::kPockets, Tool::kShaft, false},
    {"tube", Tissue::kTube, Tool::kShaft, false},
    {"closed moving", Tissue::kClosed, Tool::kShaft, true},
    {"folds moving", Tissue::kFolds, Tool::kShaft, true},
    {"tube moving", Tissue::kTube, Tool::kShaft, true},
    {"two moving", Tissue::kTwo, Tool::kShaft, true},
    {"shaft with jaws", Tissue::kClosedOrFolds, Tool::kShaftWithJaws, false},
    {"free ball", Tissue::kClosedOrFolds, Tool::kBall, false},
    {"free shaft", Tissue::kClosedOrFolds, Tool::kFreeShaft, false},
    {"free box jaws", Tissue::kClosedOrFolds, Tool::kBoxJaws, false},
    {"free ball jaws", Tissue::kClosedOrFolds, Tool::kBallJaws, false},
    {"free mesh jaws", Tissue::kClosedOrFolds, Tool::kMeshJaws, false},
    {"free ball moving", Tissue::kClosedOrFolds, Tool::kBall, true},
    {"free shaft moving", Tissue::kClosedOrFolds, Tool::kFreeShaft, true},
    {"free box jaws moving", Tissue::kClosedOrFolds, Tool::kBoxJaws, true},
};

double any_radius(Random& random) {
  constexpr double kRadii[] = {1.5e-3, 3e-3, 5e-3};
  return kRadii[random.integer(0, 2)];
}

// The jaws are 16 mm long and point away from the shaft.

Eigen::Isometry3d jaw_middle() { return Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, -0.01)); }

LinkPart ellipsoid_mesh() {
  const GridSurface ball = sphere(5, 8, 1.0);
  std::vector<Vector3d> vertices;
  for (std::size_t i = 0; i < ball.vertices.size(); i += 3) {
    const Vector3d at(ball.vertices[i], ball.vertices[i + 1], ball.vertices[i + 2]);
    vertices.push_back(jaw_middle() * at.cwiseProduct(Vector3d(2e-3, 1.5e-3, 8e-3)));
  }
  return LinkPart::mesh({vertices, ball.faces});
}

std::vector<LinkPart> jaw_parts(Tool tool) {
  switch (tool) {
    case Tool::kBallJaws: {
      std::vector<LinkPart> balls;
      for (const double z : {-4e-3, -8e-3, -12e-3, -16e-3}) {
        balls.push_back(LinkPart::sphere({0.0, 0.0, z}, 2e-3));
      }
      return balls;
    }
    case Tool::kMeshJaws:
      return {ellipsoid_mesh()};
    default:
      return {LinkPart::box(jaw_middle(), {4e-3, 3e-3, 16e-3})};
  }
}

void add_jaws(HandScript& hand, Tool tool, Random& random) {
  hand.tool.links = {{"left jaw", jaw_parts(tool)}, {"right jaw", jaw_parts(tool)}};
  hand.jaw_angle = random.uniform(0.1, 0.8);
  hand.jaw_rate = random.scale(0.5, 10.0);
}

void set_tool(HandScript& hand, Tool tool, Random& random) {
  hand.tool.radius = any_radius(random);
  if (tool == Tool::kShaft) return;
  if (tool == Tool::kShaftWithJaws) return add_jaws(hand, tool, random);
  hand.tool.freedom = ProxyFreedom::kFree;
  hand.turn_rate = random.scale(0.1, 2.0);
  if (tool == Tool::kFreeShaft) hand.shaft_length = random.uniform(0.02, 0.08);
  if (tool == Tool::kBall || tool == Tool::kFreeShaft) return;
  hand.tool.radius = 0.0;
  add_jaws(hand, tool, random);
}

/// A hand whose trocar is above an organ at the origin.
HandScript make_hand(const Kind& kind, Random& random) {
  HandScript hand;
  set_tool(hand, kind.tool, random);
  hand.reach = {Vector3d(-0.08, -0.05, -0.06), Vector3d(0.08, 0.05, 0.08)};
  hand.speed = random.scale(0.3, 1.0);
  hand.start = Vector3d(0.0, 0.0, hand.tool.freedom == ProxyFreedom::kFree ? 0.2 : 0.12);
  hand.trocar = Vector3d(0.0, 0.0, 0.2) + random.point(0.02);
  if (kind.moves) {
    hand.trocar_sway = random.scale(1e-3, 5e-3) * random.direction();
    hand.trocar_rate = random.scale(0.3, 5.0);
  }
  return hand;
}

GridSurface layers(Random& random) {
  return folded_sheet(random.integer(2, 5), random.uniform(1e-3, 3e-3), 0.09);
}

GridSurface make_surface(Tissue tissue, Random& random) {
  switch (tissue) {
    case Tissue::kFolds:
    case Tissue::kPockets:
      return layers(random);
    case Tissue::kTube:
      return bent_tube(random.uniform(8e-3, 0.02), random);
    case Tissue::kClosedOrFolds:
      return random.chance(0.5) ? layers(random) : bumpy_organ(random);
    default:
      return bumpy_organ(random);
  }
}

/// The tool comes from the side, and fits between the layers.
void reach_into_pockets(HandScript& hand, Random& random) {
  hand.tool.radius = 0.4e-3;
  hand.trocar = Vector3d(0.15, 0.0, 0.0) + random.point(0.01);
  hand.start = Vector3d(0.08, 0.0, 0.0);
  hand.reach = {Vector3d(-0.05, -0.05, -0.015), Vector3d(0.08, 0.05, 0.01)};
}

void reach_into_tube(HandScript& hand, Random& random) {
  hand.trocar = Vector3d(0.0, 0.0, 0.2) + random.point(2e-3);
  hand.start = Vector3d(0.0, 0.0, 0.15);
  hand.reach = {Vector3d(-0.04, -0.04, -0.1), Vector3d(0.04, 0.04, 0.1)};
}

OrganMotion make_motion(const Kind& kind, Random& random) {
  constexpr double kSpeed = 0.5;   // [m/s] the fastest organ
  constexpr double kReach = 0.13;  // [m] of an organ's vertices from the origin, at most
  return kind.moves ? random_motion(random.scale(0.01, kSpeed), kReach, random) : OrganMotion{};
}

}  // namespace

const std::vector<std::string>& proxy_scene_kinds() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Kind& kind : kKinds) all.emplace_back(kind.name);
    return all;
  }();
  return names;
}

ProxyScene make_proxy_scene(const std::string& name, Random& random) {
  const auto kind = std::find_if(std::begin(kKinds), std::end(kKinds),
                                 [&](const Kind& known) { return name == known.name; });
  if (kind == std::end(kKinds)) throw std::out_of_range("there is no kind of scene " + name);
  ProxyScene scene{{}, make_hand(*kind, random), {}};
  if (kind->tissue == Tissue::kPockets) reach_into_pockets(scene.hand, random);
  if (kind->tissue == Tissue::kTube) reach_into_tube(scene.hand, random);
  scene.hand.jumps = random.chance(0.5);
  scene.organs.emplace_back("organ", make_surface(kind->tissue, random),
                            make_motion(*kind, random));
  if (kind->tissue == Tissue::kTwo) {
    scene.organs.emplace_back("sheet", layers(random), make_motion(*kind, random));
  }
  return scene;
}

}  // namespace organ_collision::oracle
