#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <organ_collision/ContactArray.h>
#include <ros/node_handle.h>

#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "contact_adapter_parameters.hpp"
#include "force_law.hpp"
#include "forces/forces.hpp"
#include "ros/messages/failure_log.hpp"
#include "ros/node/program.hpp"

namespace organ_collision {

/// The node: turns the collision node's contacts into a wrench, forces on vertices and a list of
/// faces for each pair of organ and tool. It logs and counts an answer that reports a failure, but
/// publishes nothing for it, because the contacts are unknown then. All its work is done in the
/// callbacks of the node's queue, which must be called from one thread.
class ContactAdapter {
 public:
  /// Throws ParameterError.
  ContactAdapter(ros::NodeHandle node, const ros::NodeHandle& private_node);

 private:
  struct Pair {
    ros::Publisher faces;
    ros::Publisher wrench;
    ros::Publisher vertex_forces;
    ForceLaw law;
    /// When the law was last evaluated. Steady time, because the stamps of a tool stop advancing if
    /// its poses are not published while it rests.
    std::chrono::steady_clock::time_point evaluated = {};
  };

  void on_contacts(const ContactArray& message);
  void publish(const ContactArray& contacts, Pair& pair);
  std::vector<FaceForce> forces_of(const ContactArray& contacts, Pair& pair);
  Pair& pair_of(const std::string& organ, const std::string& tool);
  KeptSides::Radius radius_of(const std::string& tool) const;
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);

  ros::NodeHandle private_node_;
  ContactAdapterParameters parameters_;
  LiveParameters live_parameters_;
  PairNames names_;
  std::map<std::pair<std::string, std::string>, Pair> pairs_;  ///< by organ and tool
  std::uint64_t received_ = 0;  ///< messages, including those that report a failure
  FailureLog failures_;
  FailureLog clipped_;  ///< wrenches whose force was reduced to max_force
  diagnostic_updater::Updater updater_;
  ros::WallTimer diagnostic_timer_;
  ros::Subscriber subscriber_;
  MasterWatch master_;
};

}  // namespace organ_collision
