#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <organ_collision/ContactArray.h>
#include <organ_collision/OrganMesh.h>
#include <ros/time.h>

#include <Eigen/Geometry>
#include <cstddef>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "test/check_contacts/contact_contract.hpp"

namespace organ_collision::stress {

/// What all threads of the test found wrong, and how many answers they checked.
class Findings {
 public:
  /// An answer of a service.
  void check(const std::string& source, const ContactArray& answer);
  /// An answer on `contacts`, in the order in which they came.
  void check_step(const ContactArray& answer, const std::string& publisher);
  void add(const std::string& sentence);

  std::size_t checked() const;
  /// How many of the checked answers are OK.
  std::size_t answered() const;
  /// One line for each kind of finding; empty if there are none.
  std::string text() const;

 private:
  void count(const std::string& source, const ContactArray& answer, const Faults& faults);

  ContactContract steps_;
  mutable std::mutex mutex_;
  std::size_t checked_ = 0, answered_ = 0;
  std::set<std::string> sentences_;
};

/// A wavy square sheet of 0.1 m around the origin, with `cells` times `cells` squares of two faces.
struct Sheet {
  std::size_t cells;

  /// x y z x y z ... [m]. `phase` [rad] moves the waves on.
  std::vector<float> vertices(double phase) const;
  /// Without the first `cut` squares: a sheet that was cut has other triangles.
  std::vector<std::uint32_t> triangles(std::size_t cut) const;
};

/// A mesh message with a name and the frame of the sheets, "sheet", and the time of now.
OrganMeshPtr mesh_message(const std::string& organ, const Sheet& sheet, std::size_t cut,
                          double phase);

/// Where the tools of tools.yaml are, in the frame "sheet" [m].
struct ToolPlaces {
  Eigen::Vector3d probe_tip, needle_tip, stylus_tip;
  Eigen::Isometry3d jaw;
};

inline const Eigen::Vector3d kProbeTrocar{0.02, 0.01, 0.15};
inline const Eigen::Vector3d kNeedleTrocar{-0.02, 0.01, 0.15};
inline const Eigen::Vector3d kStylusTrocar{0.01, -0.02, 0.15};

/// The tools go up and down through the sheets, and the jaw turns. `phase`: [rad] of this motion.
ToolPlaces tool_places(double phase);

/// The trocars, for /tf_static.
std::vector<geometry_msgs::TransformStamped> resting_transforms(ros::Time stamp);
/// The tips of "probe" and "needle" and the link "jaw", for /tf.
std::vector<geometry_msgs::TransformStamped> moving_transforms(const ToolPlaces& places,
                                                               ros::Time stamp);
/// The tip of "stylus", for its own topic.
geometry_msgs::PoseStamped stylus_pose(const ToolPlaces& places, ros::Time stamp);

}  // namespace organ_collision::stress
