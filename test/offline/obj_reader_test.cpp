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
}

TEST(ObjReader, takes_a_byte_order_mark) {
  const std::string text = kVertices + "f 1 2 3\n";
  const ObjFile marked = read("\xEF\xBB\xBF" + text), plain = read(text);
  EXPECT_EQ(marked.vertices, plain.vertices);
  EXPECT_EQ(faces_of(marked), faces_of(plain));
}

TEST(ObjReader, counts_negative_indices_from_the_last_vertex_so_far) {
  const ObjFile obj = read("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 0 0 1\nf -3 -2 -1\n");
  EXPECT_EQ(faces_of(obj), (Faces{{0, 1, 2}, {1, 2, 3}}));
}

TEST(ObjReader, takes_faces_before_their_vertices) {
  EXPECT_EQ(faces_of(read("f 1 2 3\n" + kVertices)), (Faces{{0, 1, 2}}));
}

TEST(ObjReader, ignores_other_lines) {
  const ObjFile obj = read(
      "# f 1 2 3\nmtllib a.mtl\no liver\n\nv 0 0 0 1\r\nvt 0 0\nvn 0 0 1\nv 1 0 0 0.5 0.5 0.5\n"
      "\tv\t0  1e0 0 \ng f\ns off\nusemtl f\nl 1 2\nvp 1\nf 1 2 3\r\nend\n");
  EXPECT_EQ(faces_of(obj), (Faces{{0, 1, 2}}));
  EXPECT_EQ(obj.vertices, (std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0}));
}

TEST(ObjReader, rounds_vertices_to_32_bits) {
  const ObjFile obj = read("v 0.1 -0.2 1e-50\nv 1.00000001 0 0\nv 0 1 524288.03\nf 1 2 3\n");
  EXPECT_EQ(obj.vertices, (std::vector<float>{0.1F, -0.2F, 0, 1, 0, 0, 0, 1, 524288.03125F}));
}

TEST(ObjReader, allows_degenerate_faces) {
  EXPECT_EQ(faces_of("f 1 1 2\nf 3 3 3\n"), (Faces{{0, 0, 1}, {2, 2, 2}}));
}

/// The message for a file that is refused, without the file's name at its beginning.
std::string refusal(const std::string& content) {
  const TemporaryFile file(content);
  const std::string message = input_error([&] { read_obj(file.path()); });
  EXPECT_EQ(message.find(file.path()), 0U) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  return message.substr(file.path().size());
}

TEST(ObjReader, refuses_vertices_that_are_no_finite_numbers) {
  EXPECT_EQ(refusal("v 0 1\n"), ":1: a vertex with 2 coordinates; must have x, y and z");
  EXPECT_EQ(refusal("\nv 0 a 1\n"), ":2: y is \"a\"; must be a number");
  const std::string legal = "; must be finite and within 1e6 m";
  EXPECT_EQ(refusal("v 0 1 nan\n"), ":1: z is \"nan\"" + legal);
  EXPECT_EQ(refusal("v inf 1 0\n"), ":1: x is \"inf\"" + legal);
  EXPECT_EQ(refusal("v 0 -1e39 0\n"), ":1: y is \"-1e39\"" + legal);
  EXPECT_EQ(refusal("v 0 0 1000001\n"), ":1: z is \"1000001\"" + legal);
}

TEST(ObjReader, refuses_faces_without_vertices) {
  EXPECT_EQ(refusal(kVertices + "f 1 2\n"), ":6: a face with 2 corners; must have at least 3");
  EXPECT_EQ(refusal(kVertices + "f 1 2 3\nf 1 2 6\nf 1 2 3\n"),
            ":7: a face refers to vertex 6; the file has 5, counted from 1");
  const std::string legal = "; legal are numbers from 1, or from -1 to -5 counted back";
  EXPECT_EQ(refusal(kVertices + "f 0 1 2\n"), ":6: a face refers to vertex 0" + legal);
  EXPECT_EQ(refusal(kVertices + "f 1 2 -6\n"), ":6: a face refers to vertex -6" + legal);
  EXPECT_EQ(refusal(kVertices + "f 1 2 4294967296\n"),
            ":6: a face refers to vertex 4294967296" + legal);
  for (const std::string corner : {"x", "1.5", "/1", "2x/1", "99999999999999999999"}) {
    EXPECT_EQ(refusal(kVertices + "f 1 2 " + corner + "\n"),
              ":6: corner \"" + corner + "\" does not begin with the number of a vertex");
  }
}

TEST(ObjReader, refuses_files_without_faces) {
  const std::string legal =
      ": the file ends without an f line; a mesh in OBJ format has at least one";
  EXPECT_EQ(refusal(""), ":1" + legal);
  EXPECT_EQ(refusal(kVertices), ":5" + legal);
  EXPECT_EQ(refusal("solid liver\nendsolid\n"), ":2" + legal);
}

TEST(ObjReader, makes_a_mesh_of_the_vertices_and_faces) {
  const ObjFile obj = read(kVertices + "f 1 2 3\n");
  const TriangleMesh mesh = mesh_of(obj);
  EXPECT_EQ(mesh.vertices(), obj.vertices);
  EXPECT_TRUE(mesh.has_triangles(obj.triangles));
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
    const TemporaryFile before(content);
    const ObjFile obj = read_obj(before.path());
    return input_error([&] { check_same_faces(obj, mesh, file.path()); })
        .substr(before.path().size());
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
