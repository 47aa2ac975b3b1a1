#include "scenes.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "test/closed_surfaces.hpp"

namespace organ_collision::oracle {
namespace {

using Eigen::Vector3d;

/// The points of the folded sheet for y = 0, from its upper end to its lower one.
std::vector<Vector3d> folded_curve(int layers, double gap, double width) {
  constexpr int kBend = 4;
  const int cells = static_cast<int>(std::ceil(width / 5e-3));
  std::vector<Vector3d> curve;
  for (int layer = 0; layer < layers; ++layer) {
    const double side = layer % 2 == 0 ? 1.0 : -1.0, z = -gap * layer;
    for (int i = 0; i <= cells; ++i) {
      curve.emplace_back(side * width * (static_cast<double>(i) / cells - 0.5), 0.0, z);
    }
    for (int i = 1; i < kBend && layer + 1 < layers; ++i) {
      const double angle = M_PI * i / kBend;
      curve.emplace_back(side * 0.5 * (width + gap * std::sin(angle)), 0.0,
                         z - 0.5 * gap * (1.0 - std::cos(angle)));
    }
  }
  return curve;
}

/// A closed bumpy organ, about 0.18 m long and 0.06 m high, of 150 to 4500 faces. It points
/// outward.
GridSurface bumpy_organ(Random& random) {
  const int rings = static_cast<int>(random.scale(6, 48));
  GridSurface organ = sphere(rings, 2 * rings, 1.0);
  const double phase = random.uniform(0.0, 2 * M_PI), height = random.uniform(0.0, 0.15);
  const Vector3d radii(0.09, random.uniform(0.04, 0.06), random.uniform(0.025, 0.04));
  for (std::size_t i = 0; i < organ.vertices.size(); i += 3) {
    float* const at = &organ.vertices[i];
    const double bump = 1.0 + height * std::sin(4.0 * at[0] + phase) * std::cos(5.0 * at[1]);
    for (int k = 0; k < 3; ++k) at[k] = static_cast<float>(bump * radii[k] * at[k]);
  }
  return organ;
}

/// A thin sheet, folded into horizontal layers that are `gap` [m] apart, the upper one at z = 0.
/// The layers are joined by half circles. Each is `width` [m] wide.
GridSurface folded_sheet(int layers, double gap, double width) {
  const std::vector<Vector3d> curve = folded_curve(layers, gap, width);
  const int columns = static_cast<int>(std::ceil(width / 6e-3)) + 1;
  return grid_of(static_cast<int>(curve.size()), columns, false, [&](int row, int column) {
    const double y = width * (static_cast<double>(column) / (columns - 1) - 0.5);
    return Vector3d(curve[static_cast<std::size_t>(row)] + y * Vector3d::UnitY());
  });
}

/// A bent tube along z, 0.24 m long and open at both ends. It points outward.
GridSurface bent_tube(double radius, Random& random) {
  constexpr double kLength = 0.24;
  const int around = random.integer(8, 32), along = random.integer(12, 48);
  const double bend = random.uniform(0.0, 0.5 * radius), bulge = random.uniform(0.0, 0.2);
  return grid_of(along, around, true, [&](int row, int k) {
    const double z = kLength * (static_cast<double>(row) / (along - 1) - 0.5);
    const double here = radius * (1.0 + bulge * std::sin(80.0 * z));
    const double angle = 2 * M_PI * k / around;
    return Vector3d(bend * std::sin(25.0 * z) + here * std::cos(angle), here * std::sin(angle), z);
  });
}

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
  static const std::vector<std::string> names = names_of(kKinds);
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

std::vector<double> random_clearances(const ProxyTool& tool, Random& random) {
  std::vector<double> clearances{random.scale(3e-5, 3e-3)};
  for (std::size_t link = 0; link < tool.links.size(); ++link) {
    const bool is_ignored = (link > 0 || tool.radius > 0.0) && random.chance(0.2);
    clearances.push_back(is_ignored ? 0.0 : random.scale(3e-5, 3e-3));
  }
  return clearances;
}

}  // namespace organ_collision::oracle
