/// snapshot: pictures of the markers that the node publishes for RViz, without a display.

#include <ros/ros.h>

#include <algorithm>
#include <iostream>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "camera.hpp"
#include "geometry/concatenate.hpp"
#include "marker_picture.hpp"
#include "markers.hpp"
#include "renderer.hpp"
#include "snapshot_options.hpp"

namespace organ_collision {
namespace {

class Snapshot {
 public:
  explicit Snapshot(const SnapshotOptions& options)
      : options_(options),
        axes_(view_axes(options.to_eye, options.up)),
        markers_(options.topics, options.frame),
        picture_(axes_, options.font),
        renderer_(options.width, options.height) {}

  void take_all() {
    wait_for_marker();
    const ros::Time first = ros::Time::now() + ros::Duration(options_.after_sec);
    if (options_.frames == 0) return take(first, options_.output);
    for (int i = 0; i < options_.frames; ++i) {
      take(first + ros::Duration(i / options_.rate), numbered_file(options_.output, i + 1));
    }
    if (latest_ > 1.0 / options_.rate) {
      warn(concatenate("the machine is too slow for --rate ", options_.rate,
                       ": pictures were taken up to ", latest_, " s too late"));
    }
  }

 private:
  void update() {
    markers_.update();
    if (!ros::ok()) throw std::runtime_error("interrupted");
  }

  void wait_for_marker() {
    const ros::SteadyTime end = ros::SteadyTime::now() + ros::WallDuration(options_.timeout_sec);
    for (update(); !markers_.has_placed_marker(); update()) {
      if (ros::SteadyTime::now() > end) throw std::runtime_error(why_no_marker());
    }
  }

  /// Simulated time may be slow, but it must go on.
  void wait_for(const ros::Time& time) {
    ros::Time now = ros::Time::now();
    ros::SteadyTime changed = ros::SteadyTime::now();
    for (; now < time; update()) {
      if (ros::Time::now() != now) changed = ros::SteadyTime::now();
      now = ros::Time::now();
      if ((ros::SteadyTime::now() - changed).toSec() > options_.timeout_sec) {
        throw std::runtime_error("ROS time stands still: does a node publish /clock?");
      }
    }
  }

  /// Takes the picture at a time, or as soon as there is something to be seen.
  void take(const ros::Time& time, const std::string& file) {
    wait_for(time);
    wait_for_marker();
    latest_ = std::max(latest_, (ros::Time::now() - time).toSec());
    const PictureTriangles triangles = scene();
    if (triangles.empty()) throw std::runtime_error("the markers show nothing");
    if (!is_framed_) set_camera(triangles);
    write_png(file, renderer_.render(triangles, camera_, options_.background));
  }

  void warn_of_frame(const std::string& frame, const std::string& error) {
    warn("the markers of frame '" + frame + "' are left out: " + error);
  }

  void warn_of_marker(const std::string& topic, const std::string& ns, int id,
                      const std::string& error) {
    warn("marker " + ns + "/" + std::to_string(id) + " of " + topic + " is left out: " + error);
  }

  PictureTriangles scene() {
    PictureTriangles triangles;
    for (const auto& [key, entry] : markers_.markers().entries()) {
      if (!entry.T_fixed_header || is_hidden(key.ns, options_.hidden)) continue;
      try {
        picture_.add(entry.marker, *entry.T_fixed_header, triangles);
      } catch (const MarkerError& error) {
        warn_of_marker(key.topic, key.ns, key.id, error.what());
      }
    }
    for (const auto& [frame, error] : markers_.missing_transforms()) {
      warn_of_frame(frame, error);
    }
    return triangles;
  }

  void set_camera(const PictureTriangles& triangles) {
    const Eigen::Vector3d target = options_.target.value_or(centre(triangles));
    const double distance = options_.distance
                                ? *options_.distance
                                : framing_distance(triangles, target, axes_, renderer_.aspect());
    camera_ = {target + distance * axes_.col(2), axes_};
    is_framed_ = true;
  }

  std::string why_no_marker() const {
    std::string topics;
    for (const std::string& topic : options_.topics) topics += " " + ros::names::resolve(topic);
    if (!markers_.has_publisher()) {
      return "no node publishes" + topics + "; `rostopic list` shows what there is";
    }
    if (!markers_.missing_transforms().empty()) {
      const auto& [frame, error] = *markers_.missing_transforms().begin();
      return "the markers of frame '" + frame + "' have no transform: " + error;
    }
    return "no marker came within the timeout on" + topics;
  }

  /// Says everything only once.
  void warn(const std::string& message) {
    if (said_.insert(message).second) std::cerr << "snapshot: " << message << std::endl;
  }

  const SnapshotOptions& options_;
  Eigen::Matrix3d axes_;
  MarkerListener markers_;
  MarkerPicture picture_;
  Renderer renderer_;
  Camera camera_;
  bool is_framed_ = false;
  double latest_ = 0.0;  ///< [s] by which a picture was taken too late
  std::set<std::string> said_;
};

int run(int argc, char** argv) {
  try {
    std::vector<std::string> arguments;
    ros::removeROSArgs(argc, argv, arguments);
    const SnapshotOptions options =
        parse_snapshot_options({arguments.begin() + 1, arguments.end()});
    if (options.help) {
      std::cout << snapshot_usage();
      return 0;
    }
    ros::init(argc, argv, "snapshot", ros::init_options::AnonymousName);
    if (!ros::master::check()) {
      throw std::runtime_error("there is no ROS master at " + ros::master::getURI() +
                               "; start the scene first, for example with roslaunch");
    }
    const ros::NodeHandle node;  // It keeps ROS running after the markers' own handle is gone.
    Snapshot(options).take_all();
    return 0;
  } catch (const OptionError& error) {
    std::cerr << "snapshot: " << error.what() << " (--help explains)" << std::endl;
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "snapshot: " << error.what() << std::endl;
    return 1;
  }
}

}  // namespace
}  // namespace organ_collision

int main(int argc, char** argv) { return organ_collision::run(argc, argv); }
