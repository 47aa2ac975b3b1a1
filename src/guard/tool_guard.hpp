#pragma once

#include <organ_collision/ContactArray.h>
#include <organ_collision/GuardState.h>
#include <organ_collision/OrganInfo.h>
#include <organ_collision/ToolInfo.h>

#include <Eigen/Core>
#include <deque>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "guard_parameters.hpp"

namespace organ_collision {

/// The clocks of the guard. The one of ROS is that of the stamps, and may stand still or jump.
struct GuardTime {
  double steady = 0.0;  ///< [s] of a clock that never stands still
  ros::Time ros;
};

/// Decides how fast one tool may go on: answers of the collision node in, states out. It has no
/// clock and no communication of its own.
///
/// The scale is that of GuardState.msg while the tool rests or moves slowly. It is lower while it
/// falls: states that were sent before allowed a higher speed, and the tool may follow each of them
/// for as long as `latency`. So the way that a tool may still go is counted with those speeds.
class ToolGuard {
 public:
  /// `parameters` must outlive this, and may change between calls.
  explicit ToolGuard(const GuardParameters& parameters, ToolInfo tool)
      : parameters_(parameters), tool_(std::move(tool)) {}

  /// What a guard with these parameters needs and this tool has not, with the cure, as a sentence.
  /// Empty: it has all.
  static std::string missing_in(const ToolInfo& tool, const GuardParameters& parameters);

  const ToolInfo& tool() const { return tool_; }
  void set_tool(ToolInfo tool) { tool_ = std::move(tool); }
  /// Takes an answer about this tool. `outward`: the unit vector from tip to trocar in the frame of
  /// the answer; zero if there is no trocar, or if it is not known where it is.
  void take(const ContactArray::ConstPtr& answer, const Eigen::Vector3d& outward, GuardTime now);
  /// Answers were lost on their way. Each organ stops the tool until its next answer.
  void lose_answers();
  /// Takes the organs that the collision node has. `asked`: [s] when it was asked, on the steady
  /// clock. Organs that are not listed and have not been in an answer since then are dropped.
  void set_organs(const std::vector<OrganInfo>& organs, double asked);

  /// The state that must be sent now. Each state that is decided must be sent.
  GuardState decide(GuardTime now);

 private:
  /// What is known of an organ.
  struct Organ {
    ContactArray::ConstPtr answer;  ///< the last one; null: there was none
    Eigen::Vector3d outward{0.0, 0.0, 0.0};
    double arrived = -kUnlimited;  ///< [s] when the last answer came, on the steady clock
    bool lost = false;             ///< an answer may have been lost since
    bool listed = false;
    bool closed = true;  ///< its surface, if it is listed
  };
  /// What one place of the tool allows, or one organ. An empty reason is filled in later.
  struct Verdict {
    GuardState state;
    double bound = 0.0;                  ///< [m] the tool is not nearer to tissue
    double tissue = 0.0;                 ///< [m/s] at which the tissue comes
    double approach = 0.0;               ///< [m/s] at which the tool may approach the place
    Eigen::Vector3d way{0.0, 0.0, 0.0};  ///< the way out of this place alone; zero: not known
    bool is_listed = true;               ///< false: tissue that the answer does not list
  };

  void judge(const std::string& name, const Organ& organ, GuardTime now,
             std::vector<Verdict>& verdicts) const;
  std::string untrusted(const Organ& organ, GuardTime now) const;
  std::string forbidden(const std::string& name, const Organ& organ) const;
  bool is_wrong(const std::string& name, const Organ& organ, std::uint8_t side) const;
  bool may_touch(const ContactArray& answer, int link) const;
  Eigen::Vector3d retreat(const std::string& name, const Organ& organ,
                          const Eigen::Vector3d& normal) const;
  Eigen::Vector3d way_out(const Verdict& chosen, const std::vector<Verdict>& verdicts) const;
  double allowed_speed(double distance, double tissue, double now) const;
  void hold(GuardState& state, double now);
  void note_sent(double speed, double now);

  const GuardParameters& parameters_;
  ToolInfo tool_;
  std::map<std::string, Organ> organs_;
  bool has_list_ = false;
  /// When [s] the lowest scales of the last hold_sec were decided, and the states. They rise.
  std::deque<std::pair<double, GuardState>> recent_;
  /// From when on [s], and a speed [m/s]: at least the highest of all states that were sent from
  /// then on. The speeds fall.
  std::deque<std::pair<double, double>> sent_;
};

}  // namespace organ_collision
