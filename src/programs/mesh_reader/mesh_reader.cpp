#include "mesh_reader.hpp"

#include <assimp/config.h>
#include <assimp/scene.h>

#include <Eigen/Geometry>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <boost/algorithm/string/case_conv.hpp>
#include <boost/algorithm/string/predicate.hpp>
#include <cerrno>
#include <cstdio>
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

/// Writes the surface in the VTK file on standard input to standard output as a PLY file, or why it
/// cannot. It must not have single quotes. Cells of three dimensions have no surface.
constexpr char kVtkScript[] = R"(
import sys
def refuse(why):
    print("refused: " + why)
    sys.exit(1)
try:
    import numpy
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOLegacy import vtkGenericDataObjectReader as vtk
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader as vtp, vtkXMLUnstructuredGridReader as vtu
except ImportError:
    refuse("needs VTK: install the package python3-vtk9")
reader, errors = {"vtk": vtk, "vtp": vtp, "vtu": vtu}[sys.argv[1]](), []
def heard(source, event, text): errors.append(" ".join(text.split()))
heard.CallDataType = "string0"
for source in (reader, reader.GetExecutive()): source.AddObserver("ErrorEvent", heard)
reader.SetFileName("/dev/stdin")
reader.Update()
data = reader.GetOutputDataObject(0)
if errors or not data or not data.IsA("vtkPointSet") or not data.GetPoints():
    refuse("VTK cannot read it: " + (errors or ["it has no points, or is no polygonal mesh"])[0].split("): ", 1)[-1])
def cells(array): return [vtk_to_numpy(part) for part in (array.GetOffsetsArray(), array.GetConnectivityArray())]
def triangles(strip): return [strip[[i, i + 1 + i % 2, i + 2 - i % 2]] for i in range(len(strip) - 2)]
def split(at, ids): return numpy.split(ids, at[1:-1])
if data.IsA("vtkPolyData"):
    at, ids = cells(data.GetPolys())
    strips = [face for strip in split(*cells(data.GetStrips())) for face in triangles(strip)]
    sizes, ids = numpy.append(numpy.diff(at), numpy.full(len(strips), 3)), numpy.concatenate([ids, *strips])
else:
    (at, ids), kinds = cells(data.GetCells()), vtk_to_numpy(data.GetCellTypesArray())
    third = at[:-1][kinds == 8] + 2  # Pixels have their last two corners in the other order.
    ids[third], ids[third + 1] = ids[third + 1], ids[third]
    if (kinds == 6).any():
        faces = [face for kind, cell in zip(kinds, split(at, ids)) for face in (triangles(cell) if kind == 6 else [cell])]
        kinds = numpy.concatenate([[5] * (len(cell) - 2) if kind == 6 else [kind] for kind, cell in zip(kinds, split(at, ids))])
        at, ids = numpy.cumsum([0, *map(len, faces)]), numpy.concatenate(faces)
    sizes, is_face = numpy.diff(at), numpy.isin(kinds, (5, 7, 8, 9))
    ids, sizes = ids[numpy.repeat(is_face, sizes)], sizes[is_face]
points = vtk_to_numpy(data.GetPoints().GetData()).astype("<f8")
print("ply\nformat binary_little_endian 1.0\nelement vertex", len(points), "\nproperty double x\nproperty double y\nproperty double z"
      "\nelement face", len(sizes), "\nproperty list int int vertex_indices\nend_header", flush=True)
sys.stdout.buffer.write(points.tobytes())
sys.stdout.buffer.write(numpy.insert(ids, numpy.cumsum(sizes) - sizes, sizes).astype("<i4").tobytes())
)";

/// The surface in a VTK file as a PLY file. VTK reads it in a process of its own, because a broken
/// file may end it.
std::string ply_of_vtk(const MeshText& text, const std::string& content,
                       const std::string& ending) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> input(std::tmpfile(), std::fclose);
  if (!input) throw text.error(concatenate("there is no temporary file: ", std::strerror(errno)));
  std::fwrite(content.data(), 1, content.size(), input.get());
  std::rewind(input.get());
  // The limits of processor time [s] and memory [KiB] are those of robot_reader.
  const std::string command =
      concatenate("ulimit -t 10; ulimit -v 2097152; exec /usr/bin/python3 -c '", kVtkScript, "' ",
                  ending, " <&", fileno(input.get()), " 2>/dev/null");
  std::FILE* const output = popen(command.c_str(), "r");
  if (!output) throw text.error(concatenate("python3 cannot run: ", std::strerror(errno)));
  std::string ply;
  char piece[4096];
  for (std::size_t size = 0; (size = std::fread(piece, 1, sizeof piece, output)) > 0;) {
    ply.append(piece, size);
  }
  const int status = pclose(output);
  if (status == 0 && boost::starts_with(ply, "ply\n")) return ply;
  const std::string refused = "refused: ";
  if (!boost::starts_with(ply, refused)) throw text.error("VTK crashes at it");
  throw text.error(ply.substr(refused.size(), ply.find('\n') - refused.size()));
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
    const std::string ply = ply_of_vtk(text, content, ending.substr(1));
    MeshText ply_text(file, ply);
    read_ply(ply_text, mesh);
  } else {
    read_with_assimp(text, content, ending.empty() ? ending : ending.substr(1), mesh);
  }
  return mesh.finish();
}

MeshFile read_mesh(const std::string& path) { return parse_mesh(path, read_file(path)); }

}  // namespace organ_collision
