/// snapshot: pictures of the markers that the node publishes for RViz, without a display.

#include <ros/ros.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "geometry/concatenate.hpp"
#include "marker_picture.hpp"
#include "markers.hpp"
#include "offline/user_input.hpp"
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
  --up X,Y,Z           the direction that is upwards in the picture; 0,0,1
  --target X,Y,Z       the middle of the picture [m]; by default the centre of the scene
  --distance METRES    from the viewer to the target; by default the whole scene is shown

The picture:
  --output FILE        snapshot.png
  --size WxH           width and height in pixels, each from 16 to 4096; 800x600
  --background COLOUR  '#RRGGBB'; '#282d36', as in the package's configuration of RViz
  --font FILE          a TrueType font for texts; DejaVu Sans (package fonts-dejavu-core)

A sequence of pictures, for example for a video:
  --frames N           number of pictures; --output frame.png writes frame_0001.png and so on
  --rate HZ            pictures a second, by ROS time; 10
The camera stays where it is for the first picture.

All types of markers are drawn. Surfaces look smooth. Colours and textures inside of mesh files are
not shown. Subscribes to the topics, /tf and /tf_static. Has no parameters and no services.

Exit status: 0 done; 1 no picture, with the reason on stderr; 2 an illegal option.
)";

/// The options on the command line of snapshot.
struct SnapshotOptions {
  std::vector<std::string> topics{"organ_collision/markers"};
  std::vector<std::string> hidden;  ///< namespaces of markers
  std::string output = "snapshot.png";
  Eigen::Vector2i size{800, 600};          ///< [pixel] width and height
  Eigen::Vector3d to_eye{1.0, -1.0, 0.8};  ///< direction from the target to the viewer
  Eigen::Vector3d up{0.0, 0.0, 1.0};
  std::optional<Eigen::Vector3d> target;            ///< [m] none: the centre of the scene
  std::optional<double> distance;                   ///< [m] none: the whole scene is in the picture
  std::string frame;                                ///< empty: the frame of the first marker
  Colour background{0.157F, 0.176F, 0.212F, 1.0F};  ///< dark, because texts are white
  std::string font = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
  double after_sec = 0.5;     ///< from the first marker to the first picture
  int frames = 0;             ///< 0: one picture, which is no sequence
  double rate = 10.0;         ///< [Hz] pictures of a sequence
  double timeout_sec = 10.0;  ///< of the wall clock
};

constexpr int kShortestSide = 16;  // [pixel]
constexpr int kMostFrames = 9999;  // four digits
constexpr double kLongest = 1e6;   // [s], [m]

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
  if (parts.size() != 3) return std::nullopt;
  return Eigen::Vector3d(parts[0], parts[1], parts[2]);
}

std::optional<Eigen::Vector3d> direction(const std::string& text) {
  const std::optional<Eigen::Vector3d> result = vector(text);
  if (!result || result->isZero(0.0)) return std::nullopt;
  return result->stableNormalized();
}

/// AZIMUTH,ELEVATION in degrees, or X,Y,Z.
std::optional<Eigen::Vector3d> view(const std::string& text) {
  const std::vector<double> parts = numbers(text);
  if (parts.size() != 2) return direction(text);
  const double azimuth = parts[0] * M_PI / 180.0, elevation = parts[1] * M_PI / 180.0;
  return Eigen::Vector3d(std::cos(elevation) * std::cos(azimuth),
                         std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
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
  const auto channel = [&](std::size_t at) {
    return static_cast<float>(std::stoi(text.substr(at, 2), nullptr, 16)) / 255.0F;
  };
  return Colour(channel(1), channel(3), channel(5), 1.0F);
}

std::optional<int> frames(const std::string& text) {
  const std::optional<long long> count = parse_integer(text);
  if (!count || *count < 1 || *count > kMostFrames) return std::nullopt;
  return static_cast<int>(*count);
}

/// Sets `value` to what `read` makes of the text of an option, if it makes something of it.
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
  double distance = 0.0;
  CommandLine line("snapshot");
  line.texts("topic", topics);
  line.texts("hide", options.hidden);
  line.text("frame", options.frame);
  line.number("after", options.after_sec, 0.0, kLongest);
  line.number("timeout", options.timeout_sec, 0.0, kLongest);
  line.option("view", "AZIMUTH,ELEVATION in degrees, or X,Y,Z, not all 0",
              set(options.to_eye, view));
  line.option("up", "X,Y,Z, not all 0", set(options.up, direction));
  line.option("target", "X,Y,Z", set(options.target, vector));
  line.number("distance", distance, 1e-3, kLongest);
  line.text("output", options.output);
  line.option("size", concatenate("WIDTHxHEIGHT, each from ", kShortestSide, " to ", kLongestSide),
              set(options.size, size));
  line.option("background", "#RRGGBB in hexadecimal digits, for example '#ffffff'",
              set(options.background, colour));
  line.text("font", options.font);
  line.option("frames", concatenate("a whole number from 1 to ", kMostFrames),
              set(options.frames, frames));
  line.number("rate", options.rate, 0.01, 1000.0);
  if (!line.read(arguments)) return std::nullopt;
  if (!topics.empty()) options.topics = topics;
  if (distance > 0.0) options.distance = distance;
  return options;
}

/// Whether the namespace, or one that contains it, is hidden: "surface" contains "surface/liver".
bool is_hidden(const std::string& marker_namespace, const std::vector<std::string>& hidden) {
  return std::any_of(hidden.begin(), hidden.end(), [&](const std::string& name) {
    return (marker_namespace + "/").compare(0, name.size() + 1, name + "/") == 0;
  });
}

/// The file of a picture of a sequence: number 1 of "frame.png" is "frame_0001.png".
std::string numbered_file(const std::string& file, int number) {
  const std::size_t slash = file.rfind('/');
  const std::size_t dot = file.rfind('.');
  const bool has_ending = dot != std::string::npos && (slash == std::string::npos || dot > slash);
  const std::size_t end = has_ending ? dot : file.size();
  char digits[16];
  std::snprintf(digits, sizeof digits, "_%04d", number);
  return file.substr(0, end) + digits + file.substr(end);
}

class Snapshot {
 public:
  explicit Snapshot(const SnapshotOptions& options)
      : options_(options),
        axes_(view_axes(options.to_eye, options.up)),
        markers_(options.topics, options.frame),
        picture_(axes_, options.font),
        renderer_(options.size.x(), options.size.y()) {}

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

  PictureTriangles scene() {
    PictureTriangles triangles;
    for (const auto& [key, entry] : markers_.markers().entries()) {
      if (!entry.T_fixed_header || is_hidden(key.ns, options_.hidden)) continue;
      try {
        picture_.add(entry.marker, *entry.T_fixed_header, triangles);
      } catch (const InputError& error) {
        warn(concatenate("marker ", key.ns, "/", key.id, " of ", key.topic,
                         " is left out: ", error.what()));
      }
    }
    for (const auto& [frame, error] : markers_.missing_transforms()) {
      warn(concatenate("the markers of frame '", frame, "' are left out: ", error));
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
    const std::optional<SnapshotOptions> options =
        parse_options({arguments.begin() + 1, arguments.end()});
    if (!options) {
      std::cout << kUsage;
      return 0;
    }
    ros::init(argc, argv, "snapshot", ros::init_options::AnonymousName);
    if (!ros::master::check()) {
      throw std::runtime_error("there is no ROS master at " + ros::master::getURI() +
                               "; start the scene first, for example with roslaunch");
    }
    const ros::NodeHandle node;  // It keeps ROS running after the markers' own handle is gone.
    Snapshot(*options).take_all();
    return 0;
  } catch (const InputError& error) {
    std::cerr << error.what() << std::endl;
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "snapshot: " << error.what() << std::endl;
    return 1;
  }
}

}  // namespace
}  // namespace organ_collision

int main(int argc, char** argv) { return organ_collision::run(argc, argv); }
