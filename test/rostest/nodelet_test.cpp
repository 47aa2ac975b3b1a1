// The nodelet, in one process with the publisher of the organ.
#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>
#include <nodelet/loader.h>
#include <organ_collision/ContactArray.h>
#include <organ_collision/OrganMesh.h>
#include <organ_collision/OrganVertices.h>
#include <organ_collision/QueryCollisionBatch.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <tf2_ros/static_transform_broadcaster.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <cstdint>
#include <functional>
#include <string>
#include <thread>
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

/// How many motions the node says it has answered; 0: it does not say.
int motions_of_batches(const diagnostic_msgs::DiagnosticArray& message) {
  for (const auto& status : message.status) {
    for (const auto& pair : status.values) {
      if (pair.key == "motions of batches") return std::stoi(pair.value);
    }
  }
  return 0;
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

TEST_F(NodeletTest, IsUnloadedInTheMiddleOfABatch) {
  nodelet::Loader loader(false);
  ASSERT_TRUE(loader.load("/organ_collision", kPlugin, {}, {}));
  send_mesh({0, 1, 2, 0, 2, 3});
  int answered = 0;
  const ros::Subscriber diagnostics = node_.subscribe<diagnostic_msgs::DiagnosticArray>(
      "/diagnostics", 100, [&](const diagnostic_msgs::DiagnosticArrayConstPtr& message) {
        answered = std::max(answered, motions_of_batches(*message));
      });
  QueryCollisionBatch batch;
  batch.request.header.frame_id = batch.request.organ = "sheet";
  batch.request.mode = ContactArray::SWEPT;
  batch.request.motions.resize(1'000'000);
  for (ToolMotion& motion : batch.request.motions) {
    motion.trocar.z = motion.previous_trocar.z = 0.2;
    motion.tip.x = 0.01;
    motion.previous_tip.x = -0.01;
    motion.radius = 0.001;
  }
  // The client gets a status or an error, but no results.
  std::thread client([&] { ros::service::call("/organ_collision/query_batch", batch); });
  EXPECT_TRUE(wait_for([&] { return answered > 0; }));
  EXPECT_LT(answered, 1'000'000);
  EXPECT_TRUE(loader.unload("/organ_collision"));
  client.join();
  EXPECT_TRUE(batch.response.results.empty());
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
