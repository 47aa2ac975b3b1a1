// The OBJ files of query_offline.
#include "fuzz_input.hpp"
#include "memory_file.hpp"
#include "offline/obj_reader.hpp"
#include "offline/text_reader.hpp"

using namespace organ_collision;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static MemoryFile file;
  static const TriangleMesh other({0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 2});
  file.write(FuzzInput(data, size).rest());
  try {
    const ObjFile obj = read_obj(file.path());
    demand(obj.face_lines.size() * 3 == obj.triangles.size(), "each face has its line");
    const TriangleMesh mesh = mesh_of(obj);
    check_same_faces(obj, mesh, "itself");
    check_same_faces(obj, other, "another file");
  } catch (const InputError& error) {
    demand(std::string(error.what()).find(':') != std::string::npos, "an error names the file");
  }
  return 0;
}
