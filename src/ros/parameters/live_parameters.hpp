#pragma once

#include <dynamic_reconfigure/Reconfigure.h>
#include <ros/node_handle.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <functional>
#include <string>
#include <vector>

#include "parameter_group.hpp"

namespace organ_collision {

/// A number or a flag that can be changed while the program runs.
struct LiveParameter {
  std::string name;
  std::string text;              ///< what it means, for people
  XmlRpc::XmlRpcValue value;     ///< a double or a bool
  XmlRpc::XmlRpcValue fallback;  ///< its default, of the same type
  NumberRange range = {};        ///< of a number; shown to people, not checked here
};

/// The changes as a group, for parsing. Throws ParameterError if one is of no live parameter.
ParameterGroup live_group(const XmlRpc::XmlRpcValue& changes,
                          const std::vector<LiveParameter>& parameters);

/// The interface of dynamic_reconfigure, for dynparam and rqt_reconfigure. All its work is done in
/// the thread that calls the callbacks of the node handle.
///
/// This is not dynamic_reconfigure::Server, which clamps illegal values without a word, wants the
/// limits in a file of its own, and writes all values to the parameter server at each change and at
/// the start.
class LiveParameters {
 public:
  /// Applies changes: a group of new values by name. Throws ParameterError if one is illegal. Then
  /// nothing has changed.
  using Apply = std::function<void(const XmlRpc::XmlRpcValue& changes)>;

  LiveParameters(const ros::NodeHandle& private_node, std::vector<LiveParameter> parameters,
                 Apply apply);

  /// Publishes the parameters, and serves changes. From now on, `apply` may be called at any time.
  void advertise();

  /// Applies the changes that a request asks for, and logs them. A value that differs from the
  /// present one goes to the parameter server, too. If a value is illegal, nothing changes, and the
  /// log says what is legal. Returns the values that hold then.
  dynamic_reconfigure::Config set(const dynamic_reconfigure::Config& request);

 private:
  bool on_set(dynamic_reconfigure::Reconfigure::Request& request,
              dynamic_reconfigure::Reconfigure::Response& response);
  void take(LiveParameter& parameter, const XmlRpc::XmlRpcValue& value);

  ros::NodeHandle private_node_;
  std::vector<LiveParameter> parameters_;
  Apply apply_;
  ros::Publisher descriptions_;
  ros::Publisher updates_;
  ros::ServiceServer server_;
};

}  // namespace organ_collision
