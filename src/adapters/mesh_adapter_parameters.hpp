#pragma once

#include <ros/names.h>

#include <set>
#include <string>
#include <vector>

#include "common/parameters/parameter_table.hpp"

/// The keys of an entry of the parameter `organs` that error messages and --help name.
namespace organ_collision::names {

inline constexpr char kOrganName[] = "name";
inline constexpr char kFrame[] = "frame";
inline constexpr char kTopic[] = "topic";
inline constexpr char kVerticesTopic[] = "vertices_topic";
inline constexpr char kScale[] = "scale";

}  // namespace organ_collision::names

namespace organ_collision {

/// Where one organ's surface comes from.
struct OrganParameters {
  std::string name;
  std::string topic;
  std::string frame;           ///< empty: the frame that the messages name
  std::string vertices_topic;  ///< empty: none
  double scale = 1.0;          ///< [m] length of the sender's unit
};

/// The parameters of organ_mesh_adapter, with the documented defaults.
struct MeshAdapterParameters {
  std::vector<OrganParameters> organs;
  std::string collision_node = "organ_collision";
  double diagnostic_period_sec = 1.0;  ///< in wall time
  std::vector<std::string> misspelt;   ///< a sentence for each unknown name
};

/// A legal ROS name of a topic or node. A private name is refused, because it would be in this
/// adapter's namespace.
inline std::string graph_name(const ParameterGroup& group, const char* name) {
  std::string text = group.text(name);
  std::string error;
  if (text.front() == '~' || !ros::names::validate(text, error)) {
    group.refuse(name, "must be a name of the ROS graph that is not private" +
                           (error.empty() ? error : ": " + error));
  }
  return text;
}

inline void parse_organs(const ParameterGroup& all, MeshAdapterParameters& parameters) {
  std::set<std::string> organs, topics;
  for (const ParameterGroup& group : all.groups(
           "organs", "groups of name, topic and, if needed, frame, vertices_topic and scale",
           {names::kOrganName, names::kTopic, names::kFrame, names::kVerticesTopic, names::kScale},
           parameters.misspelt)) {
    OrganParameters organ;
    organ.name = group.text(names::kOrganName);
    group.check_name(names::kOrganName, organ.name);
    organ.topic = graph_name(group, names::kTopic);
    if (group.has(names::kFrame)) organ.frame = group.frame(names::kFrame);
    if (group.has(names::kVerticesTopic)) {
      organ.vertices_topic = graph_name(group, names::kVerticesTopic);
    }
    organ.scale = group.number(names::kScale, organ.scale, kPositive);
    if (!organs.insert(organ.name).second) {
      group.refuse(names::kOrganName, "must be unique among the organs");
    }
    if (!topics.insert(organ.topic).second) {
      group.refuse(names::kTopic, "must be unique among all topics of the organs");
    }
    if (!organ.vertices_topic.empty() && !topics.insert(organ.vertices_topic).second) {
      group.refuse(names::kVerticesTopic, "must be unique among all topics of the organs");
    }
    parameters.organs.push_back(organ);
  }
}

inline ParameterTable table_of(MeshAdapterParameters& p) {
  ParameterTable t;
  t.other(
      "organs", "required", [&p](const ParameterGroup& all) { parse_organs(all, p); },
      "list of organs. Each has name and topic and, if needed, vertices_topic; frame, which "
      "replaces the frame that the messages name; and scale, the sender's unit in metres");
  t.other(
      "collision_node", p.collision_node,
      [&p](const ParameterGroup& all) {
        if (all.has("collision_node")) p.collision_node = graph_name(all, "collision_node");
      },
      "name of the collision node, which gets the organs; resolved in the adapter's namespace");
  t.number("diagnostic_period_sec", p.diagnostic_period_sec, kTimerPeriod,
           "[s] between messages on /diagnostics");
  return t;
}

}  // namespace organ_collision
