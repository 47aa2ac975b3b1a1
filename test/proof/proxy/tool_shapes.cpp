#include "tool_shapes.hpp"

namespace organ_collision::oracle {
namespace {

ShaftAxis middle_line(const OrientedBox& box) {
  Eigen::Index longest = 0;
  const double length = box.half_size.maxCoeff(&longest) - box.half_size.minCoeff();
  const Eigen::Vector3d half = length * box.axes.col(longest);
  return {box.center - half, box.center + half};
}

ShaftAxis moved(const Eigen::Isometry3d& T_to_from, const ShaftAxis& axis) {
  return {T_to_from * axis.trocar, T_to_from * axis.tip};
}

}  // namespace

std::vector<PlacedCore> placed_cores(const ProxyTool& tool, const ToolPose& pose) {
  std::vector<PlacedCore> cores;
  if (tool.radius > 0.0) cores.push_back({pose.axis, tool.radius});
  for (std::size_t link = 0; link < tool.links.size(); ++link) {
    for (const LinkPart& part : tool.links[link].parts) {
      if (!part.surface) {
        cores.push_back({pose.links[link] * part.core, part.ball_radius()});
        continue;
      }
      for (std::size_t i = 0; i < part.surface->faces().size(); ++i) {
        cores.push_back({pose.links[link] * ConvexCore(part.surface->triangle(i)), 0.0});
      }
    }
  }
  return cores;
}

std::vector<ShaftAxis> skeleton(const ProxyTool& tool, const ToolPose& pose) {
  std::vector<ShaftAxis> lines;
  if (tool.radius > 0.0) lines.push_back(pose.axis);
  for (std::size_t link = 0; link < tool.links.size(); ++link) {
    for (const LinkPart& part : tool.links[link].parts) {
      lines.push_back(moved(pose.links[link], middle_line(part.bounds)));
    }
  }
  return lines;
}

ToolPose operator*(const Eigen::Isometry3d& T_to_from, const ToolPose& pose) {
  ToolPose result = pose;
  result.axis = moved(T_to_from, pose.axis);
  for (Eigen::Isometry3d& link : result.links) link = T_to_from * link;
  return result;
}

}  // namespace organ_collision::oracle
