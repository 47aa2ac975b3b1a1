#pragma once

#include <gtest/gtest.h>
#include <organ_collision/LinkMotion.h>
#include <tf2_eigen/tf2_eigen.h>

#include <functional>
#include <string>
#include <vector>

#include "ros/messages/conversions.hpp"
#include "ros/queries/query_services.hpp"
#include "test/ros/steps/node_parts.hpp"

namespace organ_collision {

/// The node without ROS's topics, with its services. One thread does all but the work of batches.
struct ServedNode : NodeParts {
  FailureLog refused;
  QueryServices services{{{parameters, tools, organs, transforms, poses, steps.history()},
                          [](const std::function<void()>& action) { action(); },
                          refused,
                          2}};
};

const Eigen::Vector3d kAbove{0.1, 0.2, 0.3};
const Eigen::Vector3d kBelow{0.1, 0.2, -0.3};

/// A motion that crosses the sheet at height 0, in the organ's frame.
inline ToolMotion through() {
  ToolMotion motion;
  motion.previous_trocar = motion.trocar = tf2::toMsg(Eigen::Vector3d(0.0, 0.0, 1.0));
  motion.previous_tip = tf2::toMsg(kAbove);
  motion.tip = tf2::toMsg(kBelow);
  motion.radius = 0.01;
  return motion;
}

/// The services of a node with one organ, "liver", and a request of a swept query that touches it.
class QueryServicesTest : public testing::Test, protected ServedNode {
 protected:
  QueryServicesTest() {
    request.header.frame_id = "liver_frame";
    request.organ = "liver";
    request.motion = through();
    request.mode = ContactArray::SWEPT;
    send_mesh(1.0, 0.0);
  }

  void expect_refused(std::uint8_t status, const std::vector<std::string>& words) {
    const ContactArray answer = services.query(request);
    EXPECT_EQ(answer.status, status) << answer.message;
    EXPECT_TRUE(answer.contacts.empty());
    for (const std::string& word : words) {
      EXPECT_NE(answer.message.find(word), std::string::npos)
          << "'" << word << "' in: " << answer.message;
    }
  }

  QueryCollision::Request request;
};

/// A node with a hook that has a shaft and two links, a grasper that has only the links, and a
/// probe that has only a shaft. See with_links() and NodeParts.
class LinkMotionTest : public testing::Test, protected ServedNode {
 protected:
  LinkMotionTest() {
    tools = {with_links(shaft_tool("hook", 0.01)), grasper(), shaft_tool("probe", 0.02)};
    send_mesh(1.0, 0.0);
    request.header.frame_id = "liver_frame";
    request.organ = "liver";
    request.tool = "grasper";
    request.mode = ContactArray::SWEPT;
    request.link_motion = jaw_goes_down();
  }

  static geometry_msgs::Pose at(const Eigen::Vector3d& position) {
    geometry_msgs::Pose pose;
    pose.position = tf2::toMsg(position);
    pose.orientation.w = 1.0;
    return pose;
  }

  /// The wrist rests above the sheet, and the jaw goes through it.
  static LinkMotion jaw_goes_down() {
    LinkMotion motion;
    motion.previous = {at({-0.3, 0.2, 0.6}), at({0.1, 0.2, 0.3})};
    motion.links = {at({-0.3, 0.2, 0.6}), at({0.1, 0.2, -0.3})};
    return motion;
  }

  /// A shaft that rests above the sheet.
  static ToolMotion resting_shaft() {
    ToolMotion motion;
    motion.trocar = motion.previous_trocar = tf2::toMsg(Eigen::Vector3d(0.0, 0.0, 1.0));
    motion.tip = motion.previous_tip = tf2::toMsg(Eigen::Vector3d(0.0, 0.0, 0.7));
    return motion;
  }

  void expect_refused(const std::vector<std::string>& words) {
    const ContactArray answer = services.query(request);
    EXPECT_EQ(answer.status, ContactArray::INVALID_REQUEST) << answer.message;
    EXPECT_TRUE(answer.contacts.empty());
    for (const std::string& word : words) {
      EXPECT_NE(answer.message.find(word), std::string::npos)
          << "'" << word << "' in: " << answer.message;
    }
  }

  QueryCollision::Request request;
};

}  // namespace organ_collision
