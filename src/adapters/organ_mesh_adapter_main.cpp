/// organ_mesh_adapter: subscribes to surfaces in the messages of other simulators, and publishes
/// them as organs for the collision node.

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/names.h>
#include <ros/ros.h>

#include <algorithm>
#include <chrono>
#include <list>
#include <random>

#include "common/messages/failure_log.hpp"
#include "common/messages/senders.hpp"
#include "common/messages/text.hpp"
#include "common/program/program.hpp"
#include "mesh_adapter_parameters.hpp"
#include "organ_collision/ros/names.hpp"
#include "organ_source.hpp"

namespace organ_collision {
namespace {

constexpr char kProgram[] = "organ_mesh_adapter";

/// [messages] Meshes are rare, but another marker must not displace the organ's marker in the
/// queue.
constexpr std::uint32_t kSurfaceQueue = 10;
/// [messages] Only the newest vertices count.
constexpr std::uint32_t kVerticesQueue = 1;

/// scripts/make_reference makes doc/reference/nodes.md of it, and a test compares both.
ProgramHelp mesh_adapter_help() {
  ProgramHelp help{
      kProgram,
      "Turns meshes of other message types into organs of the collision node. A message that "
      "cannot be read leaves the organ as it was. An empty mesh removes it."};
  help.subscribed = {
      {names::kTopic, message_type<shape_msgs::Mesh>(),
       "of each organ; has no header, so frame is needed"},
      {names::kTopic, message_type<pcl_msgs::PolygonMesh>(),
       "of each organ; a polygon of n corners becomes n - 2 faces, a fan around its first corner"},
      {names::kTopic, message_type<visualization_msgs::Marker>(),
       "of each organ; a TRIANGLE_LIST, placed by its scale and pose. The first marker is "
       "the organ, until DELETE or DELETEALL; other types, namespaces and ids are refused"},
      {names::kVerticesTopic, message_type<sensor_msgs::PointCloud2>(),
       "of each organ that names it; as many points as the mesh has vertices, in the same order; "
       "x, y and z as float32 or float64"}};
  help.published = {
      {ros::names::append(names::kNode, names::kOrganMesh), message_type<OrganMesh>(),
       "surfaces with new triangles. The parameter collision_node replaces organ_collision; the "
       "topic can also be remapped"},
      {ros::names::append(names::kNode, names::kOrganVertices), message_type<OrganVertices>(),
       "surfaces with triangles that the collision node already has"},
      {"/diagnostics", message_type<diagnostic_msgs::DiagnosticArray>(),
       "messages of each organ: received, converted, refused by reason, and the time since the "
       "last one was converted [s]"}};
  help.parameters = parameter_help<MeshAdapterParameters>();
  help.further =
      "roslaunch organ_collision organ_mesh_adapter.launch organs:=FILE.yaml starts it. "
      "doc/meshes.md shows an example.";
  return help;
}

/// The node. All its work is done in the thread that spins.
class OrganMeshAdapter {
 public:
  /// Throws ParameterError.
  OrganMeshAdapter(const ros::NodeHandle& node, const ros::NodeHandle& private_node)
      : node_(node),
        parameters_(parse_parameters<MeshAdapterParameters>(all_parameters(private_node))),
        diagnostics_(node, private_node, parameters_.diagnostic_period_sec) {
    for (const std::string& sentence : parameters_.misspelt) ROS_WARN("%s", sentence.c_str());

    // [messages] The queue must hold the meshes of all organs, which a new subscriber gets at once.
    const std::uint32_t queue = std::max<std::uint32_t>(100, 2 * parameters_.organs.size());
    // Not latched: a latched topic keeps only the last message. A new subscriber would get only one
    // organ, and in an old shape.
    ros::NodeHandle collision_node(node_, parameters_.collision_node);
    meshes_ = collision_node.advertise<OrganMesh>(
        names::kOrganMesh, queue,
        [this](const ros::SingleSubscriberPublisher& newcomer) { welcome(newcomer); });
    vertices_ = collision_node.advertise<OrganVertices>(names::kOrganVertices, queue);
    // Random, because the collision node may still have meshes of an earlier adapter.
    const std::uint32_t last_topology = std::random_device()();
    for (const OrganParameters& organ : parameters_.organs) add_organ(organ, last_topology);
    diagnostics_.updater().add("meshes", this, &OrganMeshAdapter::diagnose);
    ROS_INFO("ready: %s, for %s", counted(organs_.size(), "organ").c_str(),
             collision_node.getNamespace().c_str());
  }

 private:
  using Message = topic_tools::ShapeShifter;
  using Event = ros::MessageEvent<const Message>;

  /// An organ, and the numbers of its messages.
  struct Organ {
    OrganSource source;
    Senders senders = {};
    std::uint64_t received = 0;  ///< messages
    std::uint64_t converted = 0;
    std::chrono::steady_clock::time_point latest = {};  ///< when the last message was converted
  };
  using Take = void (OrganSource::*)(const Message& message, ros::Time arrival);

  void add_organ(const OrganParameters& parameters, std::uint32_t last_topology) {
    const OrganSource::Callbacks callbacks{
        [this](const OrganMeshPtr& message) {
          meshes_.publish(message);
          ++meshes_sent_;
        },
        [this](const OrganVerticesPtr& message) { vertices_.publish(message); }};
    Organ& organ = organs_.emplace_back(Organ{{parameters, last_topology, callbacks}});
    subscribe(organ, parameters.topic, kSurfaceQueue, &OrganSource::take_surface);
    if (parameters.vertices_topic.empty()) return;
    subscribe(organ, parameters.vertices_topic, kVerticesQueue, &OrganSource::take_vertices);
  }

  void subscribe(Organ& organ, const std::string& topic, std::uint32_t queue_size, Take take) {
    const std::string name = node_.resolveName(topic);
    const Senders::Stream stream =
        take == &OrganSource::take_surface ? Senders::kMeshes : Senders::kVertices;
    const boost::function<void(const Event&)> callback = [this, name, take, stream,
                                                          &organ](const Event& event) {
      const auto now = std::chrono::steady_clock::now();
      ++organ.received;
      if (organ.senders.note(stream, event.getConnectionHeaderPtr(), event.getReceiptTime())
              .has_restarted) {
        organ.source.restart();
      }
      try {
        (organ.source.*take)(*event.getConstMessage(), event.getReceiptTime());
        ++organ.converted;
        organ.latest = now;
      } catch (const MessageError& error) {
        refused_.add(name + ": " + error.reason(), name + ": " + error.what(), now);
      }
    };
    subscribers_.push_back(node_.subscribe<Message>(topic, queue_size, callback, {},
                                                    ros::TransportHints().tcpNoDelay()));
  }

  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
    using diagnostic_msgs::DiagnosticStatus;
    status.summary(DiagnosticStatus::OK, "converting");
    status.add("organs", organs_.size());
    const auto now = std::chrono::steady_clock::now();
    for (const Organ& organ : organs_) {
      const OrganParameters& parameters = organ.source.parameters();
      status.add(parameters.name + ", messages received", organ.received);
      status.add(parameters.name + ", messages converted", organ.converted);
      if (organ.converted > 0) {
        status.add(parameters.name + ", age of last [s]",
                   std::chrono::duration<double>(now - organ.latest).count());
      }
      if (organ.received == 0) {
        status.mergeSummary(DiagnosticStatus::WARN, "organ '" + parameters.name +
                                                        "': nothing came yet on " +
                                                        node_.resolveName(parameters.topic));
      }
    }
    for (const std::string& sentence : parameters_.misspelt) {
      status.mergeSummary(DiagnosticStatus::WARN, sentence);
    }
    show_failures("refused", refused_, status);
  }

  /// Sends a new subscriber all organs in their latest shape. roscpp numbers only messages to all
  /// subscribers, from 0. The messages to a new subscriber get the number of the last such message,
  /// so that no message seems to be lost.
  void welcome(const ros::SingleSubscriberPublisher& newcomer) const {
    for (const Organ& organ : organs_) {
      const OrganMeshPtr mesh = organ.source.mesh();
      if (!mesh) continue;
      mesh->header.seq = meshes_sent_ - 1;
      newcomer.publish(mesh);
    }
  }

  ros::NodeHandle node_;
  MeshAdapterParameters parameters_;
  FailureLog refused_;
  ros::Publisher meshes_;
  ros::Publisher vertices_;
  std::uint32_t meshes_sent_ = 0;
  std::list<Organ> organs_;
  std::vector<ros::Subscriber> subscribers_;
  Diagnostics diagnostics_;
};

}  // namespace
}  // namespace organ_collision

int main(int argc, char** argv) {
  using namespace organ_collision;
  return run_program(argc, argv, mesh_adapter_help(), kProgram,
                     [](const ros::NodeHandle& node, const ros::NodeHandle& private_node) {
                       const OrganMeshAdapter adapter(node, private_node);
                       ros::spin();
                     });
}
