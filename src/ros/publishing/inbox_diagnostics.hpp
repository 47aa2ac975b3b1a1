#pragma once

#include <diagnostic_updater/diagnostic_updater.h>

#include <vector>

#include "event_rate.hpp"
#include "ros/interface/failure_log.hpp"
#include "ros/organs/organ_registry.hpp"
#include "ros/organs/organ_topics.hpp"
#include "ros/tools/tool.hpp"

namespace organ_collision {

/// The tasks of /diagnostics about a node's tools, organs and received messages.
class InboxDiagnostics {
 public:
  /// All must outlive this.
  struct Sources {
    const double& mesh_timeout_sec;  ///< 0: a mesh is never stale
    const std::vector<Tool>& tools;
    const OrganRegistry& organs;
    const OrganTopics& topics;
    EventRate& meshes;     ///< accepted shapes of organs
    FailureLog& rejected;  ///< messages that were refused
  };

  explicit InboxDiagnostics(const Sources& sources) : sources_(sources) {}
  void add_to(diagnostic_updater::Updater& updater);

  void tools(diagnostic_updater::DiagnosticStatusWrapper& status);
  void organs(diagnostic_updater::DiagnosticStatusWrapper& status);
  void messages(diagnostic_updater::DiagnosticStatusWrapper& status);

 private:
  Sources sources_;
};

}  // namespace organ_collision
