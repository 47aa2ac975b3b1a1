#include "organ_traffic.hpp"

#include <organ_collision/OrganVertices.h>

#include <boost/make_shared.hpp>
#include <string>

namespace organ_collision::stress {
namespace {

constexpr Sheet kQuick{25}, kLarge{224}, kBrief{5};
constexpr std::size_t kBriefOrgans = 3;
constexpr std::size_t kLargeSteps = 8;  ///< from one appearance of the large organ to the next
constexpr double kPhaseStep = 0.02;     // [rad] from shape to shape

OrganVerticesPtr vertices_message(const std::string& organ, const Sheet& sheet, std::size_t cut,
                                  double phase) {
  const auto message = boost::make_shared<OrganVertices>();
  message->header.frame_id = "sheet";
  message->header.stamp = ros::Time::now();
  message->organ = organ;
  message->topology = static_cast<std::uint32_t>(cut);
  message->vertices = sheet.vertices(phase);
  return message;
}

OrganMeshPtr removal(const std::string& organ) {
  const auto message = boost::make_shared<OrganMesh>();
  message->header.frame_id = "sheet";
  message->organ = organ;
  return message;
}

}  // namespace

OrganTraffic::OrganTraffic()
    : meshes_(node_.advertise<OrganMesh>("organ_collision/organ_mesh", 10)),
      vertices_(node_.advertise<OrganVertices>("organ_collision/organ_vertices", 10)) {}

void OrganTraffic::move_quick() {
  quick_phase_ += kPhaseStep;
  vertices_.publish(vertices_message("quick", kQuick, 0, quick_phase_));
}

void OrganTraffic::restore_quick() { meshes_.publish(mesh_message("quick", kQuick, 0, 0.0)); }

void OrganTraffic::change_large() {
  const std::size_t step = large_step_++ % kLargeSteps;
  const std::size_t cut = step < kLargeSteps / 2 ? 0 : 100;
  const double phase = kPhaseStep * static_cast<double>(large_step_);
  if (step == kLargeSteps - 1) {
    meshes_.publish(removal("large"));
  } else if (step % (kLargeSteps / 2) == 0) {
    meshes_.publish(mesh_message("large", kLarge, cut, phase));
  } else {
    vertices_.publish(vertices_message("large", kLarge, cut, phase));
  }
}

void OrganTraffic::change_brief() {
  const std::size_t appears = brief_step_++ % kBriefOrgans, vanishes = brief_step_ % kBriefOrgans;
  const auto name = [](std::size_t number) { return "brief" + std::to_string(number); };
  meshes_.publish(mesh_message(name(appears), kBrief, 0, 0.0));
  meshes_.publish(removal(name(vanishes)));
}

}  // namespace organ_collision::stress
