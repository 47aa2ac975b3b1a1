#pragma once

#include <Eigen/Core>
#include <array>
#include <boost/functional/hash.hpp>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "mesh_text.hpp"

namespace organ_collision {

/// The surface in a mesh file, in the units and axes of the file.
struct MeshFile {
  std::vector<double> vertices;          ///< x y z x y z ...; finite, within 1e6
  std::vector<std::uint32_t> triangles;  ///< three vertex indices for each face, all legal
};

/// Collects the vertices and polygons of a mesh file in their order. All errors are InputErrors
/// that name the file and, in a text, the line.
class MeshBuilder {
 public:
  using Point = std::array<double, 3>;

  /// `text`: names the file and the line in errors. `first`: the number that the format gives to
  /// the first vertex, for errors.
  explicit MeshBuilder(const MeshText& text, int first = 0) : text_(text), first_(first) {}

  void add_vertex(const Point& point);
  /// Adds a vertex if there is none at this place yet. Returns its number.
  double join_vertex(Point point);
  /// `corners`: numbers of vertices from 0. The vertices may be added later.
  void add_polygon(const std::vector<double>& corners);
  std::size_t vertex_count() const { return mesh_.vertices.size() / 3; }

  /// The mesh. A polygon of k corners becomes k - 2 faces. A convex polygon becomes the fan around
  /// its first corner. In a concave one, no face reaches into the void, and all faces are turned as
  /// the polygon is.
  MeshFile finish();

 private:
  void cut(const std::uint32_t* corners, std::size_t count);
  void add_face(std::uint32_t a, std::uint32_t b, std::uint32_t c);
  std::vector<Eigen::Vector2d> seen_from_above(const std::uint32_t* corners,
                                               std::size_t count) const;

  const MeshText& text_;
  int first_;
  MeshFile mesh_;
  std::unordered_map<Point, std::uint32_t, boost::hash<Point>> known_;  ///< of join_vertex()
  std::vector<std::uint32_t> corners_;                                  ///< of all polygons
  std::vector<std::size_t> ends_;  ///< the places in corners_ behind each polygon
  std::uint32_t largest_ = 0;      ///< the largest number in corners_
  std::size_t line_of_largest_ = 0;
};

}  // namespace organ_collision
