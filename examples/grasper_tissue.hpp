#pragma once

#include <ros/service_client.h>

#include <cstddef>

#include "grasper_places.hpp"

namespace grasper {

/// Asks the collision node what the grasper would touch.
class Tissue {
 public:
  /// Waits for the node and the liver.
  Tissue();

  struct Answer {
    std::size_t free;  ///< how many motions are free, before the first one that is not
    double least;      ///< [m] the smallest distance of these from the tissue, at most `margin`
  };

  /// Asks for the motions from place to place. Up to `margin` [m], the distance from the tissue is
  /// measured. Throws std::runtime_error if there is no answer.
  Answer sweep(const Path& places, double margin = 0.0);

 private:
  ros::ServiceClient client_;
};

}  // namespace grasper
