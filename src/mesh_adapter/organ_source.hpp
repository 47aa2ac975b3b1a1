#pragma once

#include <ros/time.h>
#include <topic_tools/shape_shifter.h>

#include <cstdint>
#include <string>

#include "marker_reader.hpp"
#include "mesh_adapter_parameters.hpp"
#include "organ_feed.hpp"
#include "surface.hpp"

namespace organ_collision {

/// One organ, from messages of whatever type to its feed. A refused message changes nothing.
class OrganSource {
 public:
  OrganSource(OrganParameters parameters, std::uint32_t last_topology, OrganFeed::Outlet outlet);

  const OrganParameters& parameters() const { return parameters_; }

  /// A message of `topic`. `arrival`: its stamp, where it has none. Throws MessageError.
  void take_surface(const topic_tools::ShapeShifter& message, ros::Time arrival);
  /// The same of `vertices_topic`.
  void take_vertices(const topic_tools::ShapeShifter& message, ros::Time arrival);

  /// As OrganFeed::mesh().
  OrganMeshPtr mesh() const { return feed_.mesh(); }

 private:
  void read(const topic_tools::ShapeShifter& message);
  std::string frame_or_given(const std::string& named);

  OrganParameters parameters_;
  OrganFeed feed_;
  MarkerReader marker_reader_;
  Surface surface_;  ///< of the last message; only its memory is used again
  bool has_warned_ = false;
};

}  // namespace organ_collision
