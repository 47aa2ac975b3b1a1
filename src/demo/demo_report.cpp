/// Prints what the collision node finds and what the palpator's proxy does: one line each second,
/// and a summary at the end.

#include <diagnostic_msgs/DiagnosticArray.h>
#include <organ_collision/ContactArray.h>
#include <organ_collision/OrganMesh.h>
#include <organ_collision/OrganVertices.h>
#include <organ_collision/ProxyState.h>
#include <ros/ros.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <map>
#include <set>

#include "common/messages/conversions.hpp"
#include "common/program/program.hpp"
#include "common/program/user_input.hpp"
#include "node/markers/markers.hpp"
#include "organ_collision/ros/names.hpp"

namespace organ_collision {
namespace {

constexpr double kFirstPatienceSec = 60.0;  // until the collision node answers for the first time
constexpr double kPatienceSec = 10.0;       // between two answers
constexpr double kMicroseconds = 1e6;
constexpr char kCollisionNode[] = "/organ_collision";
constexpr char kHapticNode[] = "/haptic_proxy";
constexpr char kProxyTopic[] = "palpator/state";
// Keys on /diagnostics, where the collision node tells its query times.
constexpr char kMedian[] = "query time, median [us]", kWorst[] = "query time, worst [us]";
constexpr char kPercentile99[] = "query time, 99th percentile [us]";

ProgramHelp help() {
  ProgramHelp help{"demo_report",
                   "Prints what the collision node finds and what the palpator's proxy does: one "
                   "line each second, and a summary at the end. Names of topics are below the "
                   "collision node's, unless they begin with /."};
  help.subscribed = {{names::kContacts, "organ_collision/ContactArray", "the answers"},
                     {names::kOrganMesh, "organ_collision/OrganMesh", "the organ"},
                     {names::kOrganVertices, "organ_collision/OrganVertices", "its shapes"},
                     {std::string(kHapticNode) + "/" + kProxyTopic, "organ_collision/ProxyState",
                      "what the palpator's proxy does"},
                     {"/diagnostics", "diagnostic_msgs/DiagnosticArray", "query times"}};
  help.parameters = {{"seconds", "0", "[s] how long it listens; 0: until it is stopped"},
                     {"collision_node", kCollisionNode, "name of the collision node"},
                     {"haptic_node", kHapticNode, "name of the node that has the proxy"},
                     {"ends_launch", "false", "true: when it ends, roslaunch ends, too"}};
  help.further = "roslaunch organ_collision demo.launch starts it.";
  return help;
}

/// [s] The value that `percent` of all values do not exceed; 0 if there are none.
double percentile(std::vector<double> values, double percent) {
  if (values.empty()) return 0.0;
  const auto nth = values.begin() + std::lround(percent / 100.0 * (values.size() - 1));
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

/// What a proxy did.
struct ProxyTally {
  void add(const ProxyState& state) {
    latest = state;
    if (state.state == ProxyState::NO_ANSWER) return;
    const double force = to_eigen(state.wrench.force).norm();
    ++poses;
    ++answered;
    held += state.state != ProxyState::FREE;
    recent_force = std::max(recent_force, force);
    greatest_force = std::max(greatest_force, force);
    tick_sec += state.tick_sec;
  }

  ProxyState latest;
  // What happened since the last printed line.
  std::size_t poses = 0;      ///< poses that had an answer
  double recent_force = 0.0;  ///< [N] the greatest force
  // What happened since the start.
  std::size_t answered = 0, held = 0;
  double greatest_force = 0.0;  ///< [N]
  double tick_sec = 0.0;        ///< [s] the sum of all ticks
};

/// What the collision node found of a tool.
struct ContactTally {
  std::set<std::uint32_t> faces;     ///< touched since the last printed line
  std::size_t contacts = 0;          ///< since the start
  std::size_t missed_by_static = 0;  ///< those that had ended when the step ended
};

class DemoReport {
 public:
  DemoReport(ros::NodeHandle node, ros::NodeHandle collision_node, ros::NodeHandle haptic_node)
      : subscribers_{
            collision_node.subscribe("organ_mesh", 10, &DemoReport::on_mesh, this),
            collision_node.subscribe("organ_vertices", 1000, &DemoReport::on_vertices, this),
            collision_node.subscribe("contacts", 1000, &DemoReport::on_contacts, this),
            haptic_node.subscribe(kProxyTopic, 1000, &ProxyTally::add, &proxy_),
            node.subscribe("/diagnostics", 10, &DemoReport::on_diagnostics, this)} {}

  /// When the collision node answered last, even if only with a failure. Zero: never.
  ros::WallTime last_answer() const { return last_answer_; }

  /// Prints one line about the last `seconds`. `time` [s]: since the start.
  void print_line(double time, double seconds) {
    std::printf("%4.0f s  %3.0f shapes/s  %3.0f answers/s", time, shapes_ / seconds,
                answers_ / seconds);
    for (auto& [tool, tally] : tallies_) {
      std::printf("  %s %zu faces", tool.c_str(), tally.faces.size());
      tally.faces.clear();
    }
    if (diagnostics_[kMedian] > 0.0) std::printf("  query %.0f us", diagnostics_[kMedian]);
    std::printf("  palpator %s", name_of(static_cast<ProxyStatus>(proxy_.latest.state)).c_str());
    if (proxy_.latest.state == ProxyState::NO_ANSWER) {
      std::printf(": %s\n", proxy_.latest.message.c_str());
    } else {
      std::printf(", up to %.1f N, %.0f poses/s\n", proxy_.recent_force, proxy_.poses / seconds);
    }
    if (!failure_.empty()) std::printf("        %s\n", failure_.c_str());
    flush_stdout();
    shapes_ = answers_ = proxy_.poses = 0;
    proxy_.recent_force = 0.0;
    failure_.clear();
  }

  /// Prints the summary. Returns false if there were no contacts, or if the proxy gave no answer.
  /// `time` [s]: since the start.
  bool print_summary(double time) {
    std::size_t contacts = 0, missed = 0;
    for (const auto& [tool, tally] : tallies_) {
      contacts += tally.contacts;
      missed += tally.missed_by_static;
    }
    std::printf("\nIn %.0f s: %zu contacts.", time, contacts);
    if (contacts > 0) {
      std::printf(" A static test at the same instants would have missed %zu of them (%.0f%%):\n",
                  missed, 100.0 * missed / contacts);
    }
    for (const auto& [tool, tally] : tallies_) {
      std::printf("  %-10s %6zu contacts, %6zu missed\n", tool.c_str(), tally.contacts,
                  tally.missed_by_static);
    }
    std::printf("Query time: median %.0f us, 99%% within %.0f us, worst %.0f us.\n",
                diagnostics_[kMedian], diagnostics_[kPercentile99], diagnostics_[kWorst]);
    std::printf("From shape to answer, through ROS: median %.0f us, 99%% within %.0f us.\n",
                kMicroseconds * percentile(delays_, 50.0),
                kMicroseconds * percentile(delays_, 99.0));
    const double all = std::max<double>(1.0, proxy_.answered);
    std::printf(
        "The palpator's hand: %zu poses, tissue held the proxy in %.0f%% of them, with at most "
        "%.1f N; %.0f us a tick on average.\n",
        proxy_.answered, 100.0 * proxy_.held / all, proxy_.greatest_force,
        kMicroseconds * proxy_.tick_sec / all);
    flush_stdout();
    return contacts > 0 && proxy_.answered > 0;
  }

 private:
  void on_mesh(const OrganMesh& mesh) {
    ++shapes_;
    if (mesh.topology > 0) std::printf("        a cut: %zu faces\n", mesh.triangles.size() / 3);
  }

  void on_vertices(const OrganVertices&) { ++shapes_; }

  void on_contacts(const ContactArrayConstPtr& answer) {
    last_answer_ = ros::WallTime::now();
    if (answer->status != ContactArray::OK) {
      failure_ = answer->message;
      return;
    }
    ++answers_;
    delays_.push_back((ros::Time::now() - answer->mesh_stamp).toSec());
    ContactTally& tally = tallies_[answer->tool];
    for (const Contact& contact : answer->contacts) {
      tally.faces.insert(contact.face);
      ++tally.contacts;
      tally.missed_by_static += !contact.touching;
    }
  }

  void on_diagnostics(const diagnostic_msgs::DiagnosticArray& array) {
    for (const auto& status : array.status) {
      for (const auto& entry : status.values) {
        const double value = std::atof(entry.value.c_str());
        double& known = diagnostics_[entry.key];
        known = entry.key == kWorst ? std::max(known, value) : value;
      }
    }
  }

  ProxyTally proxy_;
  std::map<std::string, ContactTally> tallies_;  ///< by tool
  std::size_t shapes_ = 0, answers_ = 0;         ///< since the last line
  std::vector<double> delays_;                   ///< [s] from shape to answer
  std::map<std::string, double> diagnostics_;    ///< the numbers on /diagnostics, by key
  ros::WallTime last_answer_;
  std::string failure_;  ///< the latest failure since the last line

  std::vector<ros::Subscriber> subscribers_;
};

/// Reports for `seconds`, or without end if that is 0. Returns false if there were no contacts, or
/// if the proxy gave no answer. Throws std::runtime_error if the collision node does not answer.
bool report(const std::string& collision_node, const std::string& haptic_node, double seconds) {
  DemoReport report{ros::NodeHandle(), ros::NodeHandle(collision_node),
                    ros::NodeHandle(haptic_node)};
  const auto now = [] { return ros::WallTime::now(); };
  const auto listen = [&] {
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.02));
  };
  const auto check = [&](ros::WallTime since, double patience) {
    if ((now() - since).toSec() > patience) {
      throw std::runtime_error(collision_node + " does not answer");
    }
  };

  ros::WallTime start = now();
  for (; ros::ok() && report.last_answer().isZero(); listen()) check(start, kFirstPatienceSec);
  start = now();
  const auto elapsed = [&] { return (now() - start).toSec(); };
  double last_line = 0.0, next_line = 1.0;
  while (ros::ok() && !(seconds > 0.0 && elapsed() >= seconds)) {
    listen();
    check(report.last_answer(), kPatienceSec);
    if (elapsed() < next_line) continue;
    report.print_line(elapsed(), elapsed() - last_line);
    last_line = elapsed();
    next_line += 1.0;
  }
  return report.print_summary(elapsed());
}

}  // namespace
}  // namespace organ_collision

int main(int argc, char** argv) try {
  using namespace organ_collision;
  if (const auto exit_code = answer_arguments(argc, argv, help())) return *exit_code;
  ros::init(argc, argv, "demo_report");
  ros::NodeHandle private_node("~");
  const bool has_answers = report(private_node.param<std::string>("collision_node", kCollisionNode),
                                  private_node.param<std::string>("haptic_node", kHapticNode),
                                  private_node.param("seconds", 0.0));
  if (!has_answers) return 1;
  if (ros::ok() && private_node.param("ends_launch", false)) {
    // Ends roslaunch, which has started this program, as Ctrl-C does. If this program ended first,
    // roslaunch would report the death of a required node as an error.
    kill(getppid(), SIGINT);
    ros::waitForShutdown();
  }
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "demo_report: %s\n", error.what());  // ROS is shut down by now
  return 1;
}
