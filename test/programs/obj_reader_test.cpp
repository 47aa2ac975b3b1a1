#include "offline/obj_reader.hpp"

#include <gtest/gtest.h>

#include "temporary_files.hpp"

namespace organ_collision {
namespace {

const std::string kVertices =
    "v 0 0 0\n"
    "v 1 0 0\n"
    "v 1 1 0\n"
    "v 0 1 0.5\n"
    "v -1 0.25 2\n";

ObjFile read(const std::string& content) { return read_obj(TemporaryFile(content).path()); }

std::vector<FaceIndices> faces_of(const ObjFile& obj) { return mesh_of(obj).faces(); }

std::vector<FaceIndices> faces_of(const std::string& face_lines) {
  return faces_of(read(kVertices + face_lines));
}

using Faces = std::vector<FaceIndices>;
using Lines = std::vector<std::size_t>;

TEST(ObjReader, reads_vertices_and_faces_in_the_order_of_the_file) {
  const ObjFile obj = read(kVertices + "f 1 2 3\nf 4 3 2\nf 5 1 2\n");
  EXPECT_EQ(faces_of(obj), (Faces{{0, 1, 2}, {3, 2, 1}, {4, 0, 1}}));
  EXPECT_EQ(obj.face_lines, (Lines{6, 7, 8}));
  EXPECT_EQ(obj.line_count, 8U);
  EXPECT_EQ(obj.vertices,
            (std::vector<float>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0.5F, -1, 0.25F, 2}));
}

TEST(ObjReader, cuts_polygons_into_fans_that_count_as_so_many_faces) {
  const ObjFile obj = read(kVertices + "f 2 3 4 5 1\nf 1 2 3\n");
  EXPECT_EQ(faces_of(obj), (Faces{{1, 2, 3}, {1, 3, 4}, {1, 4, 0}, {0, 1, 2}}));
  EXPECT_EQ(obj.face_lines, (Lines{6, 6, 6, 7}));
}

TEST(ObjReader, takes_every_form_of_a_corner) {
  const Faces expected{{0, 1, 2}};
  EXPECT_EQ(faces_of("f 1/4 2/5 3/6\n"), expected);
  EXPECT_EQ(faces_of("f 1//4 2//5 3//6\n"), expected);
  EXPECT_EQ(faces_of("f 1/4/7 2/5/8 3/6/9\n"), expected);
  EXPECT_EQ(faces_of("f -5 -4 -3\n"), expected);
  EXPECT_EQ(faces_of("f -5/-1/-1 2 -3//-1  # a comment\n"), expected);
  EXPECT_EQ(faces_of(read("f 1 2 3\n" + kVertices)), expected);
  // Negative numbers are counted from the last vertex so far.
  EXPECT_EQ(faces_of(read("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 0 0 1\nf -3 -2 -1\n")),
            (Faces{{0, 1, 2}, {1, 2, 3}}));
}

TEST(ObjReader, ignores_other_lines) {
  const ObjFile obj = read(
      "\xEF\xBB\xBF# f 1 2 3\nmtllib a.mtl\no liver\n\nv 0 0 0 1\r\nvt 0 0\nvn 0 0 1\nv 1 0 0 0.5 "
      "0.5 0.5\n"
      "\tv\t0  1e0 0 \ng f\ns off\nusemtl f\nl 1 2\nvp 1\nf 1 2 3\r\nend\n");
  EXPECT_EQ(faces_of(obj), (Faces{{0, 1, 2}}));
  EXPECT_EQ(obj.vertices, (std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0}));
}

TEST(ObjReader, rounds_vertices_to_32_bits) {
  const ObjFile obj = read("v 0.1 -0.2 1e-50\nv 1.00000001 0 0\nv 0 1 524288.03\nf 1 2 3\n");
  EXPECT_EQ(obj.vertices, (std::vector<float>{0.1F, -0.2F, 0, 1, 0, 0, 0, 1, 524288.03125F}));
}

TEST(ObjReader, refuses_lines_naming_the_value_and_what_is_legal) {
  const std::string range = "; must be finite and within 1e6 m";
  const std::string numbers = "; legal are numbers from 1, or from -1 to -5 counted back";
  const std::string none =
      ": the file ends without an f line; a mesh in OBJ format has at least one";
  std::vector<std::pair<std::string, std::string>> refusals = {
      {"v 0 1\n", ":1: a vertex with 2 coordinates; must have x, y and z"},
      {"\nv 0 a 1\n", ":2: y is \"a\"; must be a number"},
      {"v 0 1 nan\n", ":1: z is \"nan\"" + range},
      {"v inf 1 0\n", ":1: x is \"inf\"" + range},
      {"v 0 -1e39 0\n", ":1: y is \"-1e39\"" + range},
      {"v 0 0 1000001\n", ":1: z is \"1000001\"" + range},
      {kVertices + "f 1 2\n", ":6: a face with 2 corners; must have at least 3"},
      {kVertices + "f 1 2 3\nf 1 2 6\nf 1 2 3\n",
       ":7: a face refers to vertex 6; the file has 5, counted from 1"},
      {kVertices + "f 0 1 2\n", ":6: a face refers to vertex 0" + numbers},
      {kVertices + "f 1 2 -6\n", ":6: a face refers to vertex -6" + numbers},
      {kVertices + "f 1 2 4294967296\n", ":6: a face refers to vertex 4294967296" + numbers},
      {"", ":1" + none},
      {kVertices, ":5" + none},
      {"solid liver\nendsolid\n", ":2" + none}};
  for (const std::string corner : {"x", "1.5", "/1", "2x/1", "99999999999999999999"}) {
    refusals.emplace_back(
        kVertices + "f 1 2 " + corner + "\n",
        ":6: corner \"" + corner + "\" does not begin with the number of a vertex");
  }
  for (const auto& [content, why] : refusals) EXPECT_EQ(refusal_of(content, read_obj), why);
}

TEST(ObjReader, refuses_a_mesh_that_is_too_large) {
  ObjFile obj = read(kVertices + "f 1 2 3\n");
  obj.triangles.resize(3 * (MeshLimits().max_faces + 1));
  EXPECT_EQ(input_error([&] { mesh_of(obj); }),
            obj.file + ": 2000001 faces; at most 2000000 are allowed");
}

TEST(ObjReader, checks_that_another_shape_has_the_same_faces) {
  const TemporaryFile file(kVertices + "f 1 2 3\nf 2 3 4\n");
  const TriangleMesh mesh = mesh_of(read_obj(file.path()));
  const auto refusal = [&](const std::string& content) {
    return refusal_of(content, [&](const std::string& other) {
      check_same_faces(read_obj(other), mesh, file.path());
    });
  };
  EXPECT_NO_THROW(check_same_faces(read("v 9 9 9\nv 9 9 8\nv 9 7 9\nv 6 9 9\nv 5 9 9\n"
                                        "f 1//1 -4 -3\nf 2 3 4\n"),
                                   mesh, file.path()));
  EXPECT_EQ(refusal(kVertices + "f 1 2 3\nf 2 4 3\n"),
            ":7: face 1 has the vertices 2 4 3; in " + file.path() + " they are 2 3 4");
  EXPECT_EQ(refusal(kVertices + "f 1 2 3\n"), ":6: the file ends with 5 vertices and 1 faces; " +
                                                  file.path() + " has 5 vertices and 2 faces");
  EXPECT_EQ(refusal(kVertices + "v 0 0 0\nf 1 2 3\nf 2 3 4\n"),
            ":8: the file ends with 6 vertices and 2 faces; " + file.path() +
                " has 5 vertices and 2 faces");
}

}  // namespace
}  // namespace organ_collision
