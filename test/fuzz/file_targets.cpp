// Files and buffers: mesh files and the CSV files with motions of query_offline, the yaml files
// with parameters of replay and of all nodes, and OpenGL's feedback buffer.
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "common/messages/robot_reply.hpp"
#include "common/program/user_input.hpp"
#include "fuzz_input.hpp"
#include "haptics/haptic_proxy_parameters.hpp"
#include "picking/gl/drawing.hpp"
#include "programs/mesh_reader/mesh_reader.hpp"
#include "programs/query_offline/motions.hpp"
#include "programs/replay/yaml_parameters.hpp"

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

const FuzzTarget feedback_target("feedback", [](const std::uint8_t* data, std::size_t size) {
  FuzzInput input(data, size);
  // As GL: at most as many as the buffer has.
  const std::size_t spare = input.byte() % 16;
  std::vector<float> buffer;
  while (!input.empty()) buffer.push_back(input.number<float>());
  const std::size_t written = buffer.size() - std::min(spare, buffer.size());
  buffer.shrink_to_fit();
  std::size_t vertices = 0;
  double sum = 0.0;
  try {
    for_each_vertex(buffer, written, [&](std::uint32_t face, double depth) {
      sum += depth + face;
      ++vertices;
    });
  } catch (const GlError&) {
  }
  demand(vertices * kVertexFloats <= written, "each vertex is within the buffer");
  try {
    std::size_t corners = 0;
    for (const FacePart& part : read_parts(buffer, written)) corners += part.size();
    demand(corners * kVertexFloats <= written, "each corner is within the buffer");
  } catch (const GlError&) {
  }
});

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

/// Loads parameters. A refusal says what is wrong.
template <typename Load>
void load(const Load& load) {
  try {
    load();
  } catch (const ParameterError& error) {
    demand(*error.what() != '\0', "a refusal has a text");
  } catch (const ToolError&) {
  }
}

void check(const NodeParameters& parameters) {
  demand(parameters.max_faces > 0 && parameters.motion_samples_max > 0, "limits are positive");
  for (const ToolParameters& tool : parameters.tools) {
    demand(!tool.name.empty() && (tool.has_shaft() || !tool.links.empty()), "tools are whole");
    demand(!tool.has_shaft() || tool.radius > 0.0, "radii are positive");
  }
}

/// The file is a tree of values of any types, as the parameter server may hold it for any node.
void load_all(const YamlParameters& file) {
  const XmlRpc::XmlRpcValue& all = file.group();
  load([&] {
    NodeParameters parameters = file.node_parameters();
    check(parameters);
    table_of(parameters).change(all);
    for (const ToolParameters& tool : parameters.tools) file.find_text(tool.robot_description);
  });
  load([&] {
    auto parameters = parse_parameters<HapticProxyParameters>(all);
    demand(parameters.max_force > 0.0, "the largest force is positive");
    for (const ToolParameters& tool : parameters.tools) proxy_settings(parameters, tool);
    table_of(parameters).change(all);
  });
}

const FuzzTarget parameters_target("parameters", [](const std::uint8_t* data, std::size_t size) {
  const std::string path = memory_file(FuzzInput(data, size).rest());
  try {
    load_all(YamlParameters(path, "/organ_collision"));
  } catch (const InputError&) {
  }
});

}  // namespace
