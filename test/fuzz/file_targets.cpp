// Files that users write: mesh files, and the CSV files with motions of query_offline.
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "common/program/user_input.hpp"
#include "fuzz_input.hpp"
#include "programs/mesh_reader/mesh_reader.hpp"
#include "programs/query_offline/motions.hpp"

using namespace organ_collision;

namespace {

/// [motions] Of an input that are answered.
constexpr int kMostMotions = 10;

/// The path of a file with this content, which exists only in memory, and until the next call.
std::string memory_file(const std::string& content) {
  static const int descriptor = memfd_create("fuzz_input", MFD_CLOEXEC);
  demand(ftruncate(descriptor, 0) == 0, "the file is empty");
  demand(
      pwrite(descriptor, content.data(), content.size(), 0) == static_cast<ssize_t>(content.size()),
      "the file is written");
  return "/proc/self/fd/" + std::to_string(descriptor);
}

void answer(const Motion& motion) {
  static const TriangleMesh organ({-1, -1, 0, 1, -1, 0.1f, 1, 1, 0, -1, 1, 0.2f},
                                  {0, 1, 2, 0, 2, 3});
  static CollisionQuery query(PickerKind::kFeedback);
  CollisionResult result;
  query.evaluate(request_of(motion, {&organ}), result);
  for (const FaceContact& contact : result.contacts) {
    demand(contact.face < 2, "a contact's face exists");
  }
}

const FuzzTarget motion_file_target("motion_file", [](const std::uint8_t* data, std::size_t size) {
  const std::string path = memory_file(FuzzInput(data, size).rest());
  try {
    Motions motions(path);
    demand(motions.count() > 0, "a legal file has a motion");
    for (int i = 0; i < kMostMotions; ++i) {
      const std::optional<Motion> motion = motions.next();
      if (!motion) break;
      answer(*motion);
    }
  } catch (const InputError&) {
  }
});

/// Those formats of mesh files that this package reads itself.
const FuzzTarget mesh_file_target("mesh_file", [](const std::uint8_t* data, std::size_t size) {
  FuzzInput input(data, size);
  const std::string file = std::array{"a.obj", "a.stl", "a.ply", "a.off"}[input.byte() % 4];
  try {
    const MeshFile mesh = parse_mesh(file, input.rest());
    demand(mesh.triangles.size() % 3 == 0 && !mesh.triangles.empty(), "a mesh has faces");
    for (const std::uint32_t vertex : mesh.triangles) {
      demand(3 * std::size_t{vertex} < mesh.vertices.size(), "a face's vertices exist");
    }
  } catch (const InputError& error) {
    demand(std::string(error.what()).find(file + ":") == 0, "an error names the file");
  }
});

}  // namespace
