#include "query_diagnostics.hpp"

namespace organ_collision {
namespace {

using diagnostic_msgs::DiagnosticStatus;
using diagnostic_updater::DiagnosticStatusWrapper;

constexpr double kMicroseconds = 1e6;

}  // namespace

void QueryDiagnostics::add_to(diagnostic_updater::Updater& updater) {
  updater.add("queries", this, &QueryDiagnostics::queries);
}

void QueryDiagnostics::queries(DiagnosticStatusWrapper& status) {
  status.summary(DiagnosticStatus::OK, "answering");
  const auto times = sources_.steps.query_times().summary();
  status.add("GL version", sources_.gl_version);
  status.add("contacts rate [1/s]",
             sources_.counters.contacts.take(std::chrono::steady_clock::now()));
  status.add("queries", times.count);
  status.add("query time, median [us]", times.median * kMicroseconds);
  status.add("query time, 99th percentile [us]", times.percentile_99 * kMicroseconds);
  status.add("query time, worst [us]", times.worst * kMicroseconds);
  status.add("motion samples cut", sources_.steps.samples_cut());
  status.add("motion samples cut, farthest from the swept way [m]", sources_.steps.deviation_cut());
  status.add("transforms after their step", sources_.transforms.late());
  status.add("poses merged into later ones", sources_.steps.poses_merged());
  add_shapes(status);
  status.add("answers published", sources_.counters.published);
  status.add("steps while TF was starting", sources_.counters.starting);
  add_services(status);
  for (const std::string& sentence : sources_.misspelt) {
    status.mergeSummary(DiagnosticStatus::WARN, sentence);
  }
  show_failures("unanswered", sources_.counters.failed, status);
  show_failures("answered in part", sources_.counters.incomplete, status);
  show_failures("refused", sources_.counters.refused, status);
}

void QueryDiagnostics::add_shapes(DiagnosticStatusWrapper& status) const {
  const ShapeCounts shapes = sources_.steps.shapes();
  status.add("shapes due", shapes.due);
  status.add("shapes answered", shapes.answered);
  status.add("shapes superseded by newer ones", shapes.superseded);
  status.add("shapes forgotten before their step", shapes.forgotten);
  status.add("shapes waiting", shapes.waiting);
}

void QueryDiagnostics::add_services(DiagnosticStatusWrapper& status) const {
  const ServiceStatistics::Summary times = sources_.services.summary();
  status.add("service queries", times.queries.count);
  status.add("service query time, median [us]", times.queries.median * kMicroseconds);
  status.add("service query time, 99th percentile [us]",
             times.queries.percentile_99 * kMicroseconds);
  status.add("service query time, worst [us]", times.queries.worst * kMicroseconds);
  status.add("batches", times.batches);
  status.add("motions of batches", times.motions);
}

}  // namespace organ_collision
