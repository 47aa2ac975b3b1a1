#include "marker_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "geometry/concatenate.hpp"
#include "robot_reader/mesh_file.hpp"
#include "ros/messages/conversions.hpp"
#include "shapes.hpp"

namespace organ_collision {
namespace {

using Eigen::Affine3d;
using Eigen::Vector3d;
using visualization_msgs::Marker;

// [1] The proportions of RViz's arrows: head by length, and head by shaft diameter.
constexpr double kArrowHead = 0.23;
constexpr double kArrowHeadWidth = 2.0;

Colour colour_of(const std_msgs::ColorRGBA& colour) {
  return Colour(colour.r, colour.g, colour.b, colour.a).cwiseMax(0.0F).cwiseMin(1.0F);
}

bool is_finite(const std_msgs::ColorRGBA& colour) {
  return Colour(colour.r, colour.g, colour.b, colour.a).allFinite();
}

/// The header's frame is the target.
Eigen::Isometry3d pose_of(const Marker& marker) {
  const geometry_msgs::Quaternion& q = marker.pose.orientation;
  const Eigen::Quaterniond rotation(q.w, q.x, q.y, q.z);
  const bool is_empty = rotation.norm() == 0.0;  // RViz accepts it, too.
  return Eigen::Translation3d(to_eigen(marker.pose.position)) *
         (is_empty ? Eigen::Quaterniond::Identity() : rotation.normalized());
}

void check_finite(const Marker& marker) {
  const geometry_msgs::Quaternion& q = marker.pose.orientation;
  if (!to_eigen(marker.pose.position).allFinite() ||
      !Eigen::Vector4d(q.x, q.y, q.z, q.w).allFinite() || !to_eigen(marker.scale).allFinite()) {
    throw MarkerError("its pose or scale is not finite");
  }
  for (std::size_t i = 0; i < marker.points.size(); ++i) {
    if (!to_eigen(marker.points[i]).allFinite()) {
      throw MarkerError("point " + std::to_string(i) + " is not finite");
    }
  }
  if (!is_finite(marker.color) ||
      !std::all_of(marker.colors.begin(), marker.colors.end(), is_finite)) {
    throw MarkerError("a colour is not finite");
  }
}

void check_groups(const Marker& marker, std::size_t size) {
  if (marker.points.size() % size == 0) return;
  throw MarkerError(
      concatenate("it has ", marker.points.size(), " points; must be a multiple of ", size));
}

void check_colours(const Marker& marker) {
  const std::size_t points = marker.points.size(), colours = marker.colors.size();
  const bool one_a_face = marker.type == Marker::TRIANGLE_LIST && 3 * colours == points;
  if (colours == 0 || colours == points || one_a_face) return;
  throw MarkerError(concatenate("it has ", colours, " colours for ", points, " points"));
}

/// The colour of a point of a list.
Colour colour_at(const Marker& marker, std::size_t point) {
  if (marker.colors.empty()) return colour_of(marker.color);
  const std::size_t points_a_colour = marker.points.size() / marker.colors.size();
  return colour_of(marker.colors[point / points_a_colour]);
}

/// One marker on its way into the picture.
class Drawing {
 public:
  Drawing(const Marker& marker, const Affine3d& T_picture_marker, const Eigen::Matrix3d& axes,
          PictureTriangles& picture)
      : marker_(marker), marker_pose_(T_picture_marker), axes_(axes), picture_(picture) {}

  /// A shape in the marker's frame, lit, in one colour.
  void add_solid(const TrianglePoints& shape, const Affine3d& T_marker_shape,
                 const Colour& colour) {
    const Affine3d T_picture_shape = marker_pose_ * T_marker_shape;
    TrianglePoints points;
    for (const Vector3d& point : shape) points.push_back(T_picture_shape * point);
    if (T_picture_shape.linear().determinant() < 0.0) turn_inside_out(points);
    const std::vector<Vector3d> normals = smooth_normals(points);
    for (std::size_t i = 0; i < points.size(); ++i) {
      picture_.push_back({points[i], normals[i], colour});
    }
  }

  void add_scaled(const TrianglePoints& shape) {
    add_solid(shape, Affine3d(Eigen::Scaling(to_eigen(marker_.scale))), colour_of(marker_.color));
  }

  /// The same shape at each point.
  void add_solids(const TrianglePoints& shape) {
    check_colours(marker_);
    for (std::size_t i = 0; i < marker_.points.size(); ++i) {
      add_solid(shape,
                Eigen::Translation3d(to_eigen(marker_.points[i])) *
                    Affine3d(Eigen::Scaling(to_eigen(marker_.scale))),
                colour_at(marker_, i));
    }
  }

  void add_triangle_list() {
    check_groups(marker_, 3);
    check_colours(marker_);
    if (marker_.colors.empty()) {
      TrianglePoints points;
      for (const geometry_msgs::Point& point : marker_.points) points.push_back(to_eigen(point));
      return add_scaled(points);
    }
    const Affine3d T_picture_points = marker_pose_ * Eigen::Scaling(to_eigen(marker_.scale));
    for (std::size_t i = 0; i < marker_.points.size(); ++i) {
      add_flat(T_picture_points * to_eigen(marker_.points[i]), colour_at(marker_, i));
    }
  }

  /// Lines from point i to i + 1, for each `step`-th point i.
  void add_lines(std::size_t step) {
    check_colours(marker_);
    for (std::size_t i = 0; i + 1 < marker_.points.size(); i += step) {
      const Vector3d a = marker_pose_ * to_eigen(marker_.points[i]);
      const Vector3d b = marker_pose_ * to_eigen(marker_.points[i + 1]);
      const Vector3d side = 0.5 * marker_.scale.x * (b - a).cross(axes_.col(2)).stableNormalized();
      add_quad({a - side, a + side, b + side, b - side},
               {colour_at(marker_, i), colour_at(marker_, i + 1)});
    }
  }

  void add_points() {
    check_colours(marker_);
    const Vector3d x = 0.5 * marker_.scale.x * axes_.col(0);
    const Vector3d y = 0.5 * marker_.scale.y * axes_.col(1);
    for (std::size_t i = 0; i < marker_.points.size(); ++i) {
      const Vector3d p = marker_pose_ * to_eigen(marker_.points[i]);
      const Colour colour = colour_at(marker_, i);
      add_quad({p - x - y, p + x - y, p + x + y, p - x + y}, {colour, colour});
    }
  }

  void add_arrow() {
    const Vector3d scale = to_eigen(marker_.scale);
    if (marker_.points.empty()) {
      const ArrowSize unit{1.0 - kArrowHead, 1.0, kArrowHead, kArrowHeadWidth};
      return add_scaled(arrow(unit));
    }
    if (marker_.points.size() != 2) {
      throw MarkerError(concatenate("it has ", marker_.points.size(), " points; must be 0 or 2"));
    }
    const Vector3d start = to_eigen(marker_.points[0]);
    const Vector3d along = to_eigen(marker_.points[1]) - start;
    const double length = along.norm();
    if (length == 0.0) return;
    const double head = scale.z() == 0.0 ? kArrowHead * length : std::clamp(scale.z(), 0.0, length);
    const Affine3d T_marker_arrow =
        Eigen::Translation3d(start) *
        Affine3d(Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitX(), along));
    add_solid(arrow({length - head, scale.x(), head, scale.y()}), T_marker_arrow,
              colour_of(marker_.color));
  }

  void add_text(const Font& font) {
    const Vector3d centre = marker_pose_.translation();
    const auto at = [&](double x, double y) -> Vector3d {
      return centre + marker_.scale.z * (x * axes_.col(0) + y * axes_.col(1));
    };
    for (const TextRectangle& part : font.write(marker_.text)) {
      Colour colour = colour_of(marker_.color);
      colour.w() *= part.opacity;
      add_quad({at(part.left, part.bottom), at(part.right, part.bottom), at(part.right, part.top),
                at(part.left, part.top)},
               {colour, colour});
    }
  }

 private:
  static void turn_inside_out(TrianglePoints& points) {
    for (std::size_t i = 0; i + 2 < points.size(); i += 3) std::swap(points[i + 1], points[i + 2]);
  }

  void add_flat(const Vector3d& position, const Colour& colour) {
    picture_.push_back({position, Vector3d::Zero(), colour});
  }

  /// `colours`: of the first two and of the last two corners.
  void add_quad(const std::array<Vector3d, 4>& corners, const std::array<Colour, 2>& colours) {
    for (const int i : {0, 1, 2, 0, 2, 3}) add_flat(corners[i], colours[i / 2]);
  }

  const Marker& marker_;
  Affine3d marker_pose_;  ///< in the picture's frame
  const Eigen::Matrix3d& axes_;
  PictureTriangles& picture_;
};

}  // namespace

void MarkerPicture::add(const Marker& marker, const Eigen::Isometry3d& T_picture_header,
                        PictureTriangles& picture) {
  check_finite(marker);
  PictureTriangles added;
  Drawing drawing(marker, Affine3d(T_picture_header * pose_of(marker)), axes_, added);
  switch (marker.type) {
    case Marker::ARROW:
      drawing.add_arrow();
      break;
    case Marker::CUBE:
      drawing.add_scaled(unit_cube());
      break;
    case Marker::SPHERE:
      drawing.add_scaled(unit_sphere());
      break;
    case Marker::CYLINDER:
      drawing.add_scaled(unit_cylinder());
      break;
    case Marker::LINE_STRIP:
      drawing.add_lines(1);
      break;
    case Marker::LINE_LIST:
      check_groups(marker, 2);
      drawing.add_lines(2);
      break;
    case Marker::CUBE_LIST:
      drawing.add_solids(unit_cube());
      break;
    case Marker::SPHERE_LIST:
      drawing.add_solids(unit_sphere());
      break;
    case Marker::POINTS:
      drawing.add_points();
      break;
    case Marker::TEXT_VIEW_FACING:
      drawing.add_text(font());
      break;
    case Marker::MESH_RESOURCE:
      drawing.add_scaled(mesh(marker.mesh_resource));
      break;
    case Marker::TRIANGLE_LIST:
      drawing.add_triangle_list();
      break;
    default:
      throw MarkerError("its type " + std::to_string(marker.type) + " is unknown");
  }
  picture.insert(picture.end(), added.begin(), added.end());
}

const TrianglePoints& MarkerPicture::mesh(const std::string& resource) {
  const auto known = meshes_.find(resource);
  if (known != meshes_.end()) return known->second;
  try {
    const MeshDescription file = read_mesh_file(resource, Vector3d::Ones(), Affine3d::Identity());
    TrianglePoints points;
    for (const FaceIndices& face : file.triangles) {
      for (const std::uint32_t corner : face) points.push_back(file.vertices[corner]);
    }
    return meshes_.emplace(resource, std::move(points)).first->second;
  } catch (const ToolError& error) {
    throw MarkerError(error.what());
  }
}

const Font& MarkerPicture::font() {
  try {
    if (!loaded_font_) loaded_font_.emplace(font_);
  } catch (const FontError& error) {
    throw MarkerError(error.what());
  }
  return *loaded_font_;
}

}  // namespace organ_collision
