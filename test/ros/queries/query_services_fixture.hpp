#pragma once

#include <gtest/gtest.h>
#include <tf2_eigen/tf2_eigen.h>

#include <string>
#include <vector>

#include "ros/interface/conversions.hpp"
#include "served_node.hpp"

namespace organ_collision {

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

}  // namespace organ_collision
