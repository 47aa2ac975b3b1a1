#include "node_parameters.hpp"

#include <ros/names.h>

#include <initializer_list>
#include <limits>

#include "organ_collision/ros/names.hpp"
#include "parameter_help.hpp"
#include "ros/interface/conversions.hpp"

namespace organ_collision {
namespace {

using XmlRpc::XmlRpcValue;

constexpr double kUnlimited = std::numeric_limits<double>::infinity();
/// [bytes] roscpp refuses larger messages.
constexpr double kMostMessageBytes = 1e9;
/// With more faces, a message would be too large: each face has three indices of four bytes.
constexpr double kMostFaces = 83'333'333;

const NumberRange kRateRange{0.0, 10'000.0};
const NumberRange kTfTimeoutRange{0.0, 60.0};
const NumberRange kMeshTimeoutRange{0.0, kUnlimited};
constexpr double kSlowest = 0.001;           // [Hz]
const NumberRange kFrameRates{0.0, 1000.0};  // [Hz]
const NumberRange kPositive{0.0, kUnlimited, false};
const NumberRange kMarginRange{0.0, kUnlimited};
const NumberRange kMaxNearRange{0, 1'000'000};

const std::string kShaft = "trocar_frame, tip_frame and radius";

std::string frame(const ParameterGroup& tool, const char* name) {
  std::string frame = tf_frame(tool.text(name));
  if (frame.empty()) tool.refuse(name, "must be the name of a TF frame");
  tool.check_name(name, frame);
  return frame;
}

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
  parsed.tip_frame = is_named ? frame(tool, names::kTipFrame) : unnamed;
}

void parse_shaft(const ParameterGroup& tool, ToolParameters& parsed) {
  parsed.trocar_frame = frame(tool, names::kTrocarFrame);
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
  return parsed;
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
         names::kUrdf, names::kTfPrefix, names::kMargin, names::kMaxNear});
    const ToolParameters tool = parse_tool(group);
    for (const ToolParameters& other : loaded.tools) {
      if (other.name == tool.name) group.refuse(names::kToolName, "must be unique among the tools");
    }
    loaded.tools.push_back(tool);
    for (std::string& sentence : group.misspelt()) loaded.misspelt.push_back(std::move(sentence));
  }
  return loaded;
}

ParameterGroup node_group(const XmlRpcValue& private_namespace) {
  return {
      "~",
      private_namespace,
      {names::kTools, names::kPicker, names::kRate, names::kOrganMotion, names::kMotionSampleSec,
       names::kMotionSamplesMax, names::kTfTimeoutSec, names::kMeshTimeoutSec, names::kMaxFaces,
       names::kMaxBatch, names::kMaxBatchBytes, names::kPublishRegions, names::kPublishPlacement,
       names::kDiagnosticPeriod, names::kMarkersRate, names::kSurfaceRate, names::kMarkersDepth}};
}

/// A rate may be zero, but not so small that its period is longer than ROS timers accept.
double rate(const ParameterGroup& all, const char* name, double fallback,
            const NumberRange& range) {
  const double rate = all.number(name, fallback, range);
  if (rate > 0.0 && rate < kSlowest) all.refuse(name, "must be 0 or at least 0.001");
  return rate;
}

/// Missing members keep their values.
void parse_markers(const ParameterGroup& all, MarkerSettings& markers) {
  markers.markers_rate_hz = rate(all, names::kMarkersRate, markers.markers_rate_hz, kFrameRates);
  markers.surface_rate_hz = rate(all, names::kSurfaceRate, markers.surface_rate_hz, kFrameRates);
  markers.markers_depth = all.number(names::kMarkersDepth, markers.markers_depth, kPositive);
}

/// Missing members keep their values.
void parse_live(const ParameterGroup& all, LiveNodeParameters& p) {
  p.rate_hz = rate(all, names::kRate, p.rate_hz, kRateRange);
  p.tf_timeout_sec = all.number(names::kTfTimeoutSec, p.tf_timeout_sec, kTfTimeoutRange);
  p.mesh_timeout_sec = all.number(names::kMeshTimeoutSec, p.mesh_timeout_sec, kMeshTimeoutRange);
  p.publish_regions = all.flag(names::kPublishRegions, p.publish_regions);
  p.publish_placement = all.flag(names::kPublishPlacement, p.publish_placement);
  parse_markers(all, p.markers);
}

}  // namespace

std::string ToolParameters::link_frame(const std::string& link) const {
  return tf_frame(tf_prefix.empty() ? link : tf_prefix + "/" + link);
}

LoadedParameters parse_parameters(const XmlRpcValue& private_namespace) {
  const ParameterGroup all = node_group(private_namespace);
  LoadedTools tools = parse_tools(all);
  LoadedParameters loaded{{}, std::move(tools.misspelt)};
  NodeParameters& p = loaded.parameters;
  p.tools = std::move(tools.tools);
  parse_live(all, p);
  p.picker = picker_kind(all.choice(names::kPicker, "feedback", {"feedback", "select"}));
  p.organ_motion = all.flag(names::kOrganMotion, p.organ_motion);
  p.motion_sample_sec = all.number(names::kMotionSampleSec, p.motion_sample_sec, kPositive);
  p.motion_samples_max =
      all.whole_number(names::kMotionSamplesMax, p.motion_samples_max, {1, 100'000});
  p.max_faces = all.whole_number(names::kMaxFaces, p.max_faces, {1, kMostFaces});
  p.max_batch = all.whole_number(names::kMaxBatch, p.max_batch, {1, 1'000'000});
  p.max_batch_bytes =
      all.whole_number(names::kMaxBatchBytes, p.max_batch_bytes, {1, kMostMessageBytes});
  p.diagnostic_period_sec =
      all.number(names::kDiagnosticPeriod, p.diagnostic_period_sec, {0.01, 3600.0});
  return loaded;
}

LoadedParameters load_parameters(const ros::NodeHandle& private_node) {
  return parse_parameters(all_parameters(private_node));
}

LoadedTools load_tool_parameters(const ros::NodeHandle& private_node) {
  return parse_tools(node_group(all_parameters(private_node)));
}

std::vector<LiveParameter> live_parameters(const LiveNodeParameters& p) {
  const std::vector<HelpEntry> help = parameter_help();
  const LiveNodeParameters defaults;
  const auto number = [&](const char* name, double value, double fallback,
                          const NumberRange& range) {
    return LiveParameter{name, text_of(help, name), value, fallback, range};
  };
  return {number(names::kRate, p.rate_hz, defaults.rate_hz, kRateRange),
          number(names::kTfTimeoutSec, p.tf_timeout_sec, defaults.tf_timeout_sec, kTfTimeoutRange),
          number(names::kMeshTimeoutSec, p.mesh_timeout_sec, defaults.mesh_timeout_sec,
                 kMeshTimeoutRange),
          LiveParameter{names::kPublishRegions, text_of(help, names::kPublishRegions),
                        p.publish_regions, defaults.publish_regions},
          LiveParameter{names::kPublishPlacement, text_of(help, names::kPublishPlacement),
                        p.publish_placement, defaults.publish_placement},
          number(names::kMarkersRate, p.markers.markers_rate_hz, defaults.markers.markers_rate_hz,
                 kFrameRates),
          number(names::kSurfaceRate, p.markers.surface_rate_hz, defaults.markers.surface_rate_hz,
                 kFrameRates),
          number(names::kMarkersDepth, p.markers.markers_depth, defaults.markers.markers_depth,
                 kPositive)};
}

LiveNodeParameters changed(const LiveNodeParameters& parameters, const XmlRpcValue& changes) {
  LiveNodeParameters result = parameters;
  parse_live(live_group(changes, live_parameters(parameters)), result);
  return result;
}

}  // namespace organ_collision
