#include "node_parameters.hpp"

#include <ros/names.h>

#include <algorithm>
#include <initializer_list>

#include "common/messages/text.hpp"
#include "organ_collision/ros/names.hpp"

namespace organ_collision {
namespace {

const std::string kShaftKeys = "trocar_frame, tip_frame and radius";
/// [m] A larger one was not given in metres.
constexpr NumberRange kRadii{0.0, 1.0, false};

/// The name of a topic that a tool's parameter gives; empty if the parameter is not set.
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

Eigen::Vector3d offset(const ParameterGroup& tool, const char* name) {
  return tool.has(name) ? tool.point(name) : Eigen::Vector3d(Eigen::Vector3d::Zero());
}

void refuse_any(const ParameterGroup& tool, std::initializer_list<const char*> names,
                const std::string& why) {
  for (const char* name : names) {
    if (tool.has(name)) tool.refuse(name, why);
  }
}

/// Parses where the pose of the tip comes from: a frame on TF, or a topic. A tool without a shaft
/// may have such a topic, too. `unnamed`: names the tip's frame if there is only a topic.
void parse_tip(const ParameterGroup& tool, const std::string& unnamed, ToolParameters& parsed) {
  parsed.tip_pose_topic = topic(tool, names::kTipPoseTopic);
  parsed.base_pose_topic = topic(tool, names::kBasePoseTopic);
  if (!parsed.base_pose_topic.empty() && parsed.tip_pose_topic.empty()) {
    tool.refuse(names::kBasePoseTopic, "goes with tip_pose_topic, in whose frame its poses are");
  }
  const bool is_named = tool.has(names::kTipFrame) || parsed.tip_pose_topic.empty();
  parsed.tip_frame = is_named ? tool.frame(names::kTipFrame) : unnamed;
  parsed.tip_offset = offset(tool, names::kTipOffset);
}

void parse_shaft(const ParameterGroup& tool, ToolParameters& parsed) {
  parsed.trocar_frame = tool.frame(names::kTrocarFrame);
  parsed.radius = tool.number(names::kRadius, {}, kRadii);
  parse_tip(tool, parsed.name + "_tip", parsed);
  parsed.trocar_offset = offset(tool, names::kTrocarOffset);
}

bool is_among(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

void parse_jaws(const ParameterGroup& tool, ToolParameters& parsed) {
  if (!tool.has(names::kFirstJaw) && !tool.has(names::kSecondJaw)) {
    return refuse_any(tool, {names::kGraspGap}, "goes with first_jaw, which is missing");
  }
  parsed.grasp_gap = tool.number(names::kGraspGap, parsed.grasp_gap, {0.0, 0.1});
  const std::array<const char*, 2> keys = {names::kFirstJaw, names::kSecondJaw};
  for (std::size_t jaw = 0; jaw < keys.size(); ++jaw) {
    parsed.jaws[jaw] = tool.texts(keys[jaw]);
    for (const std::string& link : parsed.jaws[jaw]) {
      tool.check_name(keys[jaw], link);
      if (!is_among(parsed.links, link)) {
        tool.refuse(keys[jaw],
                    "'" + link + "' is no link of the tool; " + suggestion(link, parsed.links));
      }
      if (jaw == 1 && is_among(parsed.jaws[0], link)) {
        tool.refuse(keys[jaw], "'" + link + "' is in first_jaw, too; a link belongs to one jaw");
      }
    }
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
  parse_jaws(tool, parsed);
}

void parse_clearance(const ParameterGroup& tool, ToolParameters& parsed) {
  parsed.margin = tool.number(names::kMargin, parsed.margin, kNotNegative);
  parsed.max_near =
      static_cast<int>(tool.number(names::kMaxNear, parsed.max_near, {0, 1'000'000}, true));
  if (parsed.max_near > 0 && parsed.margin == 0.0) {
    tool.refuse(names::kMaxNear, "must be 0 unless the tool has a margin above 0");
  }
}

/// How a haptic proxy may move the tool. By default, a tool with a shaft moves through a trocar,
/// and any other tool is free. A ball has no trocar.
ProxyFreedom parse_freedom(const ParameterGroup& tool, const ToolParameters& parsed) {
  const bool has_trocar = parsed.has_shaft() && !parsed.is_ball();
  const std::string fallback = has_trocar ? "trocar" : "free";
  const std::string freedom = tool.choice(names::kFreedom, fallback, {"trocar", "free"});
  if (freedom == "free") return ProxyFreedom::kFree;
  if (parsed.is_ball()) {
    tool.refuse(names::kFreedom, "must be free for a ball, whose trocar and tip are one point");
  }
  if (!has_trocar) {
    tool.refuse(names::kFreedom, "goes with a shaft; must be free without " + kShaftKeys);
  }
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
    tool.refuse_missing(names::kLinks, "a tool needs links, or " + kShaftKeys + ", or all of them");
  }
  if (has_links) {
    parse_links(tool, parsed);
  } else {
    refuse_any(tool,
               {names::kRobotDescription, names::kUrdf, names::kTfPrefix, names::kFirstJaw,
                names::kSecondJaw, names::kGraspGap},
               "goes with links, which are missing");
  }
  if (has_shaft) {
    parse_shaft(tool, parsed);
  } else {
    refuse_any(tool, {names::kTrocarOffset}, "goes with trocar_frame, which is missing");
    if (!has_tip) {
      refuse_any(tool, {names::kTipOffset}, "goes with tip_frame or tip_pose_topic");
    } else {
      parse_tip(tool, parsed.link_frame(parsed.links.front()), parsed);
    }
  }
  parse_clearance(tool, parsed);
  parsed.freedom = parse_freedom(tool, parsed);
  parsed.lockstep = tool.flag(names::kLockstep, parsed.lockstep);
  return parsed;
}

/// Lower rates are refused, except 0: ROS limits the length of a timer's period.
constexpr double kSlowest = 0.001;  // [Hz]

constexpr NumberRange kRates{0.0, 10'000.0, true, false, kSlowest};
constexpr NumberRange kFrameRates{0.0, 1000.0, true, false, kSlowest};
/// [s] At most half of the time for which TF keeps transforms. TF counts this time back from the
/// latest stamp, so one stamp far ahead of the clock would make TF forget all others.
constexpr NumberRange kMaxAhead{0.0, 5.0};
/// [faces] With more, a message would be too large: each face has three indices of four bytes.
constexpr NumberRange kMaxFaces{1, 83'333'333};
/// [bytes] roscpp refuses larger messages.
constexpr NumberRange kMessageBytes{1, 1e9};

}  // namespace

std::string ToolParameters::link_frame(const std::string& link) const {
  return tf_frame(tf_prefix.empty() ? link : tf_prefix + "/" + link);
}

const std::vector<HelpEntry>& tool_keys() {
  static const std::vector<HelpEntry> keys = {
      {names::kToolName, "every tool; required", "its name in answers, unique in the node"},
      {names::kTrocarFrame, "shaft; required", "the TF frame of the trocar"},
      {names::kTrocarOffset, "shaft; [0, 0, 0]", "[m] where the trocar is in trocar_frame"},
      {names::kTipFrame, "shaft, links; required for a shaft without tip_pose_topic",
       "the TF frame of the tip, or of a marker on the tool. With tip_pose_topic, its default is "
       "the first link's frame, and NAME_tip for a shaft. If it is trocar_frame, with the same "
       "offset, the tool is a ball"},
      {names::kTipOffset, "shaft, links; [0, 0, 0]",
       "[m] where the tip is in tip_frame, for example from the pivot calibration of a marker"},
      {names::kRadius, "shaft; required", "[m] the radius of the shaft, " + kRadii.in_words()},
      {names::kTipPoseTopic, "shaft, links; none",
       "the topic of the poses of tip_frame (geometry_msgs/PoseStamped), instead of TF"},
      {names::kBasePoseTopic, "with tip_pose_topic; none",
       "the topic of the poses of the frame in which these poses are given, instead of TF"},
      {names::kLinks, "links; required", "the names of links of the robot's URDF, each once"},
      {names::kFirstJaw, "links; none",
       "those of the links that are one of two jaws: the topic grasps tells what the jaws grasp"},
      {names::kSecondJaw, "with first_jaw; none", "those of the links that are the other jaw"},
      {names::kGraspGap, "with first_jaw; 0.002",
       "[m] jaws that have closed to it from more than twice as much, while both touch, grasp what "
       "they touch, even tissue that does not give way. 0: they grasp only tissue between them"},
      {names::kRobotDescription, "links; robot_description",
       "the parameter that has the URDF, in the node's namespace or above it"},
      {names::kUrdf, "links; none", "instead of robot_description: the URDF's file, or its URL"},
      {names::kTfPrefix, "links; none", "the TF frames of the links are PREFIX/LINK"},
      {names::kMargin, "every tool; 0",
       "[m] answers have the clearance of the tool up to this distance; 0: they have none"},
      {names::kMaxNear, "every tool; 0",
       "answers list at most so many faces that are within the margin and not touched"},
      {names::kFreedom, "every tool; trocar with a shaft that is no ball, else free",
       "how tissue can move the tool in haptic_proxy: trocar (about its trocar) or free"},
      {names::kLockstep, "every tool; false",
       "true: haptic_proxy answers each new shape of an organ once, with the tool's pose at the "
       "stamp of the shape, and not each pose. For tools that a simulator moves"}};
  return keys;
}

std::vector<ToolParameters> parse_tools(const ParameterGroup& all) {
  std::vector<ToolParameters> tools;
  std::vector<std::string> legal_keys;
  for (const HelpEntry& key : tool_keys()) legal_keys.push_back(key.name);
  for (const ParameterGroup& group :
       all.groups(names::kTools, "groups of name and links, or name, " + kShaftKeys + " [m]",
                  legal_keys)) {
    const ToolParameters tool = parse_tool(group);
    for (const ToolParameters& other : tools) {
      if (other.name == tool.name) group.refuse(names::kToolName, "must be unique among the tools");
    }
    tools.push_back(tool);
  }
  return tools;
}

ParameterTable table_of(NodeParameters& p) {
  ParameterTable t;
  t.other(
      names::kTools, "required", [&p](const ParameterGroup& all) { p.tools = parse_tools(all); },
      "list of tools, with the keys below. []: the node publishes no contacts, and answers queries "
      "that give a motion");
  t.number("rate", p.rate_hz, kRates,
           "[Hz] the node also evaluates at this rate. 0: only at each new shape, and at each pose "
           "that arrives as a message")
      .live();
  t.flag("organ_motion", p.organ_motion,
         "true: during a step, an organ moves from its previous shape to the new one. false: it "
         "rests in the new shape");
  t.number("motion_sample_sec", p.motion_sample_sec, kPositive,
           "[s] the path of a tool goes through every pose in TF, and moves as TF interpolates in "
           "between. Where a frame gets another parent in between, it is sampled at this interval");
  t.number(
      "motion_samples_max", p.motion_samples_max, {1, 100'000},
      "largest number of legs of a tool's path in a step; a leg goes from one pose to the next. "
      "The poses that change the path least are dropped first; if one is more than 1e-6 m from the "
      "path, the answer has path_incomplete. At most 1000 poses are read, or this number if it is "
      "larger; with more, it has path_incomplete, too");
  t.number("tf_timeout_sec", p.tf_timeout_sec, {0.0, 60.0},
           "[s] how long a new shape waits for its transforms; simulated time if use_sim_time is "
           "set")
      .live();
  t.number(
       "mesh_timeout_sec", p.mesh_timeout_sec, {0.0, 1e6},
       "[s] if the last shape of the organ came longer ago than this, the answer is STALE_MESH. 0: "
       "never")
      .live();
  t.number("grasp_hold_sec", p.grasp_hold_sec, {0.0, 10.0},
           "[s] tissue is let go if the jaws hold nothing for so long; at once if they open")
      .live();
  t.number("max_batch", p.max_batch, {1, 1'000'000},
           "largest number of motions in one query_batch; larger batches are refused");
  t.number("max_batch_bytes", p.max_batch_bytes, kMessageBytes,
           "largest size of the results of one query_batch, in bytes as ROS sends them; a batch "
           "that grows larger is refused");
  t.flag("publish_regions", p.publish_regions,
         "true: each contact has the polygon that its face has in the space that is picked")
      .live();
  t.flag("publish_placement", p.publish_placement,
         "true: each answer on contacts tells on which side of the organ's surface the tool is")
      .live();
  t.number("markers_depth", p.markers.markers_depth, {0.0, 10.0, false},
           "[m] contacts of this depth or more have the last colour of the map")
      .live();
  t.number("threads", p.threads, {0, 1024},
           "largest number of threads that evaluate steps side by side, at most one for each pair "
           "of organ and tool; as many again share the motions of a batch. 0: one for each "
           "processor. The answers are the same with any number");
  add_common_rows(t, p, "the threads of the steps run");
  return t;
}

void add_common_rows(ParameterTable& t, OrganNodeParameters& p, const std::string& threads) {
  std::string how = "how faces are picked";
  for (const PickerName& picker : kPickerNames) {
    how.append(". ").append(picker.name).append(": ").append(picker.about);
  }
  t.choice("picker", p.picker.kind, kPickerNames, how);
  t.choice("gl", p.picker.gl, kGlPlatformNames,
           "where the OpenGL for picking comes from. auto: OSMesa where there is one, else EGL");
  t.number(
      "max_ahead_sec", p.max_ahead_sec, kMaxAhead,
      "[s] shapes, poses and transforms whose stamps are further ahead of the node's clock are "
      "refused. Static transforms have no time");
  t.number("max_faces", p.max_faces, kMaxFaces, "larger organs are refused");
  t.number("diagnostic_period_sec", p.diagnostic_period_sec, {0.01, 3600.0},
           "[s] between messages on /diagnostics");
  t.number("markers_rate", p.markers.markers_rate_hz, kFrameRates,
           "[Hz] how often markers are published while somebody subscribes. 0: never")
      .live();
  t.number("surface_rate", p.markers.surface_rate_hz, kFrameRates,
           "[Hz] how often the surface of an organ that moves is published as a marker at most, "
           "large surfaces less often. 0: never")
      .live();
  t.number(
      kRealtimePriority, p.realtime.priority, {0, 99},
      "1 to 99: " + threads +
          " under SCHED_FIFO with this priority, before ordinary programs. 0: ordinary scheduling");
  t.flag("lock_memory", p.realtime.lock_memory, "true: all memory of the process stays in RAM");
  t.refuse("awake_cores",
           "is gone; no core sleeps while a program of yours holds /dev/cpu_dma_latency open");
}

}  // namespace organ_collision
