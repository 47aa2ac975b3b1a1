#include "mesh_adapter_parameters.hpp"

#include <ros/names.h>

#include <set>

namespace organ_collision {
namespace {

using XmlRpc::XmlRpcValue;

constexpr char kName[] = "name";
constexpr char kFrame[] = "frame";

/// A legal ROS name of a topic or node. A private name is refused, because it would be in this
/// adapter's namespace.
std::string graph_name(const ParameterGroup& group, const char* name) {
  std::string text = group.text(name);
  std::string error;
  if (text.front() == '~' || !ros::names::validate(text, error)) {
    group.refuse(name, "must be a name of the ROS graph that is not private" +
                           (error.empty() ? error : ": " + error));
  }
  return text;
}

OrganParameters parse_organ(const ParameterGroup& group) {
  OrganParameters organ;
  organ.name = group.text(kName);
  group.check_name(kName, organ.name);
  organ.topic = graph_name(group, names::kTopic);
  if (group.has(kFrame)) organ.frame = group.frame(kFrame);
  if (group.has(names::kVerticesTopic)) {
    organ.vertices_topic = graph_name(group, names::kVerticesTopic);
  }
  return organ;
}

void parse_organs(const ParameterGroup& all, MeshAdapterParameters& parameters) {
  const XmlRpcValue& list =
      all.list("organs", "groups of name, topic and, if needed, frame and vertices_topic");
  std::set<std::string> organs, topics;
  for (int i = 0; i < list.size(); ++i) {
    const ParameterGroup group("~organs[" + std::to_string(i) + "]", list[i],
                               {kName, names::kTopic, kFrame, names::kVerticesTopic});
    const OrganParameters organ = parse_organ(group);
    if (!organs.insert(organ.name).second) {
      group.refuse(kName, "must be unique among the organs");
    }
    if (!topics.insert(organ.topic).second) {
      group.refuse(names::kTopic, "must be unique among all topics of the organs");
    }
    if (!organ.vertices_topic.empty() && !topics.insert(organ.vertices_topic).second) {
      group.refuse(names::kVerticesTopic, "must be unique among all topics of the organs");
    }
    parameters.organs.push_back(organ);
    for (const std::string& sentence : group.misspelt()) parameters.misspelt.push_back(sentence);
  }
}

}  // namespace

ParameterTable table_of(MeshAdapterParameters& p) {
  ParameterTable t;
  t.other(
      "organs", "required", [&p](const ParameterGroup& all) { parse_organs(all, p); },
      "list of organs. Each has name and topic and, if needed, frame and vertices_topic");
  t.other(
      "collision_node", p.collision_node,
      [&p](const ParameterGroup& all) {
        if (all.has("collision_node")) p.collision_node = graph_name(all, "collision_node");
      },
      "the collision node, which gets the organs");
  t.number("diagnostic_period", p.diagnostic_period_sec, kTimerPeriod,
           "[s] between messages on /diagnostics");
  return t;
}

}  // namespace organ_collision
