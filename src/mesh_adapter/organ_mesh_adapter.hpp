#pragma once

#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <topic_tools/shape_shifter.h>

#include <functional>
#include <list>
#include <string>
#include <vector>

#include "mesh_adapter_parameters.hpp"
#include "organ_source.hpp"
#include "ros/interface/failure_log.hpp"

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

  void add_source(const OrganParameters& organ, std::uint32_t last_topology);
  void subscribe(const std::string& topic, std::uint32_t queue_size,
                 const std::function<void(const Message&, ros::Time)>& take);
  void welcome(const ros::SingleSubscriberPublisher& newcomer) const;

  ros::NodeHandle node_;
  MeshAdapterParameters parameters_;
  FailureLog refused_;
  ros::Publisher meshes_;
  ros::Publisher vertices_;
  std::list<OrganSource> sources_;
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace organ_collision
