// A minimal simulator: a sheet of tissue moves up and down, and a probe moves through it.
#include <organ_collision/ContactArray.h>
#include <organ_collision/OrganMesh.h>
#include <organ_collision/OrganVertices.h>
#include <ros/ros.h>
#include <tf2_ros/transform_broadcaster.h>

#include <cmath>
#include <iostream>

using organ_collision::ContactArray;
using organ_collision::OrganMesh;
using organ_collision::OrganVertices;

std::vector<float> shape(const ros::Time& stamp) {
  const float z = static_cast<float>(0.01 * std::sin(stamp.toSec()));
  return {-0.05f, -0.05f, z, 0.05f, -0.05f, z, 0.05f, 0.05f, z, -0.05f, 0.05f, z};
}

template <typename Message>
Message tissue(const ros::Time& stamp) {
  Message message;
  message.header.frame_id = "tissue";
  message.header.stamp = stamp;
  message.organ = "tissue";
  message.vertices = shape(stamp);
  return message;
}

geometry_msgs::TransformStamped frame(const char* name, const ros::Time& stamp, double x,
                                      double z) {
  geometry_msgs::TransformStamped frame;
  frame.header.frame_id = "tissue";
  frame.header.stamp = stamp;
  frame.child_frame_id = name;
  frame.transform.translation.x = x;
  frame.transform.translation.y = 0.01;
  frame.transform.translation.z = z;
  frame.transform.rotation.w = 1.0;
  return frame;
}

void react(const ContactArray& touched) {
  if (touched.status != ContactArray::OK) ROS_WARN("%s", touched.message.c_str());
  for (const organ_collision::Contact& contact : touched.contacts) {
    ROS_INFO("%s: face %u, %.1f mm deep", touched.tool.c_str(), contact.face, 1e3 * contact.depth);
  }
}

constexpr char kUsage[] = R"(Usage: example_simulator
A sheet of tissue moves up and down, and a probe moves through it.
Publishes /organ_collision/organ_mesh, /organ_collision/organ_vertices and /tf.
Subscribes to /organ_collision/contacts, and logs the contacts.
)";

int main(int argc, char** argv) {
  ros::V_string arguments;
  ros::removeROSArgs(argc, argv, arguments);
  if (arguments.size() > 1) {
    std::cout << kUsage;
    return arguments[1] == "--help" || arguments[1] == "-h" ? 0 : 2;
  }
  ros::init(argc, argv, "simulator");
  ros::NodeHandle node("organ_collision");
  OrganMesh sheet = tissue<OrganMesh>(ros::Time::now());
  sheet.triangles = {0, 1, 2, 0, 2, 3};

  tf2_ros::TransformBroadcaster frames;
  ros::Publisher mesh = node.advertise<OrganMesh>("organ_mesh", 1, true);
  ros::Publisher vertices = node.advertise<OrganVertices>("organ_vertices", 1);
  ros::Subscriber contacts = node.subscribe("contacts", 10, react);
  mesh.publish(sheet);
  for (ros::Rate rate(100); ros::ok(); rate.sleep()) {
    const ros::Time now = ros::Time::now();
    frames.sendTransform({frame("probe_trocar", now, 0.0, 0.1),
                          frame("probe_tip", now, 0.1 * std::sin(5 * now.toSec()), -0.05)});
    vertices.publish(tissue<OrganVertices>(now));
    ros::spinOnce();
  }
}
