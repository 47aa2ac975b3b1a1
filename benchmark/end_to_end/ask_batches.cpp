#include <organ_collision/ContactArray.h>
#include <organ_collision/OrganMesh.h>
#include <organ_collision/QueryCollisionBatch.h>
#include <ros/node_handle.h>
#include <ros/ros.h>
#include <ros/service.h>
#include <tf2_eigen/tf2_eigen.h>

#include <cstddef>
#include <cstdlib>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>

#include "benchmark/cases/timing.hpp"
#include "benchmark/scenes/tool_motions.hpp"

namespace organ_collision::bench {

namespace {

constexpr std::size_t kMotions = 1000;
constexpr char kOrgan[] = "organ";

ToolMotion shaft_message(const ToolPath& path, double radius) {
  ToolMotion message;
  message.previous_trocar = tf2::toMsg(path.front().axis.trocar);
  message.previous_tip = tf2::toMsg(path.front().axis.tip);
  message.trocar = tf2::toMsg(path.back().axis.trocar);
  message.tip = tf2::toMsg(path.back().axis.tip);
  message.radius = radius;
  return message;
}

LinkMotion link_message(const ToolPath& path, bool moves) {
  LinkMotion message;
  for (const auto& pose : path.back().links) message.links.push_back(tf2::toMsg(pose));
  if (!moves) return message;
  for (const auto& pose : path.front().links) message.previous.push_back(tf2::toMsg(pose));
  return message;
}

/// Asks the node `organ_collision` of its own namespace about batches of motions against the
/// Simulator's organ. The motions are those of a MotionSet, again and again.
class BatchClient {
 public:
  /// `tool`: as for motions_of(). The grasper is the node's tool of that name.
  BatchClient(std::size_t faces, const std::string& tool)
      : organ_(make_organ(faces)), tool_(tool), motions_(motions_of(tool, organ_, kMotions)) {
    // A persistent client that is made before its service is there stays without a connection.
    const std::string service = "organ_collision/query_batch";
    ros::service::waitForService(service, ros::Duration(30.0));
    client_ = node_.serviceClient<QueryCollisionBatch>(service, /*persistent=*/true);
  }

  /// Publishes the organ, for a node that has no simulator, and waits until the node has it. Throws
  /// std::runtime_error if that takes more than half a minute.
  void publish_organ() {
    mesh_ = node_.advertise<OrganMesh>("organ_collision/organ_mesh", 1, true);
    OrganMesh mesh;
    mesh.header.frame_id = kOrgan;
    mesh.organ = kOrgan;
    mesh.vertices = organ_.vertices;
    mesh.triangles = organ_.triangles;
    mesh_.publish(mesh);
    set_request(ContactArray::STATIC, 1);
    const ros::SteadyTime give_up = ros::SteadyTime::now() + ros::WallDuration(30.0);
    while (!client_.call(batch_) || batch_.response.status != ContactArray::OK) {
      if (!ros::ok() || ros::SteadyTime::now() > give_up) {
        throw std::runtime_error("the node does not take the organ: " + batch_.response.message);
      }
      ros::WallDuration(0.05).sleep();
    }
  }

  struct Report {
    std::size_t motions = 0;
    std::size_t contacts = 0;
    std::size_t failed = 0;  ///< motions without a good answer
    double seconds = 0.0;    ///< from the first request to the last answer
  };
  /// Asks for batches of `count` motions, one after the other, until `seconds` have passed.
  /// `mode` is a mode of ContactArray. Throws std::runtime_error if the node refuses.
  Report ask(std::uint8_t mode, std::size_t count, double seconds) {
    set_request(mode, count);
    Report report;
    Stopwatch watch;
    do {
      if (!client_.call(batch_) || batch_.response.status != ContactArray::OK) {
        throw std::runtime_error("the node refuses the batch: " + batch_.response.message);
      }
      report.seconds += watch.lap();
      report.motions += batch_.response.results.size();
      for (const ContactArray& result : batch_.response.results) {
        report.contacts += result.contacts.size();
        report.failed += result.status != ContactArray::OK;
      }
      watch.lap();
    } while (report.seconds < seconds && ros::ok());
    return report;
  }

 private:
  void set_request(std::uint8_t mode, std::size_t count) {
    QueryCollisionBatch::Request& request = batch_.request;
    request = {};
    request.header.frame_id = kOrgan;
    request.organ = kOrgan;
    request.mode = mode;
    const bool has_links = !motions_.links.empty();
    if (has_links) request.tool = tool_;
    for (std::size_t i = 0; i < count; ++i) {
      const ToolPath& path = motions_.paths[i % motions_.paths.size()];
      request.motions.push_back(shaft_message(path, motions_.radius));
      if (has_links) {
        request.link_motions.push_back(link_message(path, mode == ContactArray::SWEPT));
      }
    }
  }

  OrganSurface organ_;
  std::string tool_;
  MotionSet motions_;
  QueryCollisionBatch batch_;
  ros::NodeHandle node_;
  ros::Publisher mesh_;
  ros::ServiceClient client_;
};

void obey(const std::string& line, BatchClient& client) {
  std::istringstream words(line);
  std::string what;
  words >> what;
  if (what == "organ") {
    client.publish_organ();
    std::cout << "{}" << std::endl;
    return;
  }
  std::size_t count = 0;
  double seconds = 0.0;
  if ((what != "static" && what != "swept") || !(words >> count >> seconds)) {
    throw std::runtime_error("what is '" + line + "'?");
  }
  const auto mode = what == "static" ? ContactArray::STATIC : ContactArray::SWEPT;
  const BatchClient::Report report = client.ask(mode, count, seconds);
  std::cout << "{\"motions\": " << report.motions << ", \"contacts\": " << report.contacts
            << ", \"failed\": " << report.failed << ", \"seconds\": " << report.seconds << "}"
            << std::endl;
}

}  // namespace
}  // namespace organ_collision::bench

// ask_batches FACES shaft|grasper
// Reads what to ask the node organ_collision of its own namespace from standard input, and prints a
// line of JSON for each line that it reads:
//   organ                       {}; publishes the organ. Not needed if a simulator does
//   static|swept COUNT SECONDS  batches of COUNT motions, until SECONDS have passed
int main(int argc, char** argv) {
  using namespace organ_collision::bench;
  ros::init(argc, argv, "ask_batches");
  if (argc != 3) return std::cerr << "ask_batches FACES shaft|grasper" << std::endl, 2;
  const ros::NodeHandle node;
  try {
    BatchClient client(std::strtoul(argv[1], nullptr, 10), argv[2]);
    for (std::string line; std::getline(std::cin, line) && ros::ok();) obey(line, client);
  } catch (const std::exception& error) {
    std::cerr << "ask_batches: " << error.what() << std::endl;
    return 1;
  }
}
