#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <topic_tools/shape_shifter.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <list>
#include <string>
#include <vector>

#include "mesh_adapter_parameters.hpp"
#include "organ_source.hpp"
#include "ros/messages/failure_log.hpp"
#include "ros/node/program.hpp"

namespace organ_collision {

/// The node: subscribes to surfaces in the messages of other simulators, and publishes them as
/// organs for the collision node. All its work is done in the thread that spins.
class OrganMeshAdapter {
 public:
  /// Throws ParameterError.
  OrganMeshAdapter(const ros::NodeHandle& node, const ros::NodeHandle& private_node);

 private:
  using Message = topic_tools::ShapeShifter;
  using Event = ros::MessageEvent<const Message>;

  /// An organ, and what came of it.
  struct Organ {
    OrganSource source;
    std::uint64_t received = 0;  ///< messages
    std::uint64_t converted = 0;
    std::chrono::steady_clock::time_point latest = {};  ///< when the last one was converted
  };
  using Take = void (OrganSource::*)(const Message& message, ros::Time arrival);

  void add_organ(const OrganParameters& parameters, std::uint32_t last_topology);
  void subscribe(Organ& organ, const std::string& topic, std::uint32_t queue_size, Take take);
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);
  void welcome(const ros::SingleSubscriberPublisher& newcomer) const;

  ros::NodeHandle node_;
  MeshAdapterParameters parameters_;
  FailureLog refused_;
  ros::Publisher meshes_;
  ros::Publisher vertices_;
  std::uint32_t meshes_sent_ = 0;
  std::list<Organ> organs_;
  std::vector<ros::Subscriber> subscribers_;
  diagnostic_updater::Updater updater_;
  ros::WallTimer diagnostic_timer_;
  MasterWatch master_;
};

}  // namespace organ_collision
