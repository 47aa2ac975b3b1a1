#pragma once

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "organ_collision/query/haptic_proxy.hpp"
#include "organ_oracle.hpp"
#include "test/proof/trials.hpp"

namespace organ_collision::oracle {

/// What proxies did, and which promises they broke.
struct ProxyTally {
  long ticks = 0;
  long touching = 0;      ///< TOUCHING
  long squeezed = 0;      ///< SQUEEZED
  long jumps = 0;         ///< of the hand
  long overrun = 0;       ///< placed anew because tissue moved through the proxy
  long no_answer = 0;     ///< NO_ANSWER
  long near = 0;          ///< nearer than half the clearance, but not SQUEEZED
  long through = 0;       ///< no way leads around the tissue that a middle line met
  long inside = 0;        ///< a middle line begins or ends inside a closed organ
  long held = 0;          ///< longer than needed: the straight way to the hand was free for a while
  long inconsistent = 0;  ///< FREE but not at the hand, or values that contradict each other
  long at_clearance = 0;  ///< TOUCHING, and as far from tissue as the clearance says
  double least = INFINITY;           ///< [m] the smallest distance up to the clearance
  double least_squeezed = INFINITY;  ///< [m] the same, where SQUEEZED
  std::vector<float> seconds;        ///< of processor time that each tick took

  long broken() const {
    return overrun + no_answer + near + through + inside + held + inconsistent;
  }
  void add(const ProxyTally& other);
};

/// Checks each tick of a proxy with oracles that share nothing with it but the mesh.
class Referee {
 public:
  /// Receives a sentence about each broken promise.
  using Report = std::function<void(const std::string&)>;

  Referee(ProxyTool tool, const ProxySettings& settings, Report report);

  /// `jumped`: the hand moved farther than the settings' jump. `is_closed`: of each organ.
  void check(const ToolPose& hand, bool jumped, const std::vector<ProxyOrgan>& organs,
             const std::vector<bool>& is_closed, const ProxyAnswer& answer);

  /// Without the times.
  const ProxyTally& tally() const { return tally_; }

 private:
  /// An organ, and the tool's middle lines in its frame at the last tick.
  struct Organ {
    OrganOracle oracle;
    std::vector<ShaftAxis> lines;
  };

  void count_state(bool jumped, const ProxyAnswer& answer);
  void check_values(const ToolPose& hand, const ProxyAnswer& answer);
  double check_distance(const std::vector<PlacedCore>& parts, const Organ& organ, double clearance,
                        ProxyStatus state);
  double check_distances(const ProxyOrgan& of, const Organ& organ, const ProxyAnswer& answer);
  ProxyTool held_by(const ProxyOrgan& organ) const;
  void check_passage(const std::vector<ShaftAxis>& lines, const Organ& organ);
  void check_squeeze(const ToolPose& hand, const std::vector<ProxyOrgan>& organs,
                     const ProxyAnswer& answer);
  void check_way(const ToolPose& hand, const std::vector<ProxyOrgan>& organs,
                 const ProxyAnswer& answer);
  void check_side(const std::vector<ShaftAxis>& lines, const Organ& organ);
  void blame(long& count, const std::string& what);

  ProxyTool tool_;
  ProxySettings settings_;
  Report report_;
  ProxyTally tally_;
  std::vector<Organ> organs_;
  Random random_{1};
  // As the last tick left them.
  Eigen::Vector3d last_trocar_ = Eigen::Vector3d::Zero();
  std::vector<ProxyOrgan> last_organs_;
  bool was_squeezed_ = false;
  long clear_ways_ = 0;  ///< how often in a row the way to the hand was clear
};

}  // namespace organ_collision::oracle
