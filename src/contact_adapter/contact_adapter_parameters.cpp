#include "contact_adapter_parameters.hpp"

#include <limits>
#include <optional>

#include "organ_collision/ros/names.hpp"
#include "ros/interface/parameter_group.hpp"

namespace organ_collision {
namespace {

constexpr char kStiffness[] = "stiffness";
constexpr char kMaxForce[] = "max_force";
const NumberRange kPositive{0.0, std::numeric_limits<double>::infinity(), false};
/// [s] ROS timers do not accept much longer periods.
const NumberRange kPeriod{0.0, 1e6, false};

}  // namespace

ContactAdapterParameters parse_contact_adapter_parameters(const XmlRpc::XmlRpcValue& all) {
  const ParameterGroup group("~", all, {kStiffness, kMaxForce, names::kDiagnosticPeriod});
  ContactAdapterParameters p;
  p.misspelt = group.misspelt();
  p.stiffness = group.number(kStiffness, p.stiffness, kPositive);
  if (group.has(kMaxForce)) p.max_force = group.number(kMaxForce, std::nullopt, kPositive);
  p.diagnostic_period_sec =
      group.number(names::kDiagnosticPeriod, p.diagnostic_period_sec, kPeriod);
  return p;
}

ContactAdapterParameters load_contact_adapter_parameters(const ros::NodeHandle& private_node) {
  return parse_contact_adapter_parameters(all_parameters(private_node));
}

}  // namespace organ_collision
