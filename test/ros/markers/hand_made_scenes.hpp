#pragma once

#include <boost/make_shared.hpp>
#include <memory>
#include <string>
#include <vector>

#include "ros/markers/markers.hpp"
#include "test/ros/tools/hand_made_tools.hpp"

namespace organ_collision {

/// A square of two faces in the plane z = 0, from (0, 0) to (1, 1) [m]. Its size is the square root
/// of 2.
inline SceneOrgan square(const std::string& name = "liver") {
  return {name, name + "_frame",
          std::make_shared<const TriangleMesh>(
              TriangleMesh({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, {0, 1, 2, 1, 3, 2}))};
}

/// A contact in the plane z = 0, whose tool is above.
inline Contact contact_at(std::uint32_t face, double depth, double x, double y) {
  Contact contact;
  contact.face = face;
  contact.depth = depth;
  contact.normal.z = -1.0;
  contact.end_point.x = x;
  contact.end_point.y = y;
  return contact;
}

/// An answer about the square and the tool "hook".
inline ContactArrayPtr answer_with(const std::vector<Contact>& contacts) {
  const auto answer = boost::make_shared<ContactArray>();
  answer->organ = "liver";
  answer->tool = "hook";
  answer->links = {""};
  answer->contacts = contacts;
  return answer;
}

/// A time later than the clock's zero.
inline SteadyTime at(double seconds) {
  return SteadyTime() + std::chrono::duration_cast<SteadyTime::duration>(
                            std::chrono::duration<double>(1000.0 + seconds));
}

/// The square and a hook above it, at rest. The hook has not been evaluated yet.
inline Scene hook_over_square(double seconds = 0.0) {
  Scene scene;
  scene.time = at(seconds);
  scene.tools = std::make_shared<std::vector<Tool>>(1, shaft_tool("hook", 0.25));
  scene.organs = {square()};
  scene.pairs = {{"liver", 0, nullptr, ToolPose{{{0.0, 0.0, 2.0}, {0.0, 4.0, 2.0}}, {}}}};
  return scene;
}

/// The markers of a namespace.
inline std::vector<visualization_msgs::Marker> find_markers(
    const visualization_msgs::MarkerArray& array, const std::string& name_space) {
  std::vector<visualization_msgs::Marker> found;
  for (const visualization_msgs::Marker& marker : array.markers) {
    if (marker.ns == name_space) found.push_back(marker);
  }
  return found;
}

inline Eigen::Vector3d point(const visualization_msgs::Marker& marker, std::size_t index) {
  const geometry_msgs::Point& p = marker.points.at(index);
  return {p.x, p.y, p.z};
}

}  // namespace organ_collision
