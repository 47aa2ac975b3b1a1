// A minimal simulator: a probe comes down onto a sheet of tissue, presses, slides and leaves.
#include <organ_collision/ContactArray.h>
#include <organ_collision/OrganMesh.h>
#include <organ_collision/OrganVertices.h>
#include <ros/ros.h>
#include <tf2_ros/transform_broadcaster.h>

#include <algorithm>
#include <cmath>
#include <iostream>

using organ_collision::Contact;
using organ_collision::ContactArray;
using organ_collision::OrganMesh;
using organ_collision::OrganVertices;

constexpr int kCells = 8;      // in each direction
constexpr double kSide = 0.1;  // [m]

// A wave of 1 mm runs through the sheet.
std::vector<float> shape(const ros::Time& stamp) {
  std::vector<float> vertices;
  for (int j = 0; j <= kCells; ++j) {
    for (int i = 0; i <= kCells; ++i) {
      const double x = kSide * (static_cast<double>(i) / kCells - 0.5);
      const double y = kSide * (static_cast<double>(j) / kCells - 0.5);
      const double z = 0.001 * std::sin(50 * x + stamp.toSec());
      for (double coordinate : {x, y, z}) vertices.push_back(static_cast<float>(coordinate));
    }
  }
  return vertices;
}

std::vector<uint32_t> triangles() {
  std::vector<uint32_t> triangles;
  for (uint32_t j = 0; j < kCells; ++j) {
    for (uint32_t i = 0; i < kCells; ++i) {
      const uint32_t a = i + j * (kCells + 1), c = a + kCells + 2;
      triangles.insert(triangles.end(), {a, a + 1, c, a, c, c - 1});
    }
  }
  return triangles;
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
  if (touched.contacts.empty()) return;
  const auto& deepest =
      *std::max_element(touched.contacts.begin(), touched.contacts.end(),
                        [](const Contact& a, const Contact& b) { return a.depth < b.depth; });
  ROS_INFO_THROTTLE(0.5, "%s: %.1f mm deep in face %u; faces touched: %zu", touched.tool.c_str(),
                    1e3 * deepest.depth, deepest.face, touched.contacts.size());
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
  sheet.triangles = triangles();

  tf2_ros::TransformBroadcaster frames;
  ros::Publisher mesh = node.advertise<OrganMesh>("organ_mesh", 1, true);
  ros::Publisher vertices = node.advertise<OrganVertices>("organ_vertices", 1);
  ros::Subscriber contacts = node.subscribe("contacts", 10, react);
  mesh.publish(sheet);
  for (ros::Rate rate(100); ros::ok(); rate.sleep()) {
    const ros::Time now = ros::Time::now();
    const double x = 0.02 * std::sin(now.toSec()), z = 0.008 + 0.005 * std::cos(now.toSec());
    frames.sendTransform({frame("probe_trocar", now, 0.0, 0.1), frame("probe_tip", now, x, z)});
    vertices.publish(tissue<OrganVertices>(now));
    ros::spinOnce();
  }
}
