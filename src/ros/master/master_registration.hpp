#pragma once

#include <xmlrpcpp/XmlRpcValue.h>

#include <map>
#include <optional>
#include <string>

#include "master_record.hpp"

namespace organ_collision {

/// Keeps this process registered at the ROS master. A master that was started again knows nothing
/// of the nodes that were there before, and roscpp does not tell it. Each check compares what the
/// master lists with the topics and services of this process, and registers what is missing.
class MasterRegistration {
 public:
  enum class Outcome { kNothingToDo, kRegisteredAgain, kNoAnswer };

  /// `parameters`: the namespace of the parameters that are restored, too.
  explicit MasterRegistration(std::string parameters) : parameters_(std::move(parameters)) {}

  /// Calls the master and this node's own XML-RPC server, and waits for both. Registers what was
  /// missing at the last check, too: what is missing once may just be on its way. Does nothing if
  /// the master knows another node of this name, which has replaced this one.
  Outcome check();

 private:
  /// What the master does not list of this process.
  struct Missing {
    Names published, subscribed, services;
    bool empty() const { return published.empty() && subscribed.empty() && services.empty(); }
  };

  Missing find_missing(const MasterRecord& master) const;
  void remember(const MasterRecord& master);
  void remember_publishers(const std::string& topic, const MasterRecord& master);
  void restore(const Missing& missing, const MasterRecord& master);
  void restore_parameters() const;
  void introduce_publishers(const std::string& topic, const std::string& type, const Links& links,
                            const MasterRecord& master) const;

  std::string parameters_;
  Missing missing_;                      ///< at the last check
  XmlRpc::XmlRpcValue last_parameters_;  ///< invalid: there were none
  Names services_;                       ///< of this process, that the master has ever listed
  /// The publisher that has this XML-RPC address (name and URI).
  struct Publisher {
    std::string name, uri;
  };
  std::map<std::string, Publisher> publishers_;
};

}  // namespace organ_collision
