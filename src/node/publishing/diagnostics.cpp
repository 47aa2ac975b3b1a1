#include "diagnostics.hpp"

#include <diagnostic_updater/diagnostic_updater.h>

#include <algorithm>

#include "common/messages/text.hpp"
#include "node/organs/deformable_organ.hpp"
#include "node/steps/contact_array.hpp"

namespace organ_collision {
namespace {

using diagnostic_msgs::DiagnosticStatus;

void show_tool(const Tool& tool, Status& status) {
  const ToolParameters& parameters = tool.parameters;
  if (parameters.has_shaft()) {
    status.add(parameters.name + ", radius of the shaft [m]", parameters.radius);
  }
  if (!parameters.links.empty()) status.add(parameters.name + ", links", tool.links.size());
  for (const std::string& doubt : doubts(tool)) status.mergeSummary(DiagnosticStatus::WARN, doubt);
  if (!tool.fault.empty()) status.mergeSummary(DiagnosticStatus::ERROR, tool.fault);
}

void show_organ(const DeformableOrgan& organ, const std::string& last_refusal, Status& status) {
  const TriangleMesh& mesh = *organ.latest().mesh;
  status.add(organ.name() + ", faces", mesh.face_count());
  status.add(organ.name() + ", extent [m]", sides_of(mesh.box().cast<double>()));
  status.add(organ.name() + ", surface", closedness(*organ.surface()));
  status.add(organ.name() + ", orientation", orientation(*organ.surface()));
  if (!last_refusal.empty()) status.add(organ.name() + ", newer mesh refused", last_refusal);
  for (const std::string& doubt :
       doubts(organ.name(), mesh.box().cast<double>(), *organ.surface())) {
    status.mergeSummary(DiagnosticStatus::WARN, doubt);
  }
}

}  // namespace

double EventRate::take(Time now) {
  const double seconds = std::chrono::duration<double>(now - since_).count();
  const double rate = seconds > 0.0 ? static_cast<double>(count_) / seconds : 0.0;
  since_ = now;
  count_ = 0;
  return rate;
}

void DurationStatistics::add(double seconds) {
  const std::lock_guard<std::mutex> lock(mutex_);
  seconds_[count_++ % kCapacity] = seconds;
}

DurationStatistics::Summary DurationStatistics::summary() const {
  std::unique_lock<std::mutex> lock(mutex_);
  const std::size_t count = count_, kept = std::min(count, kCapacity);
  std::vector<double> times(seconds_.begin(), seconds_.begin() + kept);
  lock.unlock();
  if (times.empty()) return {};
  const auto percentile = [&](std::size_t percent) {
    const auto place = times.begin() + static_cast<std::ptrdiff_t>((kept * percent + 99) / 100 - 1);
    std::nth_element(times.begin(), place, times.end());  // Sorting all times would delay a step.
    return *place;
  };
  return {count, percentile(50), percentile(99), *std::max_element(times.begin(), times.end())};
}

void show_times(const std::string& count, const std::string& time,
                const DurationStatistics& statistics, Status& status) {
  const DurationStatistics::Summary times = statistics.summary();
  constexpr double kMicroseconds = 1e6;
  status.add(count, times.count);
  status.add(time + ", median [us]", times.median * kMicroseconds);
  status.add(time + ", 99th percentile [us]", times.percentile_99 * kMicroseconds);
  status.add(time + ", worst [us]", times.worst * kMicroseconds);
}

void add_diagnostics(diagnostic_updater::DiagnosticTaskVector& tasks, const ReceivedParts& parts) {
  tasks.add("tools", [parts](auto& status) { show_tools(parts, status); });
  tasks.add("organs", [parts](auto& status) { show_organs(parts, status); });
  tasks.add("messages", [parts](auto& status) { show_messages(parts, status); });
}

void show_tools(const ReceivedParts& parts, Status& status) {
  status.summary(DiagnosticStatus::OK, counted(parts.tools.size(), "tool"));
  if (parts.tools.empty()) status.summary(DiagnosticStatus::WARN, kNoTools);
  for (const Tool& tool : parts.tools) show_tool(tool, status);
  show_failures("doubted", parts.doubted, status);
}

void show_organs(const ReceivedParts& parts, Status& status) {
  const ros::Time now = ros::Time::now();
  const double timeout = parts.mesh_timeout_sec;
  status.summary(DiagnosticStatus::OK, counted(parts.organs.organs().size(), "organ"));
  for (const auto& [name, organ] : parts.organs.organs()) {
    const OrganShape& shape = organ.latest();
    status.add(name + ", age of mesh [s]", shape.age(now));
    show_organ(organ, parts.organs.last_refusal(name), status);
    const std::string stale = stale_fault(name, shape, now, timeout);
    if (!stale.empty()) status.mergeSummary(DiagnosticStatus::WARN, stale);
  }
}

void show_messages(const ReceivedParts& parts, Status& status) {
  status.summary(DiagnosticStatus::OK, "none rejected");
  status.add("mesh rate [1/s]", parts.meshes.take(std::chrono::steady_clock::now()));
  const OrganMessageCounts counts = parts.intake.counts();
  status.add("organ messages received", counts.received);
  status.add("organ messages applied", counts.applied);
  status.add("organ messages refused", counts.refused);
  status.add("organ messages that remove", counts.removals);
  status.add("organ messages dropped behind a large mesh", counts.dropped);
  status.add("organ messages waiting", counts.waiting);
  status.add("organ messages lost before they came", counts.lost);
  show_failures("rejected", parts.rejected, status);
}

void show_queries(const std::vector<std::string>& misspelt, const CollisionPipeline& pipeline,
                  NodeCounters& counters, Status& status) {
  status.summary(DiagnosticStatus::OK, "answering");
  status.add("GL version", pipeline.workers.gl_version());
  show_times("queries", "query time", counters.query_times, status);
  const StepCounts steps = pipeline.steps.counts();
  status.add("faces clipped by OpenGL", steps.picked.drawn);
  status.add("faces decided without OpenGL", steps.picked.undrawn);
  status.add("motion samples cut", steps.samples_cut);
  status.add("transforms after their step", pipeline.inbox.transforms.late());
  status.add("poses merged into later ones", steps.poses_merged);
  status.add("ticks merged into later ones", steps.ticks_merged);
  status.add("shapes due", steps.due);
  status.add("shapes answered", steps.answered);
  status.add("shapes superseded by newer ones", steps.superseded);
  status.add("shapes forgotten before their step", steps.forgotten);
  status.add("shapes waiting", steps.waiting);
  status.add("answers published", counters.published);
  show_times("service queries", "service query time", counters.service_times, status);
  status.add("batches", counters.batches.load());
  status.add("motions of batches", counters.motions.load());
  for (const std::string& sentence : misspelt) {
    status.mergeSummary(DiagnosticStatus::WARN, sentence);
  }
  show_failures("unanswered", counters.failed, status);
  show_failures("answered in part", counters.incomplete, status);
  show_failures("refused", counters.refused, status);
}

}  // namespace organ_collision
