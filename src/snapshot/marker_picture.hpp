#pragma once

#include <visualization_msgs/Marker.h>

#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>

#include "camera.hpp"
#include "shapes.hpp"

namespace organ_collision {

/// A marker cannot be drawn. what() says which value is wrong.
class MarkerError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Turns markers into triangles, as RViz shows them: lists with a colour for each vertex have no
/// light; lines, points and texts face the viewer. Unlike in RViz, surfaces are smooth.
class MarkerPicture {
 public:
  /// `axes`: of the camera, as in Camera. `font`: a file for texts.
  MarkerPicture(const Eigen::Matrix3d& axes, const std::string& font) : axes_(axes), font_(font) {}

  /// Adds a marker whose header frame has this pose in the picture's frame. Throws MarkerError if
  /// the marker is illegal or of an unknown type, or its mesh file or the font cannot be read; then
  /// nothing is added.
  void add(const visualization_msgs::Marker& marker, const Eigen::Isometry3d& T_picture_header,
           PictureTriangles& picture);

 private:
  const TrianglePoints& mesh(const std::string& resource);
  const Font& font();

  Eigen::Matrix3d axes_;
  std::string font_;
  std::optional<Font> loaded_font_;
  std::map<std::string, TrianglePoints> meshes_;  ///< by resource
};

}  // namespace organ_collision
