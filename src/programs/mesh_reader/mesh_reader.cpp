#include "mesh_reader.hpp"

#include <assimp/config.h>
#include <assimp/scene.h>

#include <Eigen/Geometry>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <boost/algorithm/string/case_conv.hpp>
#include <boost/algorithm/string/predicate.hpp>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <new>

#include "geometry/concatenate.hpp"
#include "mesh_formats.hpp"

namespace organ_collision {
namespace {

using Eigen::Affine3d;

/// Hides all files that a mesh file names, such as its materials. They are not needed, and reading
/// them is a risk: they may be FIFOs, for example.
class NoOtherFiles : public Assimp::IOSystem {
 public:
  bool Exists(const char* /*file*/) const override { return false; }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* /*file*/, const char* /*mode*/) override { return nullptr; }
  void Close(Assimp::IOStream* /*stream*/) override {}
};

void add(const aiMesh& part, const Affine3d& T_file_part, MeshBuilder& mesh) {
  std::vector<double> numbers, corners;
  for (unsigned i = 0; i < part.mNumVertices; ++i) {
    const aiVector3D& v = part.mVertices[i];
    const Eigen::Vector3d place = T_file_part * Eigen::Vector3d(v.x, v.y, v.z);
    numbers.push_back(mesh.join_vertex({place.x(), place.y(), place.z()}));
  }
  for (unsigned i = 0; i < part.mNumFaces; ++i) {
    const aiFace& face = part.mFaces[i];
    if (face.mNumIndices < 3) continue;
    corners.clear();
    for (unsigned k = 0; k < face.mNumIndices; ++k) {
      // Not all importers of assimp check what they read.
      const bool is_legal = face.mIndices[k] < numbers.size();
      corners.push_back(is_legal ? numbers[face.mIndices[k]] : -1.0);
    }
    mesh.add_polygon(corners);
  }
}

void add(const aiNode& node, const aiScene& scene, const Affine3d& T_file_parent,
         MeshBuilder& mesh) {
  using RowMajor = Eigen::Matrix<ai_real, 4, 4, Eigen::RowMajor>;
  const Affine3d T_parent_node(Eigen::Map<const RowMajor>(&node.mTransformation.a1).cast<double>());
  const Affine3d T_file_node = T_file_parent * T_parent_node;
  for (unsigned i = 0; i < node.mNumMeshes; ++i)
    add(*scene.mMeshes[node.mMeshes[i]], T_file_node, mesh);
  for (unsigned i = 0; i < node.mNumChildren; ++i)
    add(*node.mChildren[i], scene, T_file_node, mesh);
}

void read_with_assimp(MeshText& text, const std::string& content, const std::string& ending,
                      MeshBuilder& mesh) {
  Assimp::Importer importer;
  importer.SetIOHandler(
      std::make_unique<NoOtherFiles>().release());  // The importer becomes the owner.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  // Otherwise, assimp would add triangles that depict the skeleton to a file without triangles.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
  const aiScene* const scene =
      importer.ReadFileFromMemory(content.data(), content.size(), 0, ending.c_str());
  if (!scene) {
    const std::string error = importer.GetErrorString();
    const bool is_out_of_memory = error == std::bad_alloc().what();
    throw text.error(is_out_of_memory ? "there is not enough memory to read it" : error);
  }
  add(*scene->mRootNode, *scene, Affine3d::Identity(), mesh);
}

/// How to make a file that is read here of a VTK file.
std::string conversion_of_vtk(const std::string& file) {
  const bool is_url = boost::contains(file, "://");
  const std::filesystem::path path = is_url ? "FILE.vtk" : file;
  std::filesystem::path ply = path;
  ply.replace_extension(".ply");
  return concatenate("VTK's files are read by Python alone; 'rosrun organ_collision own_mesh.py ",
                     path, " --ply ", ply, "' makes a PLY file of it");
}

}  // namespace

std::string read_file(const std::string& path) {
  namespace fs = std::filesystem;
  const auto refuse = [&](const std::string& why) { throw InputError(path + ": " + why); };
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (error == std::errc::no_such_file_or_directory) refuse("there is no such file");
  if (error) refuse(error.message());
  if (fs::is_directory(status)) refuse("it is a folder");
  if (!fs::is_regular_file(status)) {
    refuse("it is a FIFO, device or socket; must be a regular file");
  }
  const auto size = static_cast<std::size_t>(fs::file_size(path));
  if (size == 0) refuse("it is empty");
  if (size > kMostFileBytes) {
    refuse(concatenate("it has ", size, " bytes; at most ", kMostFileBytes, " are read"));
  }
  std::string content(size, '\0');
  std::ifstream file(path, std::ios::binary);
  if (!file.read(content.data(), static_cast<std::streamsize>(size))) refuse(std::strerror(errno));
  return content;
}

MeshFile parse_mesh(const std::string& file, const std::string& content) {
  std::string ending = std::filesystem::path(file).extension();
  boost::to_lower(ending);
  const bool is_obj = ending == ".obj";
  MeshText text(file, content, is_obj || ending == ".off" ? '#' : '\n', is_obj);
  if (boost::starts_with(content, "version https://git-lfs.github.com/spec/")) {
    throw text.error("it is only a pointer of Git LFS; fetch the file itself by 'git lfs pull'");
  }
  MeshBuilder mesh(text, is_obj ? 1 : 0);
  if (is_obj) {
    read_obj(text, mesh);
  } else if (ending == ".stl") {
    read_stl(text, content, mesh);
  } else if (ending == ".ply") {
    read_ply(text, mesh);
  } else if (ending == ".off") {
    read_off(text, mesh);
  } else if (ending == ".vtk" || ending == ".vtp" || ending == ".vtu") {
    throw text.error(conversion_of_vtk(file), 0);
  } else {
    read_with_assimp(text, content, ending.empty() ? ending : ending.substr(1), mesh);
  }
  return mesh.finish();
}

MeshFile read_mesh(const std::string& path) { return parse_mesh(path, read_file(path)); }

}  // namespace organ_collision
