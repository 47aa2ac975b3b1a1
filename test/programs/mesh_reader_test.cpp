// What mesh files give: vertices and faces in the order of the file, or a refusal that names the
// file, the line and the fault. test/python/mesh_files_test.py has whole files, and all programs.
#include "programs/mesh_reader/mesh_reader.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <random>

#include "temporary_files.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using FaceNumbers = std::vector<std::uint32_t>;

/// The end of the message that refuses a file with this content.
std::string mesh_refusal(const std::string& file, const std::string& content) {
  const std::string message = input_error([&] { parse_mesh(file, content); });
  EXPECT_EQ(message.find(file + ":"), 0U) << message;
  return message.substr(std::min(message.size(), file.size() + 1));
}

const std::string kFiveVertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0.5\nv -1 0.25 2\n";

TEST(ObjFile, has_the_vertices_and_faces_in_the_order_of_the_file) {
  const MeshFile mesh =
      parse_mesh("a.OBJ",
                 "\xEF\xBB\xBF# f 1 2 3 \\\nmtllib a.mtl\nvt 0 0\nvn 0 0 1\nv 0.1 -0.2 1e-50 1\r\n"
                 "\tv\t1.00000001  1e0 0 \nusemtl f\n\nv 0 1 0.3 0.5 0.5 0.5\rv 3 \\\r\n3 2\nv "
                 "4 \\\n 4 4\n"
                 "l 1 2\nf 2 3 4 5 1\nf 1 2 3\r\nend\n");
  EXPECT_EQ(mesh.vertices,
            (std::vector<double>{0.1, -0.2, 1e-50, 1.00000001, 1, 0, 0, 1, 0.3, 3, 3, 2, 4, 4, 4}));
  EXPECT_EQ(mesh.triangles.size(), 12U);
  EXPECT_EQ(FaceNumbers(mesh.triangles.end() - 3, mesh.triangles.end()), (FaceNumbers{0, 1, 2}));
}

TEST(ObjFile, has_corners_of_every_form) {
  for (const char* face : {"f 1/4 2/5 3/6\n", "f 1//4 2//5 3//6\n", "f 1/4/7 2/5/8 3/6/9\n",
                           "f -5 -4 -3\n", "f -5/-1/-1 \\\n2 -3//-1  # a comment\n"}) {
    EXPECT_EQ(parse_mesh("a.obj", kFiveVertices + face).triangles, (FaceNumbers{0, 1, 2})) << face;
  }
  EXPECT_EQ(parse_mesh("a.obj", "f 1 2 3\n" + kFiveVertices).triangles, (FaceNumbers{0, 1, 2}));
  // Negative numbers are counted from the last vertex so far.
  EXPECT_EQ(
      parse_mesh("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 0 0 1\nf -3 -2 -1\n").triangles,
      (FaceNumbers{0, 1, 2, 1, 2, 3}));
}

TEST(ObjFile, is_refused_with_the_line_and_what_is_legal) {
  const std::string numbers = "; legal are numbers from 1, or from -1 to -5 counted back";
  std::vector<std::pair<std::string, std::string>> rows = {
      {"v 0 1\n", "1: the line has 3 words; must have more"},
      {"\nv 0 a 1\n", "2: \"a\" is no number"},
      {"v 0 1 nan\n", "1: a coordinate is nan; must be finite and within 1e6"},
      {"v 0 -1e39 0\n", "1: a coordinate is -1e+39; must be finite and within 1e6"},
      {kFiveVertices + "f 1 2\n", "6: a face with 2 corners; must have at least 3"},
      {kFiveVertices + "f 1 2 3\nf 1 2 6\nf 1 2 3\n",
       "7: a face refers to vertex 6; the file has 5, counted from 1"},
      {kFiveVertices + "f 0 1 2\n", "6: a face refers to vertex 0" + numbers},
      {kFiveVertices + "f 1 2 -6\n", "6: a face refers to vertex -6" + numbers},
      {kFiveVertices,
       " has no triangles or polygons; a volume mesh needs its surface extracted first"},
      {"version https://git-lfs.github.com/spec/v1\n",
       " it is only a pointer of Git LFS; fetch the file itself by 'git lfs pull'"}};
  for (const std::string corner : {"x", "1.5", "/1", "2x/1", "99999999999999999999"}) {
    rows.emplace_back(kFiveVertices + "f 1 2 " + corner + "\n",
                      "6: corner \"" + corner + "\" does not begin with the number of a vertex");
  }
  for (const auto& [content, why] : rows) EXPECT_EQ(mesh_refusal("a.obj", content), why);
}

std::string ply_text(const std::string& encoding, const std::string& elements,
                     const std::string& body) {
  return "ply\nformat " + encoding + " 1.0\ncomment a b\n" + elements + "end_header\n" + body;
}

const std::string kXyz = "property float x\nproperty float y\nproperty float z\n";
const std::string kList = "property list uchar int vertex_index\n";

TEST(PlyFile, has_numbers_of_every_type) {
  for (const auto& [type, size] : {std::pair{"char", 1},
                                   {"int8", 1},
                                   {"uchar", 1},
                                   {"uint8", 1},
                                   {"short", 2},
                                   {"int16", 2},
                                   {"ushort", 2},
                                   {"uint16", 2},
                                   {"int", 4},
                                   {"int32", 4},
                                   {"uint", 4},
                                   {"uint32", 4},
                                   {"int64", 8},
                                   {"uint64", 8}}) {
    for (const bool is_big : {false, true}) {
      std::string body;
      const auto add = [&, size = size](int number) {
        std::string bytes(static_cast<std::size_t>(size), number < 0 ? '\xff' : '\0');
        bytes[is_big ? bytes.size() - 1 : 0] = static_cast<char>(number);
        body += bytes;
      };
      for (const int number : {0, 0, 7, 0, 1, 0, 2, 0, 3, 3, 0, 1, 2}) add(number);
      const std::string name = type;
      const std::string elements = "element vertex 3\nproperty " + name + " y\nproperty " + name +
                                   " x\nproperty " + name + " q\nelement face 1\nproperty list " +
                                   name + " " + name + " vertex_indices\n";
      // Rows of y, x, q; z is absent, so it is 0.
      const MeshFile mesh = parse_mesh(
          "a.ply", ply_text(is_big ? "binary_big_endian" : "binary_little_endian", elements, body));
      EXPECT_EQ(mesh.vertices, (std::vector<double>{0, 0, 0, 1, 0, 0, 0, 2, 0})) << type;
      EXPECT_EQ(mesh.triangles, (FaceNumbers{0, 1, 2})) << type;
    }
  }
}

TEST(PlyFile, is_refused_with_what_is_wrong) {
  const std::string elements = "element vertex 3\n" + kXyz + "element face 1\n" + kList;
  const std::string vertices = "0 0 0\n1 0 0\n0 1 0\n";
  const std::pair<std::string, std::string> rows[] = {
      {"", " a PLY file begins with ply"},
      {"ply\nformat ascii 1.0\n", " its header has no line end_header; the file may be cut off"},
      {"ply\nformat what\n",
       "2: the format is \"what\"; legal are ascii, "
       "binary_little_endian and binary_big_endian"},
      {"ply\nproperty half x\n", "2: \"property\" is no line of a PLY header"},
      {"ply\nelement vertex 1\nproperty half x\n", "3: \"half\" is no type of a number"},
      {ply_text("ascii", elements, vertices + "3 0 1 99\n"),
       "14: a face refers to vertex 99; the file has 3, counted from 0"},
      {ply_text("ascii", elements, vertices + "3 0 1 -1\n"),
       "14: a face refers to vertex -1; must be a whole number from 0"},
      {ply_text("ascii", elements, vertices + "3 0 1 2 5\n"),
       "14: the line has 5 words; must have 4"},
      {ply_text("ascii", elements, vertices + "100000000 0 1 2\n"),
       "14: the line has 4 words; must have more"},
      {ply_text("ascii", elements, "0 0 0\n"),
       "11: the file ends before it has 3 of the element \"vertex\"; it may be cut off"},
      {ply_text("binary_big_endian", elements, std::string(36, '\0') + "\3"),
       " the file ends before it has 1 of the element \"face\"; it may be cut off"}};
  for (const auto& [content, why] : rows) {
    EXPECT_EQ(mesh_refusal("a.ply", content), why);
  }
}

TEST(OffFile, may_have_colours_and_normals) {
  const std::string body = "0 0 0 255 0 0\n1 0 0 # a comment\n\n0 0.1 0\n3 0 1 2 255 0 0\n";
  for (const std::string begin :
       {"OFF 3 1 0\n", "COFF\n# comment\n3 1 3\n", "3 1 0\n", "NOFF\r3 1\r"}) {
    const MeshFile mesh = parse_mesh("a.off", begin + body);
    EXPECT_EQ(mesh.vertices, (std::vector<double>{0, 0, 0, 1, 0, 0, 0, 0.1, 0}));
    EXPECT_EQ(mesh.triangles, (FaceNumbers{0, 1, 2}));
  }
  for (const std::string begin : {"OFF BINARY\n", "4OFF\n3 1 0\n", "nOFF\n", "mesh\n"}) {
    EXPECT_EQ(mesh_refusal("a.off", begin),
              "1: an OFF file begins with OFF, COFF or NOFF, and is a text");
  }
  EXPECT_EQ(mesh_refusal("a.off", "OFF 3 2 0\n" + body),
            "6: the file ends before it has 2 of the element \"face\"; it may be cut off");
}

/// The area of a simple polygon, counterclockwise, by the formula of Gauss.
double area_of(const std::vector<Vector2d>& polygon) {
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return twice / 2.0;
}

/// Reads a polygon as an OBJ file, in a plane, from any first corner and in both directions. The
/// triangles have the polygon's area, and none is turned over: so they cover the polygon and
/// nothing else.
void expect_covered(const std::vector<Vector2d>& polygon, bool is_convex) {
  for (const Eigen::Quaterniond& turn :
       {Eigen::Quaterniond::Identity(), Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0),
        Eigen::Quaterniond(0.5, 0.5, 0.5, 0.5),
        Eigen::Quaterniond(0.4, -0.7, 0.1, 0.3).normalized()}) {
    for (std::size_t first = 0; first < polygon.size(); first += 1 + polygon.size() / 8) {
      std::string vertices, face = "f";
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vector2d& corner = polygon[(first + i) % polygon.size()];
        const Vector3d place = turn * Vector3d(corner.x(), corner.y(), 0.25);
        char line[100];
        std::snprintf(line, sizeof line, "v %.17g %.17g %.17g\n", place.x(), place.y(), place.z());
        vertices += line;
        face += " " + std::to_string(i + 1);
      }
      const MeshFile mesh = parse_mesh("a.obj", vertices + face + "\n");
      ASSERT_EQ(mesh.triangles.size(), 3 * (polygon.size() - 2));
      const Vector3d normal = turn * Vector3d::UnitZ();
      double sum = 0.0;
      for (std::size_t i = 0; i < mesh.triangles.size(); i += 3) {
        const auto place = [&](std::size_t corner) {
          return Vector3d(&mesh.vertices[3 * mesh.triangles[i + corner]]);
        };
        const double twice = (place(1) - place(0)).cross(place(2) - place(0)).dot(normal);
        EXPECT_GT(twice, is_convex ? -1e-15 : 0.0) << vertices;
        sum += twice / 2.0;
        EXPECT_EQ(is_convex && mesh.triangles[i] != 0, false);
      }
      EXPECT_NEAR(sum, area_of(polygon), 1e-12) << vertices;
    }
  }
}

TEST(Polygon, that_is_concave_has_no_faces_in_the_void) {
  expect_covered({{0.1, 0}, {0.1, 0.05}, {0.05, 0.05}, {0.05, 0.1}, {0, 0.1}, {0, 0}}, false);
  expect_covered({{0, 0}, {0.05, 0.015}, {0.1, 0}, {0.05, 0.1}}, false);
  // A comb, with corners on straight lines.
  std::vector<Vector2d> comb = {{0, 0}, {6, 0}, {12, 0}};
  for (int i = 12; i > 0; i -= 2) {
    for (const Vector2d& corner :
         {Vector2d(i, 5), Vector2d(i - 1, 5), Vector2d(i - 1, 1), Vector2d(i - 2, 1)}) {
      comb.push_back(corner);
    }
  }
  expect_covered(comb, false);
  // A square with a square hole, which a line joins with the outline.
  expect_covered({{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}},
                 false);
}

TEST(Polygon, of_any_shape_is_covered) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  for (int trial = 0; trial < 20; ++trial) {
    const int count = 4 + static_cast<int>(share(random) * 30);
    std::vector<Vector2d> star, spiral;
    for (int i = 0; i < count; ++i) {
      const double angle = 2.0 * EIGEN_PI * i / count;
      star.push_back((0.1 + share(random)) * Vector2d(std::cos(angle), std::sin(angle)));
    }
    star.insert(star.begin() + 1, 1e-3 * star[0] + 1e-3 * star[1]);  // It is surely concave.
    expect_covered(star, false);
    // The outer and then, on the way back, the inner line of a spiral of two turns.
    for (int i = 0; i < 2 * count; ++i) {
      const int at = i < count ? i : 2 * count - 1 - i;
      const double angle = 4.0 * EIGEN_PI * at / count,
                   radius = (i < count ? 1.0 : 0.7) + 0.2 * angle;
      spiral.push_back(radius * Vector2d(std::cos(angle), std::sin(angle)));
    }
    if (count >= 20) expect_covered(spiral, false);
  }
}

}  // namespace
}  // namespace organ_collision
