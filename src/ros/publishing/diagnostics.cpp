#include "diagnostics.hpp"

#include "ros/interface/plain_text.hpp"
#include "ros/interface/plausible_size.hpp"
#include "ros/organs/organ_report.hpp"
#include "ros/steps/contact_array.hpp"

namespace organ_collision {
namespace {

using diagnostic_msgs::DiagnosticStatus;
using diagnostic_updater::DiagnosticStatusWrapper;

constexpr double kMicroseconds = 1e6;

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

void Diagnostics::add_to(diagnostic_updater::Updater& updater) {
  updater.setHardwareID("none");
  updater.add("queries", this, &Diagnostics::queries);
  updater.add("tools", this, &Diagnostics::tools);
  updater.add("organs", this, &Diagnostics::organs);
  updater.add("messages", this, &Diagnostics::messages);
}

void Diagnostics::queries(DiagnosticStatusWrapper& status) {
  status.summary(DiagnosticStatus::OK, "answering");
  const auto times = sources_.contact_query.query_times().summary();
  status.add("GL version", sources_.contact_query.gl_version());
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
  status.add("shapes superseded by newer ones", sources_.steps.shapes_superseded());
  status.add("steps while TF was starting", sources_.counters.starting);
  for (const std::string& sentence : sources_.misspelt) {
    status.mergeSummary(DiagnosticStatus::WARN, sentence);
  }
  show_failures("unanswered", sources_.counters.failed, status);
  show_failures("refused", sources_.counters.refused, status);
}

void Diagnostics::tools(DiagnosticStatusWrapper& status) {
  status.summary(DiagnosticStatus::OK, counted(sources_.tools.size(), "tool"));
  if (sources_.tools.empty()) status.summary(DiagnosticStatus::WARN, kNoTools);
  for (const Tool& tool : sources_.tools) show_tool(tool, status);
}

void Diagnostics::organs(DiagnosticStatusWrapper& status) {
  const ros::Time now = ros::Time::now();
  const double timeout = sources_.parameters.mesh_timeout_sec;
  status.summary(DiagnosticStatus::OK, counted(sources_.organs.organs().size(), "organ"));
  for (const auto& [name, organ] : sources_.organs.organs()) {
    const OrganShape& shape = organ.latest();
    status.add(name + ", age of mesh [s]", shape.age(now));
    show_organ(organ, sources_.organs.last_refusal(name), status);
    if (is_stale(shape, now, timeout)) {
      status.mergeSummary(DiagnosticStatus::WARN, stale_message(organ, now, timeout));
    }
  }
}

void Diagnostics::messages(DiagnosticStatusWrapper& status) {
  status.summary(DiagnosticStatus::OK, "none rejected");
  status.add("mesh rate [1/s]", sources_.counters.meshes.take(std::chrono::steady_clock::now()));
  show_failures("rejected", sources_.counters.rejected, status);
}

}  // namespace organ_collision
