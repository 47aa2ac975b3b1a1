/// snapshot: pictures of the markers that the node publishes for RViz, without a display.

#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <algorithm>
#include <boost/algorithm/string/predicate.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/messages/conversions.hpp"
#include "common/program/user_input.hpp"
#include "geometry/concatenate.hpp"
#include "markers.hpp"
#include "picking/volumes/viewing_volume.hpp"
#include "renderer.hpp"

namespace organ_collision {
namespace {

constexpr char kUsage[] = R"(Usage: rosrun organ_collision snapshot [OPTIONS]

Writes a PNG picture of what RViz would show of MarkerArray topics. Needs no display and no GPU.
Waits for the first marker, then takes the picture and ends.

What is shown:
  --topic NAME         a topic of type visualization_msgs/MarkerArray; may be given several times;
                       organ_collision/markers by default
  --hide NAMESPACE     leaves out the markers of a namespace and of those in it: surface also hides
                       surface/liver; may be given several times
  --frame NAME         the fixed frame, as in RViz; markers of other frames are placed by TF;
                       by default the frame of the first marker
  --after SECONDS      time from the first marker to the picture, so that all markers come; 0.5
  --timeout SECONDS    the longest time to wait for a marker, by the wall clock; 10

The camera:
  --view A,E           where the viewer is, seen from the target: azimuth from the x axis to the
                       y axis, and elevation, in degrees
  --view X,Y,Z         the same as a direction; 1,-1,0.8
  --target X,Y,Z       the middle of the picture [m]; by default the centre of the scene
  --distance METRES    from the viewer to the target; by default the whole scene is shown

The picture:
  --output FILE        snapshot.png
  --size WxH           width and height in pixels, each from 16 to 4096; 800x600
  --background COLOUR  '#RRGGBB'; '#282d36', as in the package's configuration of RViz

A sequence of pictures, for example for a video:
  --frames N           number of pictures; --output frame.png writes frame_0001.png and so on
  --rate HZ            pictures a second, by ROS time; 10
The camera stays where it is for the first picture.

Surfaces look smooth. Texts, mesh files, points and lists of cubes or spheres are not drawn.
Subscribes to the topics, /tf and /tf_static. Has no parameters and no services.

Exit status: 0 done; 1 no picture, with the reason on stderr; 2 an illegal option.
)";

/// The options on the command line of snapshot.
struct SnapshotOptions {
  std::vector<std::string> topics{"organ_collision/markers"};
  std::vector<std::string> hidden;  ///< namespaces of markers
  std::string output = "snapshot.png";
  Eigen::Vector2i size{800, 600};          ///< [pixel] width and height
  Eigen::Vector3d to_eye{1.0, -1.0, 0.8};  ///< the direction from the target to the viewer
  std::optional<Eigen::Vector3d> target;   ///< [m] none: the centre of the scene
  double distance = 0.0;                   ///< [m] 0: the whole scene is in the picture
  std::string frame;                       ///< empty: the frame of the first marker
  Colour background{0.157F, 0.176F, 0.212F, 1.0F};
  double after_sec = 0.5;     ///< the time from the first marker to the first picture
  std::size_t frames = 0;     ///< 0: one picture, which is no sequence
  double rate = 10.0;         ///< [Hz] the rate of the pictures of a sequence
  double timeout_sec = 10.0;  ///< the longest time to wait for a marker, by the wall clock
};

constexpr int kShortestSide = 16;       // [pixel]
constexpr double kLongest = 1e6;        // [s], [m]
constexpr std::uint32_t kQueue = 4000;  // [messages]

/// The finite numbers between separators, or none if the text is anything else.
std::vector<double> numbers(const std::string& text, char separator = ',') {
  std::vector<std::string_view> parts;
  split_cells(text, parts, separator);
  std::vector<double> result;
  for (const std::string_view part : parts) {
    const std::optional<double> number = parse_number(part);
    if (!number || !std::isfinite(*number)) return {};
    result.push_back(*number);
  }
  return result;
}

std::optional<Eigen::Vector3d> vector(const std::string& text) {
  const std::vector<double> parts = numbers(text);
  return parts.size() == 3 ? std::optional<Eigen::Vector3d>(parts.data()) : std::nullopt;
}

/// The unit vector to the viewer, from a text AZIMUTH,ELEVATION in degrees, or X,Y,Z.
std::optional<Eigen::Vector3d> view(const std::string& text) {
  const std::vector<double> parts = numbers(text);
  if (parts.size() == 2) {
    const double azimuth = parts[0] * M_PI / 180.0, elevation = parts[1] * M_PI / 180.0;
    return Eigen::Vector3d(std::cos(elevation) * std::cos(azimuth),
                           std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
  }
  const std::optional<Eigen::Vector3d> direction = vector(text);
  if (!direction || direction->isZero(0.0)) return std::nullopt;
  return direction->stableNormalized();
}

std::optional<Eigen::Vector2i> size(const std::string& text) {
  const std::vector<double> parts = numbers(text, 'x');
  const auto is_legal = [](double side) {
    return side >= kShortestSide && side <= kLongestSide && side == std::floor(side);
  };
  if (parts.size() != 2 || !is_legal(parts[0]) || !is_legal(parts[1])) return std::nullopt;
  return Eigen::Vector2d(parts[0], parts[1]).cast<int>();
}

std::optional<Colour> colour(const std::string& text) {
  if (text.size() != 7 || text[0] != '#' ||
      text.find_first_not_of("0123456789abcdefABCDEF", 1) != std::string::npos) {
    return std::nullopt;
  }
  const unsigned long rgb = std::stoul(text.substr(1), nullptr, 16);
  return Colour(rgb >> 16 & 255, rgb >> 8 & 255, rgb & 255, 255) / 255.0F;
}

/// Takes the text of an option: sets `value` to the result of `read`. The text is illegal if there
/// is none.
template <typename Value, typename Read>
CommandLine::Take set(Value& value, Read read) {
  return [&value, read](const std::string& text) {
    const auto found = read(text);
    if (found) value = *found;
    return found.has_value();
  };
}

/// `arguments` exclude the program's name and ROS's remappings. Returns none if --help is asked
/// for.
std::optional<SnapshotOptions> parse_options(const std::vector<std::string>& arguments) {
  SnapshotOptions options;
  std::vector<std::string> topics;
  CommandLine line("snapshot", kUsage);
  line.texts("topic", topics);
  line.texts("hide", options.hidden);
  line.text("frame", options.frame);
  line.number("after", options.after_sec, 0.0, kLongest);
  line.number("timeout", options.timeout_sec, 0.0, kLongest);
  line.option("view", "AZIMUTH,ELEVATION in degrees, or X,Y,Z, not all 0",
              set(options.to_eye, view));
  line.option("target", "X,Y,Z", set(options.target, vector));
  line.number("distance", options.distance, 1e-3, kLongest);
  line.text("output", options.output);
  line.option("size", concatenate("WIDTHxHEIGHT, each from ", kShortestSide, " to ", kLongestSide),
              set(options.size, size));
  line.option("background", "#RRGGBB in hexadecimal digits, for example '#ffffff'",
              set(options.background, colour));
  line.count("frames", options.frames, 9999);  // The names of the files have four digits.
  line.number("rate", options.rate, 0.01, 1000.0);
  if (!line.read(arguments)) return std::nullopt;
  if (!topics.empty()) options.topics = topics;
  return options;
}

/// The file of a picture of a sequence: number 1 of "frame.png" is "frame_0001.png".
std::string numbered_file(const std::string& file, std::size_t number) {
  std::filesystem::path path(file);
  const std::string digits = std::to_string(10000 + number).substr(1);
  return path.replace_filename(path.stem().string() + "_" + digits + path.extension().string());
}

/// Receives the markers of several topics, places them in the fixed frame by TF, and takes
/// pictures.
class Snapshot {
 public:
  explicit Snapshot(const SnapshotOptions& options)
      : options_(options),
        axes_(camera_axes(options.to_eye, Eigen::Vector3d::UnitZ().cross(options.to_eye))),
        frame_(tf_frame(options.frame)),
        renderer_(options.size.x(), options.size.y()) {
    for (const std::string& topic : options.topics) {
      subscribers_.push_back(node_.subscribe<visualization_msgs::MarkerArray>(
          topic, kQueue, [this, topic](const visualization_msgs::MarkerArrayConstPtr& message) {
            receive(topic, *message);
          }));
    }
  }

  void take_all() {
    wait_for_marker();
    const ros::Time first = ros::Time::now() + ros::Duration(options_.after_sec);
    if (options_.frames == 0) return take(first, options_.output);
    for (std::size_t i = 0; i < options_.frames; ++i) {
      const ros::Duration since_first(static_cast<double>(i) / options_.rate);
      take(first + since_first, numbered_file(options_.output, i + 1));
    }
    if (latest_ > 1.0 / options_.rate) {
      warn(concatenate("the machine is too slow for --rate ", options_.rate,
                       ": pictures were taken up to ", latest_, " s too late"));
    }
  }

 private:
  void receive(const std::string& topic, const visualization_msgs::MarkerArray& message) {
    markers_.apply(topic, message, ros::Time::now());
    const auto& entries = markers_.entries();
    if (frame_.empty() && !entries.empty()) {
      frame_ = tf_frame(entries.begin()->second.marker.header.frame_id);
    }
  }

  std::optional<Eigen::Isometry3d> look_up(const std::string& frame, const ros::Time& stamp) {
    if (tf_frame(frame) == frame_) return Eigen::Isometry3d::Identity();
    try {
      return to_eigen(buffer_.lookupTransform(frame_, tf_frame(frame), stamp).transform);
    } catch (const tf2::TransformException& error) {
      missing_transforms_[frame] = error.what();
      return std::nullopt;
    }
  }

  /// Handles messages for a short time. Afterwards, the markers are those that RViz would show now.
  void update() {
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.01));
    markers_.expire(ros::Time::now());
    missing_transforms_.clear();
    markers_.place(
        [this](const std::string& frame, const ros::Time& stamp) { return look_up(frame, stamp); });
    if (!ros::ok()) throw std::runtime_error("interrupted");
  }

  void wait_for_marker() {
    const ros::SteadyTime end = ros::SteadyTime::now() + ros::WallDuration(options_.timeout_sec);
    const auto is_placed = [](const auto& entry) {
      return entry.second.T_fixed_header.has_value();
    };
    const auto& entries = markers_.entries();
    for (update(); std::none_of(entries.begin(), entries.end(), is_placed); update()) {
      if (ros::SteadyTime::now() > end) throw std::runtime_error(why_no_marker());
    }
  }

  std::string why_no_marker() const {
    std::string topics;
    bool has_publisher = false;
    for (const ros::Subscriber& subscriber : subscribers_) {
      topics += " " + subscriber.getTopic();
      has_publisher |= subscriber.getNumPublishers() > 0;
    }
    if (!has_publisher) {
      return "no node publishes" + topics + "; `rostopic list` shows what there is";
    }
    if (missing_transforms_.empty()) return "no marker came within the timeout on" + topics;
    const auto& [frame, error] = *missing_transforms_.begin();
    return "the markers of frame '" + frame + "' have no transform: " + error;
  }

  /// Waits until a time. Simulated time may be slow, but it must go on.
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

  /// Whether the namespace, or one that contains it, is hidden: "surface" contains "surface/liver".
  bool is_hidden(const std::string& marker_namespace) const {
    return std::any_of(options_.hidden.begin(), options_.hidden.end(),
                       [&](const std::string& hidden) {
                         return boost::starts_with(marker_namespace + '/', hidden + '/');
                       });
  }

  PictureTriangles scene() {
    PictureTriangles triangles;
    for (const auto& [key, entry] : markers_.entries()) {
      const auto& [topic, name_space, id] = key;
      if (!entry.T_fixed_header || is_hidden(name_space)) continue;
      try {
        add_marker(entry.marker, *entry.T_fixed_header, axes_, triangles);
      } catch (const InputError& error) {
        warn(concatenate("marker ", name_space, "/", id, " of ", topic,
                         " is left out: ", error.what()));
      }
    }
    for (const auto& [frame, error] : missing_transforms_) {
      warn(concatenate("the markers of frame '", frame, "' are left out: ", error));
    }
    return triangles;
  }

  void set_camera(const PictureTriangles& triangles) {
    const Eigen::Vector3d target = options_.target.value_or(centre(triangles));
    const double distance = options_.distance > 0.0
                                ? options_.distance
                                : framing_distance(triangles, target, axes_, renderer_.aspect());
    camera_ = {target + distance * axes_.col(2), axes_};
    is_framed_ = true;
  }

  /// Prints each warning only once.
  void warn(const std::string& message) {
    if (said_.insert(message).second) std::cerr << "snapshot: " << message << std::endl;
  }

  const SnapshotOptions& options_;
  Eigen::Matrix3d axes_;  ///< the axes of the camera
  std::string frame_;     ///< the fixed frame; empty until the first marker gives it
  ros::NodeHandle node_;
  MarkerStore markers_;
  std::map<std::string, std::string> missing_transforms_;  ///< for each frame, the error of TF
  tf2_ros::Buffer buffer_;
  tf2_ros::TransformListener listener_{buffer_};
  std::vector<ros::Subscriber> subscribers_;
  Renderer renderer_;
  Camera camera_;
  bool is_framed_ = false;
  double latest_ = 0.0;  ///< [s] the largest delay of a picture
  std::set<std::string> said_;
};

void run(int argc, char** argv) {
  std::vector<std::string> arguments;
  ros::removeROSArgs(argc, argv, arguments);
  const std::optional<SnapshotOptions> options =
      parse_options({arguments.begin() + 1, arguments.end()});
  if (!options) return;
  ros::init(argc, argv, "snapshot", ros::init_options::AnonymousName);
  if (!ros::master::check()) {
    throw std::runtime_error("there is no ROS master at " + ros::master::getURI() +
                             "; start the scene first, for example with roslaunch");
  }
  Snapshot(*options).take_all();
}

}  // namespace
}  // namespace organ_collision

int main(int argc, char** argv) {
  return organ_collision::exit_code("snapshot", [&] { organ_collision::run(argc, argv); });
}
