#pragma once

#include <diagnostic_updater/diagnostic_updater.h>

#include <string>
#include <vector>

#include "node_counters.hpp"
#include "ros/motion/transform_buffer.hpp"
#include "ros/queries/service_statistics.hpp"
#include "ros/steps/step_scheduler.hpp"

namespace organ_collision {

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
