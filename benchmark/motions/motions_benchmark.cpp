#include <time.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <functional>
#include <iostream>
#include <limits>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "benchmark/cases/timing.hpp"
#include "benchmark/engines/fcl_tool.hpp"
#include "benchmark/scenes/tool_motions.hpp"
#include "query/make_request.hpp"

namespace organ_collision::bench {

/// What is compared: engines that tell which faces of an organ at rest a motion touches. All trees
/// are built once.
class MotionEngines {
 public:
  /// Answers one motion and returns the number of faces.
  using Ask = std::function<std::size_t(const ToolPath&)>;

  MotionEngines(const OrganSurface& organ, const MotionSet& motions);

  /// What one thread asks `engine`:
  /// - "static" and "swept": CollisionQuery, all contacts with their full geometry;
  /// - "static_cpu": the same as "static", but without OpenGL;
  /// - "fcl": FCL's static query, the faces with FCL's contacts;
  /// - "fcl_touches": FCL's static query, which ends at the first face; 1 if there is one.
  /// Throws std::invalid_argument for any other.
  Ask asker(const std::string& engine) const;

  /// How far FCL's answers are from this package's, in static queries of the first `count` motions.
  struct Comparison {
    std::size_t faces = 0;          ///< that this package finds
    std::size_t missed_by_fcl = 0;  ///< of these, not in FCL's answer
    std::size_t only_by_fcl = 0;
  };
  Comparison compare(std::size_t count) const;

 private:
  Ask own_asker(QueryMode mode, PickerKind picker) const;
  CollisionRequest request(const ToolPath& path, QueryMode mode) const;

  const MotionSet& motions_;
  TriangleMesh organ_;
  FclTool fcl_;
};

namespace {

struct Answers {
  explicit Answers(PickerKind picker) : query(picker) {}

  CollisionQuery query;
  CollisionResult result;
};

}  // namespace

MotionEngines::MotionEngines(const OrganSurface& organ, const MotionSet& motions)
    : motions_(motions),
      organ_(organ.vertices, organ.triangles),
      fcl_(organ, motions.radius, motions.links) {}

MotionEngines::Ask MotionEngines::asker(const std::string& engine) const {
  if (engine == "fcl_touches") {
    return [this](const ToolPath& path) -> std::size_t { return fcl_.touches(path.back()); };
  }
  if (engine == "fcl") {
    return [this, faces = std::vector<std::uint32_t>()](const ToolPath& path) mutable {
      fcl_.query(path.back(), faces);
      return faces.size();
    };
  }
  if (engine == "static") return own_asker(QueryMode::kStatic, PickerKind::kFeedback);
  if (engine == "static_cpu") return own_asker(QueryMode::kStatic, PickerKind::kCpu);
  if (engine == "swept") return own_asker(QueryMode::kSwept, PickerKind::kFeedback);
  throw std::invalid_argument("the engine is '" + engine +
                              "'; legal are static, static_cpu, swept, fcl and fcl_touches");
}

MotionEngines::Ask MotionEngines::own_asker(QueryMode mode, PickerKind picker) const {
  return [this, mode, answers = std::make_shared<Answers>(picker)](const ToolPath& path) {
    answers->query.evaluate(request(path, mode), answers->result);
    return answers->result.contacts.size();
  };
}

MotionEngines::Comparison MotionEngines::compare(std::size_t count) const {
  CollisionQuery query;
  CollisionResult result;
  std::vector<std::uint32_t> fcl;
  Comparison comparison;
  for (std::size_t i = 0; i < std::min(count, motions_.paths.size()); ++i) {
    query.evaluate(request(motions_.paths[i], QueryMode::kStatic), result);
    std::vector<std::uint32_t> ours;
    for (const FaceContact& contact : result.contacts) ours.push_back(contact.face);
    ours.erase(std::unique(ours.begin(), ours.end()), ours.end());
    fcl_.query(motions_.paths[i].back(), fcl);
    std::vector<std::uint32_t> both;
    std::set_intersection(ours.begin(), ours.end(), fcl.begin(), fcl.end(),
                          std::back_inserter(both));
    comparison.faces += ours.size();
    comparison.missed_by_fcl += ours.size() - both.size();
    comparison.only_by_fcl += fcl.size() - both.size();
  }
  return comparison;
}

CollisionRequest MotionEngines::request(const ToolPath& path, QueryMode mode) const {
  const std::vector<Link>* const links = motions_.links.empty() ? nullptr : &motions_.links;
  return make_request({&organ_}, {motions_.radius, links}, {mode}, path);
}

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

/// An OBJ file.
void write_surface(const std::string& path, const std::vector<Eigen::Vector3d>& vertices,
                   const std::vector<FaceIndices>& faces) {
  File file(path);
  for (const Eigen::Vector3d& vertex : vertices) {
    file.stream() << "v " << vertex.x() << ' ' << vertex.y() << ' ' << vertex.z() << '\n';
  }
  for (const FaceIndices& face : faces) {
    file.stream() << "f " << face[0] + 1 << ' ' << face[1] + 1 << ' ' << face[2] + 1 << '\n';
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
      write_surface(path, part.surface->vertices(), part.surface->faces());
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

/// Writes into `folder` what query_offline and the node need for the same motions: organ.obj;
/// without links, `count` motions in static.csv and swept.csv, the motions of the set again and
/// again; with links, the URDF robot.urdf and the meshes of the links. Throws std::runtime_error if
/// a file cannot be written.
void write_files(const std::string& folder, const OrganSurface& organ, const MotionSet& motions,
                 std::size_t count) {
  const TriangleMesh mesh(organ.vertices, organ.triangles);
  std::vector<Eigen::Vector3d> vertices;
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i) vertices.push_back(mesh.vertex(i));
  write_surface(folder + "/organ.obj", vertices, mesh.faces());
  if (!motions.links.empty()) return write_robot(folder, motions.links);
  write_motions(folder + "/static.csv", "static", motions, count);
  write_motions(folder + "/swept.csv", "swept", motions, count);
}

}  // namespace organ_collision::bench

namespace {

using namespace organ_collision::bench;

constexpr std::size_t kMotions = 1000;
constexpr std::size_t kCompared = 100;

/// [s] The time for which the calling thread has had a processor.
double thread_time() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Threads that ask one engine about the motions in turn.
class Askers {
 public:
  Askers(const MotionEngines& engines, const MotionSet& motions, const std::string& engine,
         std::size_t threads)
      : motions_(motions), asks_(threads) {
    for (MotionEngines::Ask& ask : asks_) ask = engines.asker(engine);
  }

  /// Asks for some seconds. Prints the motions a second, and the processor time of a motion, which
  /// other programs disturb less.
  void run(double seconds) {
    Stopwatch watch;
    std::vector<std::thread> threads;
    for (MotionEngines::Ask& ask : asks_) {
      threads.emplace_back([&] { work(ask, seconds); });
    }
    for (std::thread& thread : threads) thread.join();
    const double passed = watch.lap();
    std::cout << "{\"motions_per_second\": " << static_cast<double>(answered_) / passed
              << ", \"processor_seconds\": " << processor_time_ / static_cast<double>(answered_)
              << ", \"faces\": " << static_cast<double>(faces_) / static_cast<double>(answered_)
              << "}" << std::endl;
  }

 private:
  void work(const MotionEngines::Ask& ask, double seconds) {
    Stopwatch watch;
    double passed = 0.0;
    std::size_t answered = 0, faces = 0;
    for (; passed < seconds; passed += watch.lap(), ++answered) {
      faces += ask(motions_.paths[next_++ % motions_.paths.size()]);
    }
    processor_time_ = processor_time_ + thread_time();
    answered_ += answered;
    faces_ += faces;
  }

  const MotionSet& motions_;
  std::vector<MotionEngines::Ask> asks_;
  std::atomic<double> processor_time_ = 0.0;
  std::atomic<std::size_t> next_ = 0, answered_ = 0, faces_ = 0;
};

void obey(const std::string& line, const OrganSurface& organ, const MotionSet& motions,
          const MotionEngines& engines) {
  std::istringstream words(line);
  std::string what, folder;
  std::size_t count = 0;
  double seconds = 0.0;
  words >> what;
  if (what == "compare") {
    const MotionEngines::Comparison comparison = engines.compare(kCompared);
    std::cout << "{\"faces\": " << comparison.faces
              << ", \"missed_by_fcl\": " << comparison.missed_by_fcl
              << ", \"only_by_fcl\": " << comparison.only_by_fcl << "}" << std::endl;
  } else if (what == "write" && words >> count >> folder) {
    write_files(folder, organ, motions, count);
    std::cout << "{}" << std::endl;
  } else if (words >> count >> seconds) {
    Askers(engines, motions, what, count).run(seconds);
  } else {
    throw std::runtime_error("what is '" + line + "'?");
  }
}

}  // namespace

// motions_benchmark FACES shaft|grasper
// Reads what to measure from standard input and prints a line of JSON for each line that it reads:
//   compare                    how far FCL's answers are from this package's
//   ENGINE THREADS SECONDS     motions a second; an engine is one of MotionEngines::asker()
//   write COUNT FOLDER         {}; the files of write_files()
int main(int argc, char** argv) {
  if (argc != 3) return std::cerr << "motions_benchmark FACES shaft|grasper" << std::endl, 2;
  try {
    const OrganSurface organ = make_organ(std::strtoul(argv[1], nullptr, 10));
    const MotionSet motions = motions_of(argv[2], organ, kMotions);
    const MotionEngines engines(organ, motions);
    for (std::string line; std::getline(std::cin, line);) obey(line, organ, motions, engines);
  } catch (const std::exception& error) {
    std::cerr << "motions_benchmark: " << error.what() << std::endl;
    return 1;
  }
}
