#pragma once

#include <ros/time.h>
#include <topic_tools/shape_shifter.h>

#include <cstdint>
#include <string>

#include "marker_reader.hpp"
#include "mesh_adapter_parameters.hpp"
#include "organ_feed.hpp"
#include "received_surface.hpp"

namespace organ_collision {

/// One organ: reads its messages, of any supported type, and passes its surface to its feed. A
/// message that is refused changes nothing.
class OrganSource {
 public:
  OrganSource(OrganParameters parameters, std::uint32_t last_topology, OrganFeed::Outlet outlet);

  const OrganParameters& parameters() const { return parameters_; }

  /// Takes a message of `topic`. `arrival` replaces a missing stamp. Throws MessageError.
  void take_surface(const topic_tools::ShapeShifter& message, ros::Time arrival);
  /// Takes a message of `vertices_topic`, in the same way.
  void take_vertices(const topic_tools::ShapeShifter& message, ros::Time arrival);

  /// See OrganFeed::mesh().
  OrganMeshPtr mesh() const { return feed_.mesh(); }

 private:
  void read(const topic_tools::ShapeShifter& message);
  std::string frame_or_given(const std::string& named);

  OrganParameters parameters_;
  OrganFeed feed_;
  MarkerReader marker_reader_;
  ReceivedSurface surface_;  ///< of the last message; kept only to reuse its memory
  bool has_warned_ = false;
};

}  // namespace organ_collision
