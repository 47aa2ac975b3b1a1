#pragma once

#include <diagnostic_updater/diagnostic_updater.h>

#include <string>
#include <vector>

#include "node_counters.hpp"
#include "ros/interface/failure_log.hpp"
#include "ros/motion/transform_buffer.hpp"
#include "ros/organs/organ_registry.hpp"
#include "ros/parameters/node_parameters.hpp"
#include "ros/steps/contact_query.hpp"
#include "ros/steps/step_scheduler.hpp"
#include "ros/tools/tool.hpp"

namespace organ_collision {

/// The node's tasks for /diagnostics.
class Diagnostics {
 public:
  /// All must outlive this.
  struct Sources {
    const NodeParameters& parameters;
    const std::vector<Tool>& tools;
    const std::vector<std::string>& misspelt;
    const OrganRegistry& organs;
    const ContactQuery& contact_query;
    const StepScheduler& steps;
    const TransformBuffer& transforms;
    NodeCounters& counters;
  };

  explicit Diagnostics(const Sources& sources) : sources_(sources) {}
  void add_to(diagnostic_updater::Updater& updater);

  void queries(diagnostic_updater::DiagnosticStatusWrapper& status);
  void tools(diagnostic_updater::DiagnosticStatusWrapper& status);
  void organs(diagnostic_updater::DiagnosticStatusWrapper& status);
  void messages(diagnostic_updater::DiagnosticStatusWrapper& status);

 private:
  Sources sources_;
};

}  // namespace organ_collision
