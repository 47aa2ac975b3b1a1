#pragma once

#include <organ_collision/ListOrgans.h>
#include <organ_collision/RemoveOrgan.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>

#include <vector>

#include "organ_intake.hpp"

namespace organ_collision {

/// An organ as it was when it was listed.
struct ListedOrgan {
  OrganInfo info;  ///< still without `closed` and `volume`, which take time for a large mesh
  std::shared_ptr<OrganSurface> surface;
  SharedVertices vertices;
};

/// All organs, sorted by name. For the thread that owns the organs: does not read their vertices.
std::vector<ListedOrgan> list_organs(const OrganRegistry& organs);

/// The organ with `closed` and `volume`. For the background thread: finds out what is not yet
/// known.
OrganInfo completed(const ListedOrgan& organ);

/// Serves `list_organs` and `remove_organ`.
///
/// The background thread serves `list_organs`, because volumes of large organs take milliseconds.
/// It asks the node's thread only for the list, so that no step waits for the rest.
class OrganServices {
 public:
  /// All must outlive this. `node_queue`: of the thread that owns the organs. `background`: of the
  /// thread that finds out surfaces.
  OrganServices(const OrganRegistry& organs, OrganIntake& intake, ros::CallbackQueue& node_queue,
                ros::CallbackQueueInterface& background)
      : organs_(organs), intake_(intake), node_queue_(node_queue), background_(background) {}

  void advertise(ros::NodeHandle private_node);

  /// In the background thread. Returns false if the node ends before its thread has answered.
  bool on_list(ListOrgans::Request& request, ListOrgans::Response& response);
  /// In the node's thread. Does what a mesh without vertices and triangles does.
  bool on_remove(RemoveOrgan::Request& request, RemoveOrgan::Response& response);

 private:
  const OrganRegistry& organs_;
  OrganIntake& intake_;
  ros::CallbackQueue& node_queue_;
  ros::CallbackQueueInterface& background_;
  ros::ServiceServer list_, remove_;
};

}  // namespace organ_collision
