#pragma once

#include <gtest/gtest.h>
#include <organ_collision/ContactArray.h>
#include <ros/console.h>

#include <boost/make_shared.hpp>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "node/organs/organ_registry.hpp"
#include "organ_collision/geometry/organ/triangle_mesh.hpp"

namespace organ_collision {

inline const std::vector<std::uint32_t> kOutward{0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
inline const std::vector<std::uint32_t> kInward{0, 1, 2, 0, 3, 1, 0, 2, 3, 1, 3, 2};

/// Corners of a tetrahedron with sides of 3, 4 and 5 cm, at (1, 2, 3) dm, times `unit`.
inline std::vector<float> corners(float unit = 1.0F) {
  std::vector<float> corners{0.1F, 0.2F,  0.3F, 0.13F, 0.2F, 0.3F,
                             0.1F, 0.24F, 0.3F, 0.1F,  0.2F, 0.35F};
  for (float& coordinate : corners) coordinate *= unit;
  return corners;
}

/// That tetrahedron. It is closed and points outward, unless other triangles are given.
inline TriangleMesh tetrahedron(const std::vector<std::uint32_t>& triangles = kOutward,
                                float unit = 1.0F, std::uint32_t topology = 1) {
  return {corners(unit), triangles, topology};
}

/// Everything that is logged at level INFO or above in its lifetime. There is one at a time.
class CapturedLog : ros::console::LogAppender {
 public:
  CapturedLog() {
    ros::console::initialize();
    ros::console::register_appender(this);
  }
  ~CapturedLog() override { ros::console::deregister_appender(this); }

  /// What has been logged since the last call, each with its level: "WARN the text".
  std::vector<std::string> take() { return std::exchange(lines_, {}); }

 private:
  void log(ros::console::Level level, const char* text, const char*, const char*, int) override {
    const char* const levels[] = {"DEBUG ", "INFO ", "WARN ", "ERROR ", "FATAL "};
    if (level >= ros::console::levels::Info) lines_.push_back(levels[level] + std::string(text));
  }

  std::vector<std::string> lines_;
};

/// A square of two faces.
inline OrganMesh mesh(const std::string& organ = "liver", std::uint32_t topology = 1) {
  OrganMesh message;
  message.header.frame_id = "liver_frame";
  message.header.stamp = ros::Time(5);
  message.organ = organ;
  message.topology = topology;
  message.vertices = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
  message.triangles = {0, 1, 2, 1, 3, 2};
  return message;
}

/// New vertices for that square, at height `z`.
inline OrganVertices vertices(float z, std::uint32_t topology = 1) {
  OrganVertices message;
  message.header.frame_id = "liver_frame";
  message.header.stamp = ros::Time(6);
  message.organ = "liver";
  message.topology = topology;
  message.vertices = {0, 0, z, 1, 0, z, 0, 1, z, 1, 1, z};
  return message;
}

class OrganRegistryTest : public testing::Test {
 protected:
  OrganRegistryTest() { ros::Time::init(); }  // Warnings have a time.

  OrganChange apply(const OrganMesh& message, ros::Time now, const Connection& connection = {}) {
    const auto pointer = boost::make_shared<const OrganMesh>(message);
    return store_.apply(pointer, now, connection);
  }
  OrganChange apply(const OrganVertices& message, ros::Time now,
                    const Connection& connection = {}) {
    return store_.apply(boost::make_shared<const OrganVertices>(message), now, connection);
  }

  /// Expects that `message` is refused with this status and reason, and that the liver stays as it
  /// was. The rejection must contain all `words`.
  template <typename Message>
  void expect_refused(const Message& message, std::uint8_t status, const std::string& reason,
                      const std::vector<std::string>& words = {},
                      const Connection& connection = {}) {
    const bool known = store_.organs().count("liver") > 0;
    const OrganShape before = known ? store_.at("liver").latest() : OrganShape{};
    try {
      apply(message, ros::Time(9), connection);
      ADD_FAILURE() << "accepted: " << reason;
    } catch (const Rejection& rejection) {
      EXPECT_EQ(rejection.status(), status) << rejection.what();
      EXPECT_EQ(rejection.reason(), reason) << rejection.what();
      for (const std::string& word : words) {
        EXPECT_NE(std::string(rejection.what()).find(word), std::string::npos)
            << "'" << word << "' in: " << rejection.what();
      }
    }
    ASSERT_EQ(store_.organs().count("liver") > 0, known);
    if (!known) return;
    EXPECT_EQ(store_.at("liver").latest().mesh, before.mesh);
  }

  /// Why the organ is not there, with this status; status OK if it is there.
  Rejection rejection_of(const std::string& organ) {
    try {
      store_.at(organ);
    } catch (const Rejection& rejection) {
      return rejection;
    }
    return {ContactArray::OK, "", ""};
  }
  std::uint8_t status_of(const std::string& organ) { return rejection_of(organ).status(); }
  std::string why(const std::string& organ) { return rejection_of(organ).what(); }

  /// A header such as roscpp makes for each connection.
  static ros::M_stringPtr header(const std::string& sender = "/simulator") {
    return ros::M_stringPtr(new ros::M_string{{"callerid", sender}});
  }

  const ros::M_stringPtr first_ = header();
  const ros::M_stringPtr second_ = header();
  AheadLimit ahead_;
  OrganRegistry store_{MeshLimits{2}, ahead_};
};

}  // namespace organ_collision
