// The nodelet, in one process with the publisher of the organ.
#include <gtest/gtest.h>
#include <nodelet/loader.h>
#include <organ_collision/ContactArray.h>
#include <organ_collision/OrganMesh.h>
#include <organ_collision/OrganVertices.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <tf2_ros/static_transform_broadcaster.h>

#include <boost/make_shared.hpp>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace organ_collision {
namespace {

constexpr char kPlugin[] = "organ_collision/CollisionNodelet";

geometry_msgs::TransformStamped frame(const std::string& name, double z) {
  geometry_msgs::TransformStamped transform;
  transform.header.frame_id = "sheet";
  transform.child_frame_id = name;
  transform.transform.translation.z = z;
  transform.transform.rotation.w = 1.0;
  return transform;
}

/// Two faces around the origin, at this height [m]. The tip of the probe is at the origin.
std::vector<float> sheet(float z) { return {-1, -1, z, 1, -1, z, 1, 1, z, -1, 1, z}; }

template <typename Message>
boost::shared_ptr<Message> sheet_message(float z) {
  const auto message = boost::make_shared<Message>();
  message->header.frame_id = "sheet";
  message->header.stamp = ros::Time::now();
  message->organ = "sheet";
  message->vertices = sheet(z);
  return message;
}

class NodeletTest : public testing::Test {
 protected:
  NodeletTest() {
    frames_.sendTransform({frame("probe_trocar", 0.2), frame("probe_tip", 0.0)});
    contacts_ = node_.subscribe<ContactArray>(
        "/organ_collision/contacts", 100,
        [this](const ContactArrayConstPtr& message) { received_ = message; });
    mesh_ = node_.advertise<OrganMesh>("/organ_collision/organ_mesh", 1, true);
    vertices_ = node_.advertise<OrganVertices>("/organ_collision/organ_vertices", 10);
  }

  static bool wait_for(const std::function<bool()>& condition) {
    const ros::WallTime give_up = ros::WallTime::now() + ros::WallDuration(60.0);
    while (!condition() && ros::WallTime::now() < give_up) {
      ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.01));
    }
    return condition();
  }

  /// Publishes the shape until an answer arrives.
  void send(const boost::shared_ptr<OrganVertices>& shape) {
    vertices_.publish(shape);
    ASSERT_TRUE(
        wait_for([&] { return received_ && received_->mesh_stamp == shape->header.stamp; }));
  }

  /// Publishes a mesh with topology 0 until an answer arrives.
  void send_mesh(const std::vector<std::uint32_t>& triangles) {
    const auto mesh = sheet_message<OrganMesh>(0.005F);
    mesh->triangles = triangles;
    mesh_.publish(mesh);
    ASSERT_TRUE(
        wait_for([&] { return received_ && received_->header.stamp == mesh->header.stamp; }));
  }

  ros::NodeHandle node_;
  tf2_ros::StaticTransformBroadcaster frames_;
  ros::Subscriber contacts_;
  ros::Publisher mesh_, vertices_;
  ContactArrayConstPtr received_;
};

TEST_F(NodeletTest, KeepsShapesOfTheSameProcessWithoutACopy) {
  nodelet::Loader loader(false);
  ASSERT_TRUE(loader.load("/organ_collision", kPlugin, {}, {}));
  const auto mesh = sheet_message<OrganMesh>(0.005F);
  mesh->triangles = {0, 1, 2, 0, 2, 3};
  mesh_.publish(mesh);
  ASSERT_TRUE(wait_for([&] { return received_ != nullptr; }));
  EXPECT_EQ(received_->status, ContactArray::OK) << received_->message;
  EXPECT_EQ(received_->contacts.size(), 2U);

  const auto shape = sheet_message<OrganVertices>(-0.005F);
  send(shape);
  EXPECT_EQ(received_->mode, ContactArray::SWEPT);
  EXPECT_EQ(received_->contacts.size(), 2U);
  EXPECT_GT(shape.use_count(), 1) << "the organ's shape is not this message itself";

  // Two shapes later, it is released.
  send(sheet_message<OrganVertices>(-0.1F));
  send(sheet_message<OrganVertices>(-0.2F));
  EXPECT_TRUE(received_->contacts.empty());
  send(sheet_message<OrganVertices>(-0.3F));
  EXPECT_TRUE(wait_for([&] { return shape.use_count() == 1; }));
}

TEST_F(NodeletTest, AMeshOfANewPublisherOfTheSameProcessIsAnotherOrgan) {
  nodelet::Loader loader(false);
  ASSERT_TRUE(loader.load("/organ_collision", kPlugin, {}, {}));
  send_mesh({0, 1, 2, 0, 2, 3});
  EXPECT_EQ(received_->status, ContactArray::OK) << received_->message;
  send_mesh({0, 1, 2});
  EXPECT_EQ(received_->status, ContactArray::INVALID_REQUEST);
  send_mesh({0, 1, 2, 0, 2, 3});
  EXPECT_EQ(received_->mode, ContactArray::SWEPT);
  mesh_.shutdown();
  mesh_ = node_.advertise<OrganMesh>("/organ_collision/organ_mesh", 1, true);
  send_mesh({0, 1, 2});
  EXPECT_EQ(received_->status, ContactArray::OK) << received_->message;
  EXPECT_EQ(received_->mode, ContactArray::STATIC);
}

TEST_F(NodeletTest, IsLoadedAgainAfterUnloading) {
  for (int i = 0; i < 3; ++i) {
    nodelet::Loader loader(false);
    EXPECT_TRUE(loader.load("/organ_collision", kPlugin, {}, {}));
    EXPECT_TRUE(loader.unload("/organ_collision"));
  }
}

TEST_F(NodeletTest, IsNotLoadedWithIllegalParameters) {
  nodelet::Loader loader(false);
  ros::param::set("/broken/tools", "none");
  EXPECT_FALSE(loader.load("/broken", kPlugin, {}, {}));
}

}  // namespace
}  // namespace organ_collision

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "nodelet_test");
  const ros::NodeHandle keeps_ros_running;
  return RUN_ALL_TESTS();
}
