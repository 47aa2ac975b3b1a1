#include "tool_parameters.hpp"

#include <ros/names.h>

#include <initializer_list>
#include <limits>
#include <utility>

#include "organ_collision/ros/names.hpp"
#include "ros/messages/conversions.hpp"

namespace organ_collision {
namespace {

using XmlRpc::XmlRpcValue;

constexpr double kUnlimited = std::numeric_limits<double>::infinity();

const NumberRange kPositive{0.0, kUnlimited, false};
const NumberRange kMarginRange{0.0, kUnlimited};
const NumberRange kMaxNearRange{0, 1'000'000};

const std::string kShaft = "trocar_frame, tip_frame and radius";

/// The name of a topic; empty if the parameter is not set.
std::string topic(const ParameterGroup& tool, const char* name) {
  if (!tool.has(name)) return {};
  std::string topic = tool.text(name), error;
  if (!ros::names::validate(topic, error) || topic.front() == '~') {
    tool.refuse(name, "must be the name of a topic, without ~");
  }
  return topic;
}

std::string parameter_name(const ParameterGroup& tool, const char* name) {
  std::string parameter = tool.text(name), error;
  if (!ros::names::validate(parameter, error)) tool.refuse(name, "must be a parameter's name");
  return parameter;
}

std::string tf_prefix(const ParameterGroup& tool) {
  std::string prefix = tf_frame(tool.text(names::kTfPrefix));
  if (prefix.empty() || prefix.back() == '/') {
    tool.refuse(names::kTfPrefix, "must be without a slash at its end");
  }
  return prefix;
}

void refuse_any(const ParameterGroup& tool, std::initializer_list<const char*> names,
                const std::string& why) {
  for (const char* name : names) {
    if (tool.has(name)) tool.refuse(name, why);
  }
}

/// Parses where the pose of the tip comes from: a frame on TF, or a topic. A tool without a shaft
/// may have such a topic, too. `unnamed`: the tip frame if the parameters name only a topic.
void parse_tip(const ParameterGroup& tool, const std::string& unnamed, ToolParameters& parsed) {
  parsed.tip_pose_topic = topic(tool, names::kTipPoseTopic);
  parsed.base_pose_topic = topic(tool, names::kBasePoseTopic);
  if (!parsed.base_pose_topic.empty() && parsed.tip_pose_topic.empty()) {
    tool.refuse(names::kBasePoseTopic, "goes with tip_pose_topic, in whose frame its poses are");
  }
  const bool is_named = tool.has(names::kTipFrame) || parsed.tip_pose_topic.empty();
  parsed.tip_frame = is_named ? parse_frame(tool, names::kTipFrame) : unnamed;
}

void parse_shaft(const ParameterGroup& tool, ToolParameters& parsed) {
  parsed.trocar_frame = parse_frame(tool, names::kTrocarFrame);
  parsed.radius = tool.number(names::kRadius, {}, kPositive);
  parse_tip(tool, parsed.name + "_tip", parsed);
  if (parsed.tip_frame == parsed.trocar_frame) {
    tool.refuse(names::kTipFrame, "must be another frame than trocar_frame");
  }
}

void parse_links(const ParameterGroup& tool, ToolParameters& parsed) {
  parsed.links = tool.texts(names::kLinks);
  for (const std::string& link : parsed.links) tool.check_name(names::kLinks, link);
  if (!tool.has(names::kUrdf)) {
    parsed.robot_description = tool.has(names::kRobotDescription)
                                   ? parameter_name(tool, names::kRobotDescription)
                                   : names::kRobotDescription;
  } else {
    refuse_any(tool, {names::kRobotDescription}, "is not needed beside urdf; give one of them");
    parsed.urdf = tool.text(names::kUrdf);
  }
  if (tool.has(names::kTfPrefix)) parsed.tf_prefix = tf_prefix(tool);
}

void parse_clearance(const ParameterGroup& tool, ToolParameters& parsed) {
  parsed.margin = tool.number(names::kMargin, parsed.margin, kMarginRange);
  parsed.max_near = tool.whole_number(names::kMaxNear, parsed.max_near, kMaxNearRange);
  if (parsed.max_near > 0 && parsed.margin == 0.0) {
    tool.refuse(names::kMaxNear, "must be 0 unless the tool has a margin above 0");
  }
}

/// A shaft goes through a trocar unless the parameters say otherwise.
ProxyFreedom parse_freedom(const ParameterGroup& tool, bool has_shaft) {
  const std::string fallback = has_shaft ? "trocar" : "free";
  const std::string freedom = tool.choice(names::kFreedom, fallback, {"trocar", "free"});
  if (freedom == "free") return ProxyFreedom::kFree;
  if (!has_shaft) tool.refuse(names::kFreedom, "goes with a shaft; must be free without " + kShaft);
  return ProxyFreedom::kTrocar;
}

ToolParameters parse_tool(const ParameterGroup& tool) {
  ToolParameters parsed;
  parsed.name = tool.text(names::kToolName);
  tool.check_name(names::kToolName, parsed.name);
  const bool has_links = tool.has(names::kLinks);
  const bool has_poses = tool.has(names::kTipPoseTopic) || tool.has(names::kBasePoseTopic);
  const bool has_tip = tool.has(names::kTipFrame) || has_poses;
  const bool has_shaft = tool.has(names::kTrocarFrame) || tool.has(names::kRadius) ||
                         (tool.has(names::kTipFrame) && !has_poses && !has_links);
  if (!has_links && !has_shaft) {
    tool.refuse_missing(names::kLinks, "a tool needs links, or " + kShaft + ", or all of them");
  }
  if (has_links) {
    parse_links(tool, parsed);
  } else {
    refuse_any(tool, {names::kRobotDescription, names::kUrdf, names::kTfPrefix},
               "goes with links, which are missing");
  }
  if (has_shaft) {
    parse_shaft(tool, parsed);
  } else if (has_tip) {
    parse_tip(tool, parsed.link_frame(parsed.links.front()), parsed);
  }
  parse_clearance(tool, parsed);
  parsed.freedom = parse_freedom(tool, has_shaft);
  return parsed;
}

}  // namespace

std::string parse_frame(const ParameterGroup& group, const char* name) {
  std::string frame = tf_frame(group.text(name));
  if (frame.empty()) group.refuse(name, "must be the name of a TF frame");
  group.check_name(name, frame);
  return frame;
}

std::string ToolParameters::link_frame(const std::string& link) const {
  return tf_frame(tf_prefix.empty() ? link : tf_prefix + "/" + link);
}

LoadedTools parse_tools(const ParameterGroup& all) {
  LoadedTools loaded{{}, all.misspelt()};
  const XmlRpcValue& list =
      all.list(names::kTools, "groups of name and links, or name, " + kShaft + " [m]");
  for (int i = 0; i < list.size(); ++i) {
    const ParameterGroup group(
        all.path_of(names::kTools) + "[" + std::to_string(i) + "]", list[i],
        {names::kToolName, names::kTrocarFrame, names::kTipFrame, names::kTipPoseTopic,
         names::kBasePoseTopic, names::kRadius, names::kLinks, names::kRobotDescription,
         names::kUrdf, names::kTfPrefix, names::kMargin, names::kMaxNear, names::kFreedom});
    const ToolParameters tool = parse_tool(group);
    for (const ToolParameters& other : loaded.tools) {
      if (other.name == tool.name) group.refuse(names::kToolName, "must be unique among the tools");
    }
    loaded.tools.push_back(tool);
    for (std::string& sentence : group.misspelt()) loaded.misspelt.push_back(std::move(sentence));
  }
  return loaded;
}

}  // namespace organ_collision
