#include "contact_adapter_parameters.hpp"

#include <limits>

#include "contact_adapter_help.hpp"
#include "contact_adapter_names.hpp"
#include "organ_collision/ros/names.hpp"
#include "ros/interface/parameter_group.hpp"

namespace organ_collision {
namespace {

constexpr double kUnlimited = std::numeric_limits<double>::infinity();
constexpr NumberRange kStiffnessRange{0.0, kUnlimited, false};
constexpr NumberRange kMaxForceRange{0.0, kUnlimited, false, true};

/// Missing members keep their values.
void parse_live(const ParameterGroup& group, LiveContactAdapterParameters& p) {
  p.stiffness = group.number(names::kStiffness, p.stiffness, kStiffnessRange);
  p.max_force = group.number(names::kMaxForce, p.max_force, kMaxForceRange);
}

}  // namespace

ContactAdapterParameters parse_contact_adapter_parameters(const XmlRpc::XmlRpcValue& all) {
  const ParameterGroup group(
      "~", all, {names::kStiffness, names::kMaxForce, names::kWayOut, names::kDiagnosticPeriod});
  ContactAdapterParameters p;
  p.misspelt = group.misspelt();
  parse_live(group, p);
  p.way_out = group.flag(names::kWayOut, p.way_out);
  p.diagnostic_period_sec =
      group.number(names::kDiagnosticPeriod, p.diagnostic_period_sec, kTimerPeriod);
  return p;
}

ContactAdapterParameters load_contact_adapter_parameters(const ros::NodeHandle& private_node) {
  return parse_contact_adapter_parameters(all_parameters(private_node));
}

std::vector<LiveParameter> live_parameters(const LiveContactAdapterParameters& p) {
  const std::vector<HelpEntry> help = contact_adapter_help().parameters;
  const LiveContactAdapterParameters defaults;
  return {{names::kStiffness, text_of(help, names::kStiffness), p.stiffness, defaults.stiffness,
           kStiffnessRange},
          {names::kMaxForce, text_of(help, names::kMaxForce), p.max_force, defaults.max_force,
           kMaxForceRange}};
}

LiveContactAdapterParameters changed(const LiveContactAdapterParameters& parameters,
                                     const XmlRpc::XmlRpcValue& changes) {
  LiveContactAdapterParameters result = parameters;
  parse_live(live_group(changes, live_parameters(parameters)), result);
  return result;
}

}  // namespace organ_collision
