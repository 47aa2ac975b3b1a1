#pragma once

#include <Eigen/Core>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "camera.hpp"

namespace organ_collision {

/// An illegal command line. what() names the option, its value and what is legal.
class OptionError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The options on the command line of snapshot.
struct SnapshotOptions {
  std::vector<std::string> topics{"organ_collision/markers"};
  std::vector<std::string> hidden;  ///< namespaces of markers
  std::string output = "snapshot.png";
  int width = 800, height = 600;           ///< [pixel]
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
  bool help = false;
};

/// Reads the command line. `arguments` exclude the program's name and ROS's remappings. Throws
/// OptionError. If --help is among them, the others are not checked.
SnapshotOptions parse_snapshot_options(const std::vector<std::string>& arguments);

/// What --help prints.
std::string snapshot_usage();

/// Whether the namespace, or one that contains it, is hidden: "surface" contains "surface/liver".
bool is_hidden(const std::string& marker_namespace, const std::vector<std::string>& hidden);

/// The file of a picture of a sequence: number 1 of "frame.png" is "frame_0001.png".
std::string numbered_file(const std::string& file, int number);

}  // namespace organ_collision
