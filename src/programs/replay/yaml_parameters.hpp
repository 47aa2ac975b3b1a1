#pragma once

#include <xmlrpcpp/XmlRpcValue.h>

#include <string>

#include "node/parameters/node_parameters.hpp"

namespace organ_collision {

/// The parameters of a yaml file, as the parameter server would hold them after `rosparam load`.
class YamlParameters {
 public:
  /// Reads a file with the parameters of the node, or with the whole tree of parameters, in which
  /// the node has its full name, `node`. Throws InputError.
  YamlParameters(const std::string& file, const std::string& node);

  /// The parameters of the node, as they stand in the file.
  const XmlRpc::XmlRpcValue& group() const;
  /// Throws ParameterError.
  NodeParameters node_parameters() const;
  /// The value of a text parameter, for example robot_description. It is searched in the node's
  /// namespace and upwards from there. Throws ToolError.
  std::string find_text(const std::string& parameter) const;

 private:
  std::string file_;
  XmlRpc::XmlRpcValue tree_;
  std::string node_ = "/";  ///< the node's name in the tree; "/": the whole tree is the node's
};

}  // namespace organ_collision
