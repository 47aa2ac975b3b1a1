#include "diagnostics.hpp"

#include <chrono>

#include "ros/messages/conversions.hpp"
#include "ros/messages/text.hpp"
#include "ros/organs/organ_report.hpp"
#include "ros/steps/contact_array.hpp"

namespace organ_collision {
namespace {

using diagnostic_msgs::DiagnosticStatus;
using diagnostic_updater::DiagnosticStatusWrapper;

void show_tool(const Tool& tool, DiagnosticStatusWrapper& status) {
  const ToolParameters& parameters = tool.parameters;
  if (parameters.has_shaft()) {
    status.add(parameters.name + ", radius of the shaft [m]", parameters.radius);
    const std::string doubt = doubt_about_radius(parameters.name, parameters.radius);
    if (!doubt.empty()) status.mergeSummary(DiagnosticStatus::WARN, doubt);
  }
  if (!parameters.links.empty()) status.add(parameters.name + ", links", tool.links.size());
  if (!tool.fault.empty()) status.mergeSummary(DiagnosticStatus::ERROR, tool.fault);
}

void show_organ(const DeformableOrgan& organ, const std::string& last_refusal,
                DiagnosticStatusWrapper& status) {
  const TriangleMesh& mesh = *organ.latest().mesh;
  status.add(organ.name() + ", faces", mesh.face_count());
  status.add(organ.name() + ", extent [m]", sides_of(mesh.box().cast<double>()));
  status.add(organ.name() + ", surface", closedness(*organ.surface()));
  status.add(organ.name() + ", orientation", orientation(*organ.surface()));
  if (!last_refusal.empty()) status.add(organ.name() + ", newer mesh refused", last_refusal);
  for (const std::string& doubt : doubts(organ)) status.mergeSummary(DiagnosticStatus::WARN, doubt);
}

}  // namespace

void InboxDiagnostics::add_to(diagnostic_updater::Updater& updater) {
  updater.add("tools", this, &InboxDiagnostics::tools);
  updater.add("organs", this, &InboxDiagnostics::organs);
  updater.add("messages", this, &InboxDiagnostics::messages);
}

void InboxDiagnostics::tools(DiagnosticStatusWrapper& status) {
  status.summary(DiagnosticStatus::OK, counted(sources_.tools.size(), "tool"));
  if (sources_.tools.empty()) status.summary(DiagnosticStatus::WARN, kNoTools);
  for (const Tool& tool : sources_.tools) show_tool(tool, status);
}

void InboxDiagnostics::organs(DiagnosticStatusWrapper& status) {
  const ros::Time now = ros::Time::now();
  const double timeout = sources_.mesh_timeout_sec;
  status.summary(DiagnosticStatus::OK, counted(sources_.organs.organs().size(), "organ"));
  for (const auto& [name, organ] : sources_.organs.organs()) {
    const OrganShape& shape = organ.latest();
    status.add(name + ", age of mesh [s]", shape.age(now));
    show_organ(organ, sources_.organs.last_refusal(name), status);
    if (is_stale(shape, now, timeout)) {
      status.mergeSummary(DiagnosticStatus::WARN, stale_message(name, shape, now, timeout));
    }
  }
}

void InboxDiagnostics::messages(DiagnosticStatusWrapper& status) {
  status.summary(DiagnosticStatus::OK, "none rejected");
  status.add("mesh rate [1/s]", sources_.meshes.take(std::chrono::steady_clock::now()));
  const OrganMessageCounts counts = sources_.topics.counts();
  status.add("organ messages received", counts.received);
  status.add("organ messages applied", counts.applied);
  status.add("organ messages refused", counts.refused);
  status.add("organ messages that remove", counts.removals);
  status.add("organ messages dropped behind a large mesh", counts.dropped);
  status.add("organ messages waiting", counts.waiting);
  status.add("organ messages lost before they came", counts.lost);
  show_failures("rejected", sources_.rejected, status);
}

namespace {

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
