#include "motion_files.hpp"

#include <fstream>
#include <limits>
#include <stdexcept>
#include <vector>

namespace organ_collision::bench {
namespace {

class File {
 public:
  explicit File(const std::string& path) : path_(path), stream_(path) {
    stream_.precision(std::numeric_limits<double>::max_digits10);
  }
  std::ofstream& stream() { return stream_; }
  void close() {
    stream_.close();
    if (!stream_) throw std::runtime_error(path_ + " cannot be written");
  }

 private:
  std::string path_;
  std::ofstream stream_;
};

void write_organ(const std::string& path, const OrganSurface& organ) {
  File file(path);
  for (std::size_t i = 0; i < organ.vertices.size(); i += 3) {
    file.stream() << "v " << organ.vertices[i] << ' ' << organ.vertices[i + 1] << ' '
                  << organ.vertices[i + 2] << '\n';
  }
  for (std::size_t i = 0; i < organ.triangles.size(); i += 3) {
    file.stream() << "f " << organ.triangles[i] + 1 << ' ' << organ.triangles[i + 1] + 1 << ' '
                  << organ.triangles[i + 2] + 1 << '\n';
  }
  file.close();
}

void write_motions(const std::string& path, const char* mode, const MotionSet& motions,
                   std::size_t count) {
  File file(path);
  const auto write_point = [&](const Eigen::Vector3d& point) {
    file.stream() << ',' << point.x() << ',' << point.y() << ',' << point.z();
  };
  for (std::size_t i = 0; i < count; ++i) {
    const ToolPath& path_of_tool = motions.paths[i % motions.paths.size()];
    file.stream() << i << ',' << mode;
    write_point(path_of_tool.back().axis.trocar);
    write_point(path_of_tool.front().axis.tip);
    write_point(path_of_tool.back().axis.tip);
    file.stream() << ',' << motions.radius << '\n';
  }
  file.close();
}

void write_surface(const std::string& path, const ToolSurface& surface) {
  File file(path);
  for (const Eigen::Vector3d& vertex : surface.vertices()) {
    file.stream() << "v " << vertex.x() << ' ' << vertex.y() << ' ' << vertex.z() << '\n';
  }
  for (const FaceIndices& face : surface.faces()) {
    file.stream() << "f " << face[0] + 1 << ' ' << face[1] + 1 << ' ' << face[2] + 1 << '\n';
  }
  file.close();
}

/// The links of the Grasper: each has one part, either a mesh or a cylinder along z.
void write_robot(const std::string& folder, const std::vector<Link>& links) {
  File file(folder + "/robot.urdf");
  file.stream() << "<robot name=\"robot\">\n<link name=\"base\"/>\n";
  for (const Link& link : links) {
    const LinkPart& part = link.parts.front();
    file.stream() << "<joint name=\"" << link.name << "_joint\" type=\"floating\"><parent link=\""
                  << "base\"/><child link=\"" << link.name << "\"/></joint>\n<link name=\""
                  << link.name << "\"><collision>";
    if (part.surface) {
      const std::string path = folder + "/" + link.name + ".obj";
      write_surface(path, *part.surface);
      file.stream() << "<geometry><mesh filename=\"file://" << path << "\"/></geometry>";
    } else {
      const OrientedBox& box = part.bounds;
      file.stream() << "<origin xyz=\"0 0 " << box.center.z() << "\"/><geometry><cylinder radius=\""
                    << box.half_size.x() << "\" length=\"" << 2.0 * box.half_size.z()
                    << "\"/></geometry>";
    }
    file.stream() << "</collision></link>\n";
  }
  file.stream() << "</robot>\n";
  file.close();
}

}  // namespace

void write_files(const std::string& folder, const OrganSurface& organ, const MotionSet& motions,
                 std::size_t count) {
  write_organ(folder + "/organ.obj", organ);
  if (!motions.links.empty()) return write_robot(folder, motions.links);
  write_motions(folder + "/static.csv", "static", motions, count);
  write_motions(folder + "/swept.csv", "swept", motions, count);
}

}  // namespace organ_collision::bench
