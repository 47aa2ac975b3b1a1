#pragma once

#include <diagnostic_updater/diagnostic_updater.h>

#include <string>
#include <vector>

#include "counters.hpp"
#include "ros/messages/failure_log.hpp"
#include "ros/motion/transform_buffer.hpp"
#include "ros/organs/organ_intake.hpp"
#include "ros/organs/organ_registry.hpp"
#include "ros/steps/step_scheduler.hpp"
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

/// The task of /diagnostics about the collision node's steps and services.
class QueryDiagnostics {
 public:
  /// All must outlive this.
  struct Sources {
    const std::vector<std::string>& misspelt;
    const std::string& gl_version;
    const StepScheduler& steps;
    const TransformBuffer& transforms;
    const ServiceStatistics& services;
    NodeCounters& counters;
  };

  explicit QueryDiagnostics(const Sources& sources) : sources_(sources) {}
  void add_to(diagnostic_updater::Updater& updater);

  void queries(diagnostic_updater::DiagnosticStatusWrapper& status);

 private:
  void add_shapes(diagnostic_updater::DiagnosticStatusWrapper& status) const;
  void add_services(diagnostic_updater::DiagnosticStatusWrapper& status) const;

  Sources sources_;
};

}  // namespace organ_collision
