// Parameters of all nodes: any tree of values, as the parameter server may hold it.
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "contact_adapter/contact_adapter_parameters.hpp"
#include "contact_adapter/contact_answer.hpp"
#include "fuzz_input.hpp"
#include "haptic_proxy/haptic_proxy_parameters.hpp"
#include "mesh_adapter/mesh_adapter_parameters.hpp"
#include "ros/messages/text.hpp"
#include "ros/parameters/node_parameters.hpp"

using namespace organ_collision;
using XmlRpc::XmlRpcValue;

namespace {

/// The names of the parameters of all nodes, the keys of tools and organs, and texts that are no
/// names.
std::vector<std::string> known_names() {
  // make_corpus.py knows the numbers of the first ones.
  std::istringstream first(
      "tools organs rate organ_motion stiffness max_force name trocar_frame tip_frame radius links "
      "urdf topic tip_pose_topic base_pose_topic robot_description tf_prefix margin max_near "
      "freedom vertices_topic not_a_name / ~");
  std::vector<std::string> names{std::istream_iterator<std::string>(first), {}};
  names.emplace_back();
  for (const auto& help :
       {parameter_help<NodeParameters>(), parameter_help<HapticProxyParameters>(),
        parameter_help<ContactAdapterParameters>(), parameter_help<MeshAdapterParameters>()}) {
    for (const HelpEntry& entry : help) names.push_back(entry.name);
  }
  return names;
}

const std::vector<std::string> kNames = known_names();
constexpr int kDeepest = 6;

XmlRpcValue value(FuzzInput& input, int depth);

std::string text(FuzzInput& input) {
  const std::uint8_t size = input.byte();
  // Half of all texts are names, so that some are legal.
  return size % 2 == 0 ? kNames[size / 2 % kNames.size()] : input.text(size / 8);
}

XmlRpcValue list(FuzzInput& input, int depth) {
  XmlRpcValue list;
  const int size = input.byte() % 8;
  list.setSize(size);
  for (int i = 0; i < size; ++i) list[i] = value(input, depth + 1);
  return list;
}

XmlRpcValue group(FuzzInput& input, int depth) {
  XmlRpcValue group;
  group.begin();  // Makes it a group, even if it is empty.
  for (int left = input.byte() % 16; left > 0; --left) {
    const std::string name = kNames[input.byte() % kNames.size()];
    group[name] = value(input, depth + 1);
  }
  return group;
}

XmlRpcValue value(FuzzInput& input, int depth) {
  switch (input.byte() % (depth < kDeepest ? 8 : 5)) {
    case 0:
      return input.byte() % 2 == 1;
    case 1:
      return input.number<std::int32_t>();
    case 2:
      return input.number<double>();
    case 3:
      return XmlRpcValue(text(input));
    case 4:
      return static_cast<int>(input.byte());
    case 5:
      return list(input, depth);
    case 6:
      return group(input, depth);
    default:
      return {};
  }
}

/// Loads them. A refusal says what is wrong.
template <typename Load>
void load(const Load& load) {
  try {
    load();
  } catch (const ParameterError& error) {
    demand(*error.what() != '\0', "a refusal has a text");
  }
}

void check(const NodeParameters& parameters) {
  demand(parameters.max_faces > 0 && parameters.motion_samples_max > 0, "limits are positive");
  for (const ToolParameters& tool : parameters.tools) {
    demand(!tool.name.empty() && (tool.has_shaft() || !tool.links.empty()), "tools are whole");
    demand(!tool.has_shaft() || tool.radius > 0.0, "radii are positive");
  }
}

}  // namespace

static const FuzzTarget target("parameters", [](const std::uint8_t* data, std::size_t size) {
  FuzzInput input(data, size);
  const XmlRpcValue all = group(input, 0);
  load([&] {
    const NodeParameters parameters = parse_parameters<NodeParameters>(all);
    check(parameters);
    changed(parameters, all);
  });
  load([&] {
    const HapticProxyParameters parameters = parse_parameters<HapticProxyParameters>(all);
    for (const ToolParameters& tool : parameters.tools) proxy_settings(parameters, tool);
    changed(parameters, all);
  });
  load([&] {
    const ContactAdapterParameters parameters = parse_parameters<ContactAdapterParameters>(all);
    demand(parameters.max_force > 0.0, "the largest force is positive");
    changed(parameters, all);
  });
  load([&] { parse_parameters<MeshAdapterParameters>(all); });
  if (all.hasMember("tools")) shaft_radius(all["tools"], "name");
});
