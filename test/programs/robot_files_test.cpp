#include "programs/robot_reader/robot_files.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <limits>
#include <utility>

#include "common/messages/robot_reply.hpp"
#include "organ_collision/geometry/tool/tool_surface.hpp"
#include "test/node/tools/tool_files.hpp"

using namespace organ_collision;

namespace {

std::string resource_error(const std::string& name) {
  return tool_error([&] { read_resource(name); });
}

using Eigen::Vector3d;

const Vector3d kUnit = Vector3d::Ones();
const Vector3d kMillimetres = Vector3d::Constant(0.001);
const Eigen::Isometry3d kAtOrigin = Eigen::Isometry3d::Identity();

}  // namespace

TEST(Resource, ReadsPathsAndUrls) {
  const std::string path = ORGAN_COLLISION_TEST_DATA "/tools/notes.txt";
  EXPECT_EQ(read_resource(path), "This is no mesh.\n");
  EXPECT_EQ(read_resource("file://" + path), "This is no mesh.\n");
  EXPECT_EQ(read_resource(tool_file("notes.txt")), "This is no mesh.\n");
}

TEST(Resource, RefusalsNameTheFileAndWhy) {
  const std::pair<std::string, std::vector<std::string>> rows[] = {
      {"/no/such.stl", {"'/no/such.stl'", "no such file"}},
      {"file:///no/such.stl", {"'/no/such.stl'", "no such file"}},
      {"/etc/passwd/such.stl", {"Not a directory"}},
      {tool_file("such.stl"), {"/test/data/tools/such.stl", "no such file"}},
      {"package://no_such_package/jaw.stl", {"no_such_package", "not exist"}},
      {"package://organ_collision", {"no file in the package"}},
      {"file://server/jaw.stl", {"'file://server/jaw.stl'", "absolute path"}},
      {"http://192.0.2.1/jaw.stl", {"absolute path", "package:// or file://"}},
      {"meshes/jaw.stl", {"'meshes/jaw.stl'", "absolute path", "package://"}},
      {"", {"''", "absolute path", "package://"}},
      {"/tmp", {"'/tmp'", "folder"}},
      {"/dev/zero", {"'/dev/zero'", "device", "regular file"}}};
  for (const auto& [name, words] : rows) expect_words(resource_error(name), words);
}

TEST(Resource, EscapesInUrlsAreBytes) {
  const std::string path = testing::TempDir() + "a 100% b%00.stl";
  std::ofstream(path) << "mesh";
  EXPECT_EQ(read_resource(path), "mesh");
  EXPECT_EQ(read_resource("file://" + testing::TempDir() + "a%20100% %62%00.stl"), "mesh");
  std::remove(path.c_str());
}

TEST(Resource, WhatIsNoRegularFileIsRefused) {
  const std::string path = testing::TempDir() + "file.stl", link = testing::TempDir() + "link.stl";
  ASSERT_EQ(symlink(path.c_str(), link.c_str()), 0);
  const auto expect_refused = [&](const std::vector<std::string>& words) {
    expect_words(resource_error(path), words);
    expect_words(resource_error(link), words);
    std::remove(path.c_str());
  };
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);  // Opening it would block forever.
  expect_refused({"FIFO", "regular file"});

  std::ofstream(path).flush();
  expect_refused({"empty"});

  std::ofstream(path).flush();
  ASSERT_EQ(truncate(path.c_str(), reader_limits::kFileBytes + 1), 0);
  expect_refused({"100000001 bytes", "at most 100000000"});

  ASSERT_EQ(symlink(link.c_str(), path.c_str()), 0);
  expect_refused({"symbolic links"});
  std::remove(link.c_str());
}

namespace {

ToolSurface read_file(const std::string& name, const Vector3d& scale = kUnit,
                      const Eigen::Isometry3d& T_link_mesh = kAtOrigin) {
  const RobotShape mesh = read_mesh_file(tool_file(name), scale, T_link_mesh);
  EXPECT_EQ(mesh.file, tool_file(name));
  std::vector<Vector3d> vertices;
  std::vector<FaceIndices> triangles;
  for (std::size_t i = 0; i < mesh.vertices.size(); i += 3) {
    vertices.emplace_back(&mesh.vertices[i]);
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 3) {
    triangles.push_back({mesh.triangles[i], mesh.triangles[i + 1], mesh.triangles[i + 2]});
  }
  return {std::move(vertices), std::move(triangles)};
}

/// The corners of the tetrahedron in the mesh files, in the units of the files.
const Vector3d kA(1, 2, 3), kB(9, 2, 4), kC(3, 8, 3.5), kD(2, 3, 10);
const std::vector<Triangle> kJaw = {{kA, kC, kB}, {kA, kB, kD}, {kB, kC, kD}, {kC, kA, kD}};

/// Whether the corners are the same in the same cyclic order.
bool is_same(const Triangle& a, const Triangle& b) {
  for (std::size_t first = 0; first < 3; ++first) {
    const auto is_near = [&](std::size_t i) { return (a[i] - b[(i + first) % 3]).norm() < 1e-8; };
    if (is_near(0) && is_near(1) && is_near(2)) return true;
  }
  return false;
}

/// Expects exactly these triangles, with their corners mapped by `place`.
void expect_triangles(const ToolSurface& surface, const std::vector<Triangle>& triangles,
                      const std::function<Vector3d(const Vector3d&)>& place) {
  EXPECT_EQ(surface.faces().size(), triangles.size());
  for (const Triangle& triangle : triangles) {
    const Triangle placed = {place(triangle[0]), place(triangle[1]), place(triangle[2])};
    int found = 0;
    for (std::size_t i = 0; i < surface.faces().size(); ++i) {
      if (is_same(surface.triangle(i), placed)) ++found;
    }
    EXPECT_EQ(found, 1) << placed[0].transpose() << ", " << placed[1].transpose() << ", "
                        << placed[2].transpose();
  }
}

std::string file_refusal(const std::string& name, const Vector3d& scale = kUnit) {
  return tool_error([&] { read_file(name, scale); });
}

}  // namespace

TEST(MeshFile, StlAndPlyInBothForms) {
  for (const std::string name :
       {"jaw_ascii.stl", "jaw_binary.stl", "jaw_ascii.ply", "jaw_binary.ply"}) {
    const ToolSurface surface = read_file(name, kMillimetres);
    expect_triangles(surface, kJaw, [](const Vector3d& v) { return Vector3d(0.001 * v); });
    EXPECT_EQ(surface.vertices().size(), 4u) << name;
  }
}

TEST(MeshFile, ObjWithPolygonsButNoLinesAndLoneVertices) {
  std::vector<Triangle> triangles = kJaw;
  triangles.push_back({Vector3d(5, 1, 1), Vector3d(6, 1, 1), Vector3d(6, 2, 1)});
  triangles.push_back({Vector3d(5, 1, 1), Vector3d(6, 2, 1), Vector3d(5, 2, 1)});
  const ToolSurface surface = read_file("jaw.obj");
  expect_triangles(surface, triangles, [](const Vector3d& v) { return v; });
  EXPECT_EQ(surface.vertices().size(), 8u);
}

TEST(MeshFile, DaeWithItsNodesAndUnitButNotItsUpAxis) {
  // Turned by 90 degrees about z, then moved by (10, 20, 30), all in millimetres.
  const auto place = [](const Vector3d& v) {
    return Vector3d(0.010 - 0.001 * v.y(), 0.020 + 0.001 * v.x(), 0.030 + 0.001 * v.z());
  };
  // The first triangle, and the two halves of the quadrilateral.
  const std::vector<Triangle> triangles = {{kA, kC, kB}, {kA, kB, kC}, {kA, kC, kD}};
  for (const std::string name : {"jaw.dae", "jaw_z_up.dae"}) {
    expect_triangles(read_file(name), triangles, place);
  }
}

TEST(MeshFile, ScaledOrMirroredThenPlacedInTheLink) {
  Eigen::Isometry3d T_link_mesh(Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitX()));
  T_link_mesh.translation() << 0.1, 0.2, 0.3;
  expect_triangles(read_file("jaw_ascii.stl", {0.001, -0.002, 0.003}, T_link_mesh), kJaw,
                   [](const Vector3d& v) {
                     return Vector3d(0.1 + 0.001 * v.x(), 0.2 - 0.003 * v.z(), 0.3 - 0.002 * v.y());
                   });
}

TEST(MeshFile, RefusalsNameTheFileAndWhy) {
  struct Row {
    std::string name;
    Vector3d scale;
    std::string words;
  };
  const double infinity = std::numeric_limits<double>::infinity();
  const Row rows[] = {
      {"jaw.obj", {1.0, 0.0, 1.0}, "its scale is 1 0 1; must be finite, and not 0 along any axis"},
      {"jaw.obj", {1.0, 1.0, std::nan("")}, "1   1 nan; must be finite"},
      {"jaw.obj", {-infinity, 1.0, 1.0}, "-inf"},
      {"missing.stl", kUnit, "no such file"},
      {"broken.stl", kUnit, ""},
      {"broken_ascii.stl", kUnit, ""},
      {"broken.dae", kUnit, ""},
      {"notes.txt", kUnit, "No suitable reader"},
      {"not_finite.stl", kUnit, "not finite"},
      // assimp accepts these. Its post-processing would read beyond the vertices of the first one,
      // and it would take ever longer for the triangles of the second one.
      {"wrong_index.ply", kUnit, "100000000 of 3"},
      {"long_face.ply", kUnit, "299999 triangles, but it has only 179 bytes"}};
  for (const Row& row : rows) {
    expect_words(file_refusal(row.name, row.scale), {"/test/data/tools/" + row.name, row.words});
  }
}

TEST(MeshFile, AByteOrderMarkChangesNothing) {
  for (const std::string name :
       {"jaw.obj", "jaw_ascii.stl", "jaw_ascii.ply", "jaw_binary.ply", "jaw.dae"}) {
    std::string text = tool_text(name);
    if (name == "jaw.obj") text.erase(0, text.find("\nv ") + 1);  // A vertex follows the mark.
    const std::string path = testing::TempDir() + "marked_" + name;
    std::ofstream(path, std::ios::binary) << "\xEF\xBB\xBF" << text;
    const RobotShape marked = read_mesh_file(path, kUnit, kAtOrigin);
    const RobotShape plain = read_mesh_file(tool_file(name), kUnit, kAtOrigin);
    EXPECT_EQ(marked.vertices, plain.vertices) << name;
    EXPECT_EQ(marked.triangles, plain.triangles) << name;
    std::remove(path.c_str());
  }
}

TEST(MeshFile, CutOffPlyIsRefused) {
  // assimp would never stop reading it.
  expect_words(file_refusal("cut_off.ply"), {tool_file("cut_off.ply"), "end_header", "cut off"});
  expect_words(file_refusal("endless.ply"), {tool_file("endless.ply"), "end_header"});
  const std::string whole = tool_text("jaw_ascii.ply"), path = testing::TempDir() + "cut_off.ply";
  const std::size_t end = whole.find("end_header");
  std::string joined = whole;
  joined.erase(end + 10, 1);
  std::string in_capitals = whole.substr(0, end);
  in_capitals[1] = 'L';
  for (const std::string& text :
       {whole.substr(0, end + 10), whole.substr(0, end) + "9" + whole.substr(end), joined,
        in_capitals, whole.substr(0, end) + "comment " + whole.substr(end),
        whole.substr(0, end + 10) + "\v" + whole.substr(end + 10)}) {
    std::ofstream(path) << text;
    expect_words(tool_error([&] { read_mesh_file(path, kUnit, kAtOrigin); }), {path, "end_header"});
  }
  std::ofstream(path) << whole.substr(0, end + 10) << " \t" << whole.substr(end + 10);
  EXPECT_EQ(read_mesh_file(path, kUnit, kAtOrigin).triangles.size(), 12U) << "blanks may follow";
  std::remove(path.c_str());
}

TEST(MeshFile, NoSurfaceIsRefused) {
  for (const std::string name : {"points.obj", "nodes_only.dae"}) {
    EXPECT_TRUE(read_mesh_file(tool_file(name), kUnit, kAtOrigin).triangles.empty()) << name;
  }
}

TEST(MeshFile, OtherFilesThatItNamesAreNotRead) {
  // The file names a FIFO as its materials. Opening it would block forever.
  const std::string fifo = testing::TempDir() + "materials.mtl",
                    path = testing::TempDir() + "a.obj";
  ASSERT_EQ(mkfifo(fifo.c_str(), 0600), 0);
  std::ofstream(path) << "mtllib " << fifo << "\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  EXPECT_EQ(read_mesh_file(path, kUnit, kAtOrigin).triangles.size(), 3u);
  std::remove(path.c_str());
  std::remove(fifo.c_str());
}
