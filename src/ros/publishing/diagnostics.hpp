#pragma once

#include <diagnostic_updater/diagnostic_updater.h>

#include <string>
#include <vector>

#include "counters.hpp"
#include "ros/motion/transform_buffer.hpp"
#include "ros/organs/organ_intake.hpp"
#include "ros/organs/organ_registry.hpp"
#include "ros/steps/step_scheduler.hpp"
#include "ros/tools/tool.hpp"

namespace organ_collision {

// The parts of /diagnostics that the nodes share.

/// What a node has received. All must outlive the updater.
struct ReceivedParts {
  const double& mesh_timeout_sec;  ///< 0: a mesh is never stale
  const std::vector<Tool>& tools;
  const OrganRegistry& organs;
  const OrganIntake& intake;
  EventRate& meshes;     ///< accepted shapes of organs
  FailureLog& rejected;  ///< messages that were refused
};

/// What the collision node has answered. All must outlive the updater.
struct AnsweredParts {
  const std::vector<std::string>& misspelt;
  const std::string& gl_version;
  const StepScheduler& steps;
  const TransformBuffer& transforms;
  NodeCounters& counters;
};

/// Adds "tools", "organs" and "messages".
void add_diagnostics(diagnostic_updater::Updater& updater, const ReceivedParts& parts);
/// Adds "queries".
void add_diagnostics(diagnostic_updater::Updater& updater, const AnsweredParts& parts);

void show_tools(const ReceivedParts& parts, diagnostic_updater::DiagnosticStatusWrapper& status);
void show_organs(const ReceivedParts& parts, diagnostic_updater::DiagnosticStatusWrapper& status);
void show_messages(const ReceivedParts& parts, diagnostic_updater::DiagnosticStatusWrapper& status);
void show_queries(const AnsweredParts& parts, diagnostic_updater::DiagnosticStatusWrapper& status);

}  // namespace organ_collision
