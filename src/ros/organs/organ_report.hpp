#pragma once

#include <ros/callback_queue_interface.h>

#include <chrono>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "deformable_organ.hpp"
#include "organ_registry.hpp"

namespace organ_collision {

// What users are told about an organ in its latest shape.

/// "closed", "open (12 edges)", or "not yet known". An edge is open if it has no opposite.
std::string closedness(const OrganSurface& surface);
/// "outward" or "inward" for a closed surface, otherwise "none". "not yet known" if it is not
/// found.
std::string orientation(const OrganSurface& surface);
/// For example "organ 'kidney': 2208 faces, closed, 0.12 x 0.09 x 0.06 m".
std::string summary(const DeformableOrgan& organ);
/// Whole sentences about what is legal, but probably a mistake: the organ's size, and faces that
/// point inward.
std::vector<std::string> doubts(const DeformableOrgan& organ);

/// Has the surface of each new mesh inspected in a background thread, and tells the user in the log
/// what came.
class SurfaceInspector {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// An organ whose triangles change all the time, as in cutting, is told about at most once in
  /// this time. The same holds for what is doubtful about it.
  static constexpr std::chrono::seconds kLogPeriod{5};

  /// `background`: the queue of the thread that finds out the surfaces. It must outlive this.
  explicit SurfaceInspector(ros::CallbackQueueInterface& background) : background_(background) {}

  /// Starts on the meshes that are new, and logs what is known by now. Returns at once. Costs
  /// nothing worth mentioning if no mesh is new.
  void update(const OrganRegistry& organs, Time now);

 private:
  struct Inspection {
    std::shared_ptr<OrganSurface> surface;
    bool told = true;
    Time next_summary{};  ///< not before this
    Time next_doubts{};
  };
  void start(const DeformableOrgan& organ, Inspection& inspection);
  static void tell(const DeformableOrgan& organ, Inspection& inspection, Time now);
  void forget_removed(const OrganRegistry& organs);

  ros::CallbackQueueInterface& background_;
  std::map<std::string, Inspection> inspections_;  ///< by organ
};

}  // namespace organ_collision
