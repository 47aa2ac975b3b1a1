#include "snapshot_options.hpp"

#include <algorithm>
#include <boost/program_options.hpp>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "geometry/concatenate.hpp"
#include "renderer.hpp"

namespace organ_collision {
namespace {

namespace po = boost::program_options;

constexpr int kShortestSide = 16;  // [pixel]
constexpr int kMostFrames = 9999;  // four digits

[[noreturn]] void refuse(const std::string& option, const std::string& value,
                         const std::string& legal) {
  throw OptionError("--" + option + " is '" + value + "'; must be " + legal);
}

/// The numbers between separators, or none if the text is anything else.
std::vector<double> numbers(const std::string& text, char separator) {
  std::vector<double> result;
  std::istringstream parts(text);
  parts.imbue(std::locale::classic());
  for (double number = 0.0; parts >> number;) {
    result.push_back(number);
    char next = 0;
    if (!(parts >> next)) return result;
    if (next != separator) break;
  }
  return {};
}

Eigen::Vector3d vector(const std::string& option, const std::string& value) {
  const std::vector<double> parts = numbers(value, ',');
  if (parts.size() != 3) refuse(option, value, "X,Y,Z");
  return {parts[0], parts[1], parts[2]};
}

Eigen::Vector3d direction(const std::string& option, const std::string& value) {
  const Eigen::Vector3d result = vector(option, value);
  if (result.isZero(0.0)) refuse(option, value, "X,Y,Z, not all 0");
  return result.stableNormalized();
}

/// AZIMUTH,ELEVATION in degrees, or X,Y,Z.
Eigen::Vector3d view(const std::string& value) {
  const std::vector<double> parts = numbers(value, ',');
  if (parts.size() == 3) return direction("view", value);
  if (parts.size() != 2) refuse("view", value, "AZIMUTH,ELEVATION in degrees, or X,Y,Z");
  const double azimuth = parts[0] * M_PI / 180.0, elevation = parts[1] * M_PI / 180.0;
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
          std::sin(elevation)};
}

void set_size(const std::string& value, SnapshotOptions& options) {
  const std::vector<double> parts = numbers(value, 'x');
  const auto is_legal = [](double side) {
    return side >= kShortestSide && side <= kLongestSide && side == std::floor(side);
  };
  if (parts.size() != 2 || !is_legal(parts[0]) || !is_legal(parts[1])) {
    refuse("size", value,
           concatenate("WIDTHxHEIGHT, each from ", kShortestSide, " to ", kLongestSide));
  }
  options.width = static_cast<int>(parts[0]);
  options.height = static_cast<int>(parts[1]);
}

Colour colour(const std::string& value) {
  if (value.size() != 7 || value[0] != '#' ||
      value.find_first_not_of("0123456789abcdefABCDEF", 1) != std::string::npos) {
    refuse("background", value, "#RRGGBB in hexadecimal digits, for example '#ffffff'");
  }
  const auto channel = [&](std::size_t at) {
    return static_cast<float>(std::stoi(value.substr(at, 2), nullptr, 16)) / 255.0F;
  };
  return {channel(1), channel(3), channel(5), 1.0F};
}

/// A number from `least` to `most`.
double number(const std::string& option, const std::string& value, double least, double most) {
  const std::vector<double> parts = numbers(value, ',');
  if (parts.size() != 1 || !(parts[0] >= least && parts[0] <= most)) {
    refuse(option, value, concatenate("a number from ", least, " to ", most));
  }
  return parts[0];
}

int whole_number(const std::string& option, const std::string& value, int least, int most) {
  const double result = number(option, value, least, most);
  if (result != std::floor(result)) refuse(option, value, "a whole number");
  return static_cast<int>(result);
}

po::variables_map split(const std::vector<std::string>& arguments) {
  po::options_description legal;
  for (const char* name : {"topic", "hide"}) {
    legal.add_options()(name, po::value<std::vector<std::string>>());
  }
  for (const char* name : {"output", "size", "view", "up", "target", "distance", "frame",
                           "background", "font", "after", "frames", "rate", "timeout"}) {
    legal.add_options()(name, po::value<std::string>());
  }
  legal.add_options()("stray", po::value<std::vector<std::string>>());
  po::positional_options_description positional;
  positional.add("stray", -1);

  po::variables_map values;
  try {
    using po::command_line_style::unix_style;
    const int style = unix_style & ~po::command_line_style::allow_guessing;
    po::store(
        po::command_line_parser(arguments).options(legal).positional(positional).style(style).run(),
        values);
  } catch (const po::error& error) {
    throw OptionError(error.what());
  }
  if (values.count("stray") > 0) {
    throw OptionError("unknown argument '" +
                      values["stray"].as<std::vector<std::string>>().front() + "'");
  }
  return values;
}

}  // namespace

SnapshotOptions parse_snapshot_options(const std::vector<std::string>& arguments) {
  SnapshotOptions options;
  for (const std::string& argument : arguments) {
    options.help = options.help || argument == "--help" || argument == "-h";
  }
  if (options.help) return options;

  constexpr double kLongest = 1e6;  // [s], [m]
  const po::variables_map values = split(arguments);
  if (values.count("topic") > 0) options.topics = values["topic"].as<std::vector<std::string>>();
  if (values.count("hide") > 0) options.hidden = values["hide"].as<std::vector<std::string>>();
  for (const auto& [name, any] : values) {
    if (name == "topic" || name == "hide") continue;
    const auto& value = any.as<std::string>();
    if (name == "output") options.output = value;
    if (name == "size") set_size(value, options);
    if (name == "view") options.to_eye = view(value);
    if (name == "up") options.up = direction(name, value);
    if (name == "target") options.target = vector(name, value);
    if (name == "distance") options.distance = number(name, value, 1e-3, kLongest);
    if (name == "frame") options.frame = value;
    if (name == "background") options.background = colour(value);
    if (name == "font") options.font = value;
    if (name == "after") options.after_sec = number(name, value, 0.0, kLongest);
    if (name == "frames") options.frames = whole_number(name, value, 1, kMostFrames);
    if (name == "rate") options.rate = number(name, value, 0.01, 1000.0);
    if (name == "timeout") options.timeout_sec = number(name, value, 0.0, kLongest);
  }
  return options;
}

bool is_hidden(const std::string& marker_namespace, const std::vector<std::string>& hidden) {
  return std::any_of(hidden.begin(), hidden.end(), [&](const std::string& name) {
    return (marker_namespace + "/").compare(0, name.size() + 1, name + "/") == 0;
  });
}

std::string numbered_file(const std::string& file, int number) {
  const std::size_t slash = file.rfind('/');
  const std::size_t dot = file.rfind('.');
  const bool has_ending = dot != std::string::npos && (slash == std::string::npos || dot > slash);
  const std::size_t end = has_ending ? dot : file.size();
  char digits[16];
  std::snprintf(digits, sizeof digits, "_%04d", number);
  return file.substr(0, end) + digits + file.substr(end);
}

std::string snapshot_usage() {
  return R"(Usage: rosrun organ_collision snapshot [OPTIONS]

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
}

}  // namespace organ_collision
