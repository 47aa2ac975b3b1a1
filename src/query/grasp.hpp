#pragma once

#include <Eigen/Geometry>
#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <vector>

namespace organ_collision {

/// A contact of a jaw that touches at the end of a step.
struct JawContact {
  std::size_t link;  ///< index of the jaw's link
  std::uint32_t face;
  Eigen::Vector3d on_organ;  ///< [m]
  Eigen::Vector3d normal;    ///< that of the face, unit, into the tissue; zero: degenerate
};

/// What an answer OK tells of the jaws of a tool and one organ, at the end of its step.
struct JawsAnswer {
  std::chrono::nanoseconds stamp;
  bool same_triangles;                              ///< the last answer OK had the same triangles
  std::array<std::vector<JawContact>, 2> contacts;  ///< sorted by face
  std::array<Eigen::Vector3d, 2> centers;           ///< [m] of the jaws' boxes
  std::vector<Eigen::Isometry3d> links;             ///< T_organ_link of the tool's links
};

/// What decides whether jaws grasp, beside the definition in msg/Grasp.msg.
struct GraspLimits {
  double gap;                     ///< [m] ToolParameters::grasp_gap
  std::chrono::nanoseconds hold;  ///< NodeParameters::grasp_hold_sec
};

/// Contacts of two jaws that grasp what is between them.
struct OpposingPair {
  std::size_t first, second;  ///< their indices
  double distance;            ///< [m] from one to the other; 0 on both sides of one face
};

/// The places of an opposing pair, each of which moves rigidly with its jaw.
class CarriedPair {
 public:
  CarriedPair(const JawsAnswer& answer, const OpposingPair& pair);
  /// [m] How far apart they are if the tool's links have these poses.
  double distance(const std::vector<Eigen::Isometry3d>& links) const;
  /// [m] The distance of the pair when it opposed.
  double thickness() const { return thickness_; }

 private:
  std::array<std::size_t, 2> links_;
  std::array<Eigen::Vector3d, 2> in_link_;
  double thickness_;
};

/// What two jaws have done to an organ up to now, as msg/Grasp.msg defines it.
class GraspMemory {
 public:
  enum class Event { kNone, kGrasped, kOpened, kSlipped };

  /// Takes the next answer OK. The last two events end a grasp.
  Event follow(const JawsAnswer& now, const GraspLimits& limits);
  /// The nearest pair that opposes in the last answer; of several, the one with the least `first`,
  /// then the least `second`. None: no pair opposes.
  const std::optional<OpposingPair>& pair() const { return pair_; }

 private:
  /// The pose in which the jaws were farthest apart since both touch.
  struct WidestPose {
    double width;  ///< [m]
    std::vector<Eigen::Isometry3d> links;
  };
  struct Held {
    CarriedPair first, thinnest;  ///< the pair of GRASPED, and the one of least thickness
    double narrowest;             ///< [m] the least distance of `first` since
    std::optional<std::chrono::nanoseconds> without;  ///< since when no pair opposes
  };

  std::optional<OpposingPair> find_pair(const JawsAnswer& now, double gap, bool holds) const;
  void keep_widest(const JawsAnswer& now, std::chrono::nanoseconds hold);
  Event begin(const JawsAnswer& now, const GraspLimits& limits);
  Event go_on(const JawsAnswer& now, const GraspLimits& limits);

  std::optional<OpposingPair> pair_;
  bool opposed_ = false;              ///< a pair that begins a grasp opposed in the last answer
  std::optional<WidestPose> widest_;  ///< none: the jaws do not both touch
  std::optional<std::chrono::nanoseconds> apart_;  ///< since when they do not both touch
  std::optional<Held> held_;                       ///< none: there is no grasp
  std::optional<CarriedPair> opened_;  ///< what the opened jaws let go, while it still opposes
};

}  // namespace organ_collision
