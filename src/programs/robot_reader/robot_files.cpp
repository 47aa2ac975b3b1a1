#include "robot_files.hpp"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <ros/package.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/time.h>

#include <algorithm>
#include <array>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <boost/algorithm/string/predicate.hpp>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <new>
#include <string_view>
#include <system_error>
#include <utility>

#include "common/messages/robot_reply.hpp"
#include "geometry/concatenate.hpp"

namespace organ_collision {
namespace {

using Eigen::Affine3d;
using Eigen::Vector3d;

/// Lowers a limit of the process. A limit that is already lower stays as it is.
template <typename Resource>
void limit(Resource resource, rlim_t value) {
  rlimit limits{};
  if (getrlimit(resource, &limits) == 0) {
    limits.rlim_cur = std::min(limits.rlim_cur, value);
    if (setrlimit(resource, &limits) == 0) return;
  }
  throw std::system_error(errno, std::generic_category(), "setrlimit");
}

const std::string kPackage = "package://";
const std::string kFile = "file://";

[[noreturn]] void refuse(const std::string& name, const std::string& why) {
  throw ToolError("cannot read '" + name + "': " + why);
}

/// The content of a regular file. Follows symbolic links. Throws ToolError.
std::string read_file(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (error == std::errc::no_such_file_or_directory) refuse(path, "there is no such file");
  if (error) refuse(path, error.message());
  if (fs::is_directory(status)) refuse(path, "it is a folder");
  if (!fs::is_regular_file(status)) {
    refuse(path, "it is a FIFO, device or socket; must be a regular file");
  }
  const auto size = static_cast<std::size_t>(fs::file_size(path));
  if (size == 0) refuse(path, "it is empty");
  if (size > reader_limits::kFileBytes) {
    refuse(path, concatenate("it has ", size, " bytes; at most ", reader_limits::kFileBytes,
                             " are read"));
  }
  std::string content(size, '\0');
  std::ifstream file(path, std::ios::binary);
  if (!file.read(content.data(), static_cast<std::streamsize>(size))) {
    refuse(path, std::strerror(errno));
  }
  return content;
}

/// Replaces the escapes of a URL, such as %41 by A. A % that is not followed by two hexadecimal
/// digits stays, and so does %00.
std::string decoded(const std::string& url) {
  std::string text;
  for (std::size_t i = 0; i < url.size(); ++i) {
    const bool is_escape = url[i] == '%' && i + 2 < url.size() &&
                           std::isxdigit(static_cast<unsigned char>(url[i + 1])) != 0 &&
                           std::isxdigit(static_cast<unsigned char>(url[i + 2])) != 0;
    const int byte = is_escape ? std::stoi(url.substr(i + 1, 2), nullptr, 16) : 0;
    text += byte == 0 ? url[i] : static_cast<char>(byte);
    if (byte != 0) i += 2;
  }
  return text;
}

std::string path_in_package(const std::string& url) {
  const std::size_t slash = url.find('/', kPackage.size());
  if (slash == std::string::npos) refuse(url, "names no file in the package");
  const std::string package = url.substr(kPackage.size(), slash - kPackage.size());
  const std::string folder = ros::package::getPath(package);
  if (folder.empty()) {
    refuse(url, "package '" + package + "' does not exist, or is not in ROS_PACKAGE_PATH");
  }
  return folder + decoded(url.substr(slash));
}

std::string path_of_url(const std::string& url) {
  const std::string path = url.substr(kFile.size());
  if (path.empty() || path[0] != '/') refuse(url, "must be file:// and an absolute path");
  return decoded(path);
}

/// Collects triangles. Corners at the same position become one vertex, because STL files repeat the
/// position of each corner.
class TriangleCollector {
 public:
  void add(const aiNode& node, const aiScene& scene, const Affine3d& T_link_parent) {
    const aiMatrix4x4& T_parent_node = node.mTransformation;
    using RowMajor = Eigen::Matrix<ai_real, 4, 4, Eigen::RowMajor>;
    const Affine3d T_link_node =
        T_link_parent * Affine3d(Eigen::Map<const RowMajor>(&T_parent_node.a1).cast<double>());
    for (unsigned i = 0; i < node.mNumMeshes; ++i)
      add(*scene.mMeshes[node.mMeshes[i]], T_link_node);
    for (unsigned i = 0; i < node.mNumChildren; ++i) add(*node.mChildren[i], scene, T_link_node);
  }

  RobotShape mesh() && { return std::move(mesh_); }

 private:
  void add(const aiMesh& mesh, const Affine3d& T_link_mesh) {
    for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
      const aiFace& face = mesh.mFaces[i];
      if (face.mNumIndices != 3) continue;
      for (unsigned j = 0; j < 3; ++j) {
        const aiVector3D& v = mesh.mVertices[face.mIndices[j]];
        mesh_.triangles.push_back(vertex(T_link_mesh * Vector3d(v.x, v.y, v.z)));
      }
    }
  }

  std::uint32_t vertex(const Vector3d& position) {
    if (!position.allFinite()) throw ToolError("has a vertex that is not finite");
    const auto [known, is_new] =
        index_of_.insert({{position.x(), position.y(), position.z()},
                          static_cast<std::uint32_t>(mesh_.vertices.size() / 3)});
    if (is_new) {
      mesh_.vertices.insert(mesh_.vertices.end(), position.data(), position.data() + 3);
    }
    return known->second;
  }

  RobotShape mesh_;
  std::map<std::array<double, 3>, std::uint32_t> index_of_;
};

/// Hides all files that a mesh file names, such as its materials. They are not needed, and reading
/// them is a risk: they may be FIFOs, for example.
class NoOtherFiles : public Assimp::IOSystem {
 public:
  bool Exists(const char* /*file*/) const override { return false; }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* /*file*/, const char* /*mode*/) override { return nullptr; }
  void Close(Assimp::IOStream* /*stream*/) override {}
};

/// The extension of a file name, without its dot. assimp recognises the format by it.
std::string extension(const std::string& file) {
  const std::string dotted = std::filesystem::path(file).extension();
  return dotted.empty() ? dotted : dotted.substr(1);
}

/// Whether one line of the text, other than the first, is this word. Blanks may follow it.
bool has_line(const std::string& text, const std::string& word) {
  const auto ends_line = [](char character) { return character == '\n' || character == '\r'; };
  for (std::size_t at = text.find(word, 1); at != std::string::npos; at = text.find(word, at + 1)) {
    const std::size_t end = text.find_first_not_of(" \t", at + word.size());
    if (ends_line(text[at - 1]) && end != std::string::npos && ends_line(text[end])) return true;
  }
  return false;
}

/// Removes a UTF-8 byte order mark, with which assimp would lose the first line of an OBJ file. It
/// stays in an STL file, because the header of the binary form may be any bytes.
void remove_byte_order_mark(const std::string& file, std::string& content) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  if (boost::iequals(extension(file), "stl") || !boost::starts_with(content, kMark)) return;
  content.erase(0, kMark.size());
}

/// Whether assimp reads the file as PLY. The first line may also be in capitals.
bool is_ply(const std::string& content) { return boost::istarts_with(content, "ply"); }

/// Refuses a PLY file whose header has no end, as in a truncated file: assimp never stops reading
/// it.
void check_ply_header(const std::string& content) {
  if (is_ply(content) && !has_line(content, "end_header")) {
    throw ToolError("its header has no line end_header; the file may be cut off");
  }
}

/// Checks the vertex indices and the number of triangles. The post-processing of assimp relies on
/// them, but not all of its importers check them. In a PLY file, each triangle takes at least a
/// byte: the index of one more corner. assimp gives each face as many corners as the file claims,
/// even if the file ends before them.
void check_faces(const aiScene& scene, const std::string& content) {
  std::size_t triangles = 0;
  for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
    const aiMesh& mesh = *scene.mMeshes[i];
    for (unsigned j = 0; j < mesh.mNumFaces; ++j) {
      const aiFace& face = mesh.mFaces[j];
      triangles += std::max(face.mNumIndices, 2u) - 2;
      for (unsigned k = 0; k < face.mNumIndices; ++k) {
        if (face.mIndices[k] < mesh.mNumVertices) continue;
        throw ToolError(
            concatenate("face ", j, " names vertex ", face.mIndices[k], " of ", mesh.mNumVertices));
      }
    }
  }
  if (!is_ply(content)) return;
  if (triangles <= content.size()) return;
  throw ToolError(concatenate("its faces claim to be ", triangles, " triangles, but it has only ",
                              content.size(), " bytes; the file may be damaged"));
}

/// Why the importer failed. If memory ran out, its error is only the text of std::bad_alloc.
std::string reason(const Assimp::Importer& importer) {
  const std::string error = importer.GetErrorString();
  return error == std::bad_alloc().what() ? "there is not enough memory to read it" : error;
}

RobotShape parse(const std::string& file, const std::string& content, const Affine3d& T_link_mesh) {
  Assimp::Importer importer;
  importer.SetIOHandler(
      std::make_unique<NoOtherFiles>().release());  // The importer becomes the owner.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  // Otherwise, assimp would add triangles that depict the skeleton to a file without triangles.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
  const aiScene* scene =
      importer.ReadFileFromMemory(content.data(), content.size(), 0, extension(file).c_str());
  if (scene) {
    check_faces(*scene, content);
    scene = importer.ApplyPostProcessing(aiProcess_Triangulate);
  }
  if (!scene) throw ToolError(reason(importer));
  TriangleCollector triangles;
  triangles.add(*scene->mRootNode, *scene, T_link_mesh);
  return std::move(triangles).mesh();
}

}  // namespace

void limit_process() {
  limit(RLIMIT_CPU, reader_limits::kProcessorTime.count());
#ifndef ORGAN_COLLISION_SANITIZED  // Sanitizers reserve terabytes of address space.
  limit(RLIMIT_AS, reader_limits::kMemoryBytes);
#endif
  // RLIMIT_CORE is not enough: it has no effect where the kernel pipes core dumps to a program.
  prctl(PR_SET_DUMPABLE, 0);
}

ScopedTimeLimit::ScopedTimeLimit(std::size_t bytes) {
  const std::chrono::milliseconds more(bytes / reader_limits::kBytesPerMillisecond);
  const std::chrono::milliseconds time = reader_limits::kParsingTime + more;
  itimerval timer{};
  timer.it_value.tv_sec = time.count() / 1000;
  timer.it_value.tv_usec = time.count() % 1000 * 1000;
  if (setitimer(ITIMER_PROF, &timer, nullptr) == 0) return;
  throw std::system_error(errno, std::generic_category(), "setitimer");
}

ScopedTimeLimit::~ScopedTimeLimit() {
  const itimerval never{};
  setitimer(ITIMER_PROF, &never, nullptr);
}

std::string read_resource(const std::string& name) {
  if (boost::starts_with(name, "/")) return read_file(name);
  if (boost::starts_with(name, kPackage)) return read_file(path_in_package(name));
  if (boost::starts_with(name, kFile)) return read_file(path_of_url(name));
  // URLs of servers are refused: a server that does not answer would delay the start of the node.
  refuse(name, "must be an absolute path, or begin with package:// or file://");
}

RobotShape read_mesh_file(const std::string& file, const Vector3d& scale,
                          const Affine3d& T_link_mesh) {
  std::string content = read_resource(file);
  remove_byte_order_mark(file, content);
  try {
    if (!scale.allFinite() || (scale.array() == 0.0).any()) {
      throw ToolError(concatenate("its scale is ", scale.transpose(),
                                  "; must be finite, and not 0 along any axis"));
    }
    if (boost::starts_with(content, "version https://git-lfs.github.com/spec/")) {
      throw ToolError("it is only a pointer of Git LFS; fetch the file itself by 'git lfs pull'");
    }
    check_ply_header(content);
    const ScopedTimeLimit time_limit(content.size());
    RobotShape shape = parse(file, content, T_link_mesh * Eigen::Scaling(scale));
    shape.kind = RobotShape::MESH;
    shape.file = file;
    return shape;
  } catch (const std::exception& error) {
    throw ToolError("mesh '" + file + "': " + error.what());
  }
}

}  // namespace organ_collision
