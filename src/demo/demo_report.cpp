/// Prints what the collision node finds: a line a second, and a summary at the end.

#include <diagnostic_msgs/DiagnosticArray.h>
#include <organ_collision/ContactArray.h>
#include <organ_collision/OrganMesh.h>
#include <organ_collision/OrganVertices.h>
#include <ros/ros.h>
#include <tf2_ros/transform_listener.h>

#include <algorithm>
#include <cstdio>
#include <deque>
#include <map>
#include <set>
#include <sstream>

#include "organ_collision/geometry/closest_points.hpp"
#include "organ_collision/geometry/tolerances.hpp"
#include "organ_collision/ros/parameters.hpp"
#include "organ_collision/ros/tool_poses.hpp"

namespace organ_collision {
namespace {

constexpr std::size_t kShapesKept = 500;
constexpr std::size_t kFacesListed = 4;
constexpr double kMicroseconds = 1e6;

/// [s] The value that `percent` of all do not exceed; 0 without values.
double percentile(std::vector<double> values, double percent) {
  if (values.empty()) return 0.0;
  const auto nth = values.begin() + std::lround(percent / 100.0 * (values.size() - 1));
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

std::string first_of(const std::set<std::uint32_t>& faces) {
  std::ostringstream text;
  std::size_t listed = 0;
  for (const std::uint32_t face : faces) {
    if (listed++ == kFacesListed) return text.str() + " ...";
    text << (listed > 1 ? " " : "") << face;
  }
  return text.str();
}

struct Shape {
  ros::Time stamp;
  std::vector<float> vertices;
};

/// What one tool touched.
struct Tally {
  std::set<std::uint32_t> faces_this_second;
  std::size_t contacts = 0;
  std::size_t missed_by_static = 0;
};

/// What /diagnostics says of the node's query time [us].
struct QueryTime {
  double median = 0.0, percentile_99 = 0.0, worst = 0.0;
};

class DemoReport {
 public:
  DemoReport(ros::NodeHandle node, ros::NodeHandle collision_node)
      : tools_(load_parameters(collision_node).parameters.tools),
        poses_(transforms_, PathSampling{}),
        transform_listener_(transforms_),
        subscribers_{
            collision_node.subscribe("organ_mesh", 10, &DemoReport::on_mesh, this),
            collision_node.subscribe("organ_vertices", 1000, &DemoReport::on_vertices, this),
            collision_node.subscribe("contacts", 1000, &DemoReport::on_contacts, this),
            node.subscribe("/diagnostics", 10, &DemoReport::on_diagnostics, this)} {
    for (const ToolParameters& tool : tools_) tallies_[tool.name];
  }

  /// One line about the `seconds` since the last one.
  void print_line(double time, double seconds) {
    std::printf("%4.0f s  %3.0f shapes/s  %3.0f answers/s", time, shapes_ / seconds,
                answers_ / seconds);
    for (auto& [tool, tally] : tallies_) {
      const std::size_t count = tally.faces_this_second.size();
      std::printf("  %s %zu faces%s%s%s", tool.c_str(), count, count > 0 ? " (" : "",
                  first_of(tally.faces_this_second).c_str(), count > 0 ? ")" : "");
      tally.faces_this_second.clear();
    }
    if (query_time_.median > 0.0) std::printf("  query %.0f us", query_time_.median);
    std::printf("\n");
    if (!failure_.empty()) std::printf("        %s\n", failure_.c_str());
    std::fflush(stdout);
    shapes_ = answers_ = 0;
    failure_.clear();
  }

  /// The closing words. False if nothing was found.
  bool print_summary(double time) {
    judge_waiting();
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
    if (!waiting_.empty()) std::printf("  %zu answers were not compared\n", waiting_.size());
    std::printf("Query time: median %.0f us, 99%% within %.0f us, worst %.0f us.\n",
                query_time_.median, query_time_.percentile_99, query_time_.worst);
    std::printf("From shape to answer, through ROS: median %.0f us, 99%% within %.0f us.\n",
                kMicroseconds * percentile(delays_, 50.0),
                kMicroseconds * percentile(delays_, 99.0));
    std::fflush(stdout);
    return contacts > 0;
  }

 private:
  void on_mesh(const OrganMesh& mesh) {
    triangles_ = mesh.triangles;
    keep({mesh.header.stamp, mesh.vertices});
  }

  void on_vertices(const OrganVertices& vertices) {
    keep({vertices.header.stamp, vertices.vertices});
    judge_waiting();
  }

  void keep(Shape shape) {
    ++shapes_;
    latest_shapes_.push_back(std::move(shape));
    if (latest_shapes_.size() > kShapesKept) latest_shapes_.pop_front();
  }

  void on_contacts(const ContactArrayConstPtr& answer) {
    if (answer->status != ContactArray::OK) {
      failure_ = answer->message;
      return;
    }
    ++answers_;
    delays_.push_back((ros::Time::now() - answer->mesh_stamp).toSec());
    for (const auto& contact : answer->contacts) {
      tallies_[answer->tool].faces_this_second.insert(contact.face);
    }
    if (answer->contacts.empty()) return;
    waiting_.push_back(answer);
    judge_waiting();
  }

  void on_diagnostics(const diagnostic_msgs::DiagnosticArray& array) {
    for (const auto& status : array.status) {
      for (const auto& entry : status.values) {
        const double value = std::atof(entry.value.c_str());
        if (entry.key == "query time, median [us]") query_time_.median = value;
        if (entry.key == "query time, 99th percentile [us]") query_time_.percentile_99 = value;
        if (entry.key == "query time, worst [us]") {
          query_time_.worst = std::max(query_time_.worst, value);
        }
      }
    }
  }

  /// Answers whose shape and pose have arrived by now are compared with the static test.
  void judge_waiting() {
    const auto judged = std::remove_if(waiting_.begin(), waiting_.end(),
                                       [this](const auto& answer) { return judge(*answer); });
    waiting_.erase(judged, waiting_.end());
  }

  /// The static test: is the face within the radius of the axis when the step ends? By exact
  /// distances, without the collision node. False if shape or pose is not there yet.
  bool judge(const ContactArray& answer) {
    const auto tool = std::find_if(tools_.begin(), tools_.end(), [&](const ToolParameters& tool) {
      return tool.name == answer.tool;
    });
    const auto shape =
        std::find_if(latest_shapes_.rbegin(), latest_shapes_.rend(),
                     [&](const Shape& shape) { return shape.stamp == answer.mesh_stamp; });
    if (tool == tools_.end() || shape == latest_shapes_.rend() || triangles_.empty()) return false;
    const auto axis = poses_.axis(*tool, answer.header.frame_id, answer.header.stamp);
    if (!axis.found) return false;
    Tally& tally = tallies_[answer.tool];
    for (const auto& contact : answer.contacts) {
      const double distance =
          closest_points(axis.found->value, face(*shape, contact.face)).distance;
      ++tally.contacts;
      if (distance > tool->radius + tolerance::kTouch) ++tally.missed_by_static;
    }
    return true;
  }

  Triangle face(const Shape& shape, std::uint32_t number) const {
    Triangle corners;
    for (int k = 0; k < 3; ++k) {
      const float* vertex = &shape.vertices.at(3 * triangles_.at(3 * number + k));
      corners[k] = Eigen::Vector3d(vertex[0], vertex[1], vertex[2]);
    }
    return corners;
  }

  std::vector<ToolParameters> tools_;
  tf2_ros::Buffer transforms_;
  ToolPoses poses_;
  tf2_ros::TransformListener transform_listener_;

  std::vector<std::uint32_t> triangles_;
  std::deque<Shape> latest_shapes_;
  std::deque<ContactArrayConstPtr> waiting_;  ///< for their shape and pose

  std::map<std::string, Tally> tallies_;  ///< by tool
  std::size_t shapes_ = 0, answers_ = 0;  ///< since the last line
  std::vector<double> delays_;            ///< [s]
  QueryTime query_time_;
  std::string failure_;  ///< the last since the last line

  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace
}  // namespace organ_collision

int main(int argc, char** argv) {
  ros::init(argc, argv, "demo_report");
  ros::NodeHandle private_node("~");
  const double seconds = private_node.param("seconds", 0.0);
  const std::string collision_node =
      private_node.param<std::string>("collision_node", "/organ_collision");
  if (!ros::service::waitForService(ros::names::append(collision_node, "query"))) return 1;
  organ_collision::DemoReport report{ros::NodeHandle(), ros::NodeHandle(collision_node)};

  const ros::WallTime start = ros::WallTime::now();
  const auto elapsed = [&] { return (ros::WallTime::now() - start).toSec(); };
  double last_line = 0.0;
  while (ros::ok() && !(seconds > 0.0 && elapsed() >= seconds)) {
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.02));
    if (elapsed() - last_line < 1.0) continue;
    report.print_line(elapsed(), elapsed() - last_line);
    last_line = elapsed();
  }
  return report.print_summary(elapsed()) ? 0 : 1;
}
