#include "programs/robot_reader/robot_files.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <tuple>
#include <utility>

#include "common/messages/robot_reply.hpp"
#include "common/program/user_input.hpp"
#include "organ_collision/geometry/triangle.hpp"
#include "test/node/tools/tool_files.hpp"

using namespace organ_collision;

namespace {

std::string resource_error(const std::string& name) {
  return refusal_by<InputError>([&] { read_resource(name); });
}

using Eigen::Vector3d;

const Vector3d kUnit = Vector3d::Ones();
const Eigen::Isometry3d kAtOrigin = Eigen::Isometry3d::Identity();

}  // namespace

TEST(Resource, RefusalsNameTheFileAndWhy) {
  const std::pair<std::string, std::vector<std::string>> rows[] = {
      {"/no/such.stl", {"/no/such.stl", "no such file"}},
      {"file:///no/such.stl", {"/no/such.stl", "no such file"}},
      {"/etc/passwd/such.stl", {"Not a directory"}},
      {tool_file("such.stl"), {"/test/data/tools/such.stl", "no such file"}},
      {"package://no_such_package/jaw.stl", {"no_such_package", "not exist"}},
      {"package://organ_collision", {"no file in the package"}},
      {"file://server/jaw.stl", {"'file://server/jaw.stl'", "absolute path"}},
      {"http://192.0.2.1/jaw.stl", {"absolute path", "package:// or file://"}},
      {"meshes/jaw.stl", {"'meshes/jaw.stl'", "absolute path", "package://"}},
      {"", {"''", "absolute path", "package://"}},
      {"/tmp", {"/tmp", "folder"}},
      {"/dev/zero", {"/dev/zero", "device", "regular file"}}};
  for (const auto& [name, words] : rows) expect_words(resource_error(name), words);
}

namespace {

std::vector<Triangle> read_triangles(const std::string& name, const Vector3d& scale = kUnit,
                                     const Eigen::Isometry3d& T_link_mesh = kAtOrigin) {
  const RobotShape mesh = read_mesh_file(tool_file(name), scale, T_link_mesh);
  EXPECT_EQ(mesh.file, tool_file(name));
  std::vector<Triangle> triangles(mesh.triangles.size() / 3);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    triangles[i / 3][i % 3] = Vector3d(&mesh.vertices.at(3 * mesh.triangles[i]));
  }
  return triangles;
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
void expect_triangles(const std::vector<Triangle>& surface, const std::vector<Triangle>& triangles,
                      const std::function<Vector3d(const Vector3d&)>& place) {
  EXPECT_EQ(surface.size(), triangles.size());
  for (const Triangle& triangle : triangles) {
    const Triangle placed = {place(triangle[0]), place(triangle[1]), place(triangle[2])};
    const auto found = std::count_if(surface.begin(), surface.end(),
                                     [&](const Triangle& other) { return is_same(other, placed); });
    EXPECT_EQ(found, 1) << placed[0].transpose() << ", " << placed[1].transpose() << ", "
                        << placed[2].transpose();
  }
}

}  // namespace

TEST(MeshFile, DaeWithItsNodesAndUnitButNotItsUpAxis) {
  // Turned by 90 degrees about z, then moved by (10, 20, 30), all in millimetres.
  const auto place = [](const Vector3d& v) {
    return Vector3d(0.010 - 0.001 * v.y(), 0.020 + 0.001 * v.x(), 0.030 + 0.001 * v.z());
  };
  // The first triangle, and the two halves of the quadrilateral.
  const std::vector<Triangle> triangles = {{kA, kC, kB}, {kA, kB, kC}, {kA, kC, kD}};
  for (const std::string name : {"jaw.dae", "jaw_z_up.dae"}) {
    expect_triangles(read_triangles(name), triangles, place);
  }
}

TEST(MeshFile, ScaledOrMirroredThenPlacedInTheLink) {
  Eigen::Isometry3d T_link_mesh(Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitX()));
  T_link_mesh.translation() << 0.1, 0.2, 0.3;
  expect_triangles(read_triangles("jaw_ascii.stl", {0.001, -0.002, 0.003}, T_link_mesh), kJaw,
                   [](const Vector3d& v) {
                     return Vector3d(0.1 + 0.001 * v.x(), 0.2 - 0.003 * v.z(), 0.3 - 0.002 * v.y());
                   });
}

TEST(MeshFile, RefusalsNameTheFileAndWhy) {
  const std::tuple<std::string, Vector3d, std::string> rows[] = {
      {"jaw.obj", {1.0, 0.0, 1.0}, "its scale is 1 0 1; must be finite, and not 0 along any axis"},
      {"jaw.obj", {1.0, 1.0, std::nan("")}, "1   1 nan; must be finite"},
      {"broken.dae", kUnit, ""},
      {"nodes_only.dae", kUnit, "no triangles"},
      {"notes.txt", kUnit, "No suitable reader"}};
  for (const auto& [name, scale, words] : rows) {
    expect_words(tool_error([&, &name = name, &scale = scale] { read_triangles(name, scale); }),
                 {"/test/data/tools/" + name, words});
  }
}
