#pragma once

#include <organ_collision/ContactArray.h>
#include <organ_collision/Grasp.h>
#include <organ_collision/TouchEvent.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

#include "node/organs/organ_registry.hpp"
#include "node/steps/step.hpp"
#include "query/grasp.hpp"

namespace organ_collision {

/// The side from which a link first touched a face.
struct FaceSide {
  std::uint32_t face;
  std::int32_t link;
  ros::Time since;         ///< Contact::since
  bool is_behind = false;  ///< the side to which the face does not point, by the right-hand rule
};

/// Finds in the answers of the steps when each tool begins to touch each organ, and when it ceases;
/// and when its jaws grasp the organ, and let it go.
///
/// A touch begins with the first contact while nothing is touched. It ends with the first answer at
/// whose end no contact is `touching`. So a tool that touches and leaves within one step begins and
/// ends a touch. Answers that are not OK change nothing, unless they fail for longer than 1 s. A
/// grasp outlasts the end of a touch, unless that end has a reason.
class TouchTracker {
 public:
  using Time = std::chrono::steady_clock::time_point;        ///< of the node's own clock
  using OrganAndTool = std::pair<std::string, std::string>;  ///< their names
  template <typename Event>
  using Publish = std::function<void(const Event&)>;

  /// These get the events, in order.
  TouchTracker(Publish<TouchEvent> publish, Publish<Grasp> publish_grasp)
      : publish_(std::move(publish)), publish_grasp_(std::move(publish_grasp)) {}

  /// Takes the next step of a tool and an organ, whose answer is given at `now`. How long answers
  /// fail is measured with `now`, because the stamp of a refused message may be any number.
  /// `hold_sec`: NodeParameters::grasp_hold_sec.
  void follow(const ToolStep& step, Time now, double hold_sec);
  /// Takes an answer that is not OK.
  void follow_failure(const ContactArray& answer, Time now);
  /// Ends the touches and grasps of all tools and organs, with the stamp of their last answer.
  void end_all(const std::string& reason);
  /// Ends the touches and grasps of organs and tools that are gone, or that have begun another
  /// history, and forgets these pairs.
  void end_histories(const OrganRegistry& organs, const std::vector<Tool>& tools);

 private:
  /// What is known of a pair of organ and tool.
  struct Pair {
    std::uint64_t organ_history, tool_history;
    std::uint32_t count = 0;  ///< of touches that have begun
    bool is_touched = false;
    ros::Time began = {},
              last = {};  ///< when the touch began; the stamp of the last answer that was OK
    std::optional<Time> failing = {};  ///< when the first failed answer since then was given
    TouchEvent place = {};             ///< the place that was touched last
    double deepest = 0.0;              ///< [m]
    std::uint32_t topology = 0;
    std::unordered_set<std::uint32_t> faces = {};  ///< touched faces of the present triangles
    std::size_t earlier_faces = 0;                 ///< number of touched faces of earlier triangles

    std::vector<FaceSide> sides = {};  ///< of the touched faces of an open organ, sorted
    GraspMemory jaws = {};
    std::uint32_t grasps = 0;  ///< number of grasps that have begun
    ros::Time grasped = {};    ///< when the grasp began
    std::optional<Grasp> grasp =
        {};  ///< as in the last answer in which a pair opposed; none: no grasp
  };

  void begin(const ContactArray& answer, Pair& pair);
  void end(Pair& pair, ros::Time stamp, const std::string& reason);
  void end_for(const std::string& reason, Pair& pair);
  void follow_jaws(const ToolStep& step, double hold_sec, Pair& pair);
  void release(Pair& pair, const std::string& reason);

  Publish<TouchEvent> publish_;
  Publish<Grasp> publish_grasp_;
  std::map<OrganAndTool, Pair> pairs_;
};

}  // namespace organ_collision
