#include <algorithm>
#include <boost/program_options/value_semantic.hpp>
#include <cmath>
#include <csignal>
#include <exception>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "common/program/user_input.hpp"
#include "contacts_csv.hpp"
#include "geometry/concatenate.hpp"
#include "geometry/plausible_size.hpp"
#include "motions.hpp"
#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "programs/mesh_reader/mesh_reader.hpp"
#include "query/worker_threads.hpp"

namespace organ_collision {
namespace {

constexpr char kUsage[] =
    R"(Usage: query_offline --mesh FILE [--mesh-before FILE] --motions FILE [OPTIONS]
Options: [--margin METRES] [--clearance] [--placement] [--blank-lines] [--picker NAME]
         [--jobs NUMBER]

Prints the faces that a tool touches, or touched while it moved, as CSV. Needs no ROS master.

  --mesh FILE         the organ in metres: an OBJ, STL, PLY, OFF, DAE or VTK file, or another that
                      assimp reads; vertices are rounded to 32-bit floats
  --motions FILE      CSV file, or - for standard input; one motion in each line:
                      query,mode,trocar_x,trocar_y,trocar_z,previous_x,previous_y,previous_z,
                      tip_x,tip_y,tip_z,radius
                      query: a number or a name, each once
                      mode: static (previous ignored, may be empty), swept, paper_static,
                      paper_swept, paper_naive
                      lengths in metres, in the mesh's frame. A header line may come first. If the
                      trocar moves, where it was stands in three more columns:
                      previous_trocar_x,previous_trocar_y,previous_trocar_z
  --mesh-before FILE  the same faces at the start of the step: swept motions then meet the organ
                      moving linearly from there to --mesh; without it the organ rests
  --jobs NUMBER       threads, 1 to 1024, by default one for each core; the output is the same
  --picker NAME       feedback (default), select or cpu: the same contacts. In the paper's modes,
                      select draws all faces, which is much slower. cpu needs no OpenGL
  --margin METRES     adds the distance between tool and organ, if it is at most this; above 0
  --clearance         adds the distance without a limit; a margin then changes nothing
  --placement         adds on which side of the organ the tool is, and where its axis crosses it
  --blank-lines       a blank line follows the answer to each motion, so that a program that waits
                      for the answer sees its end
  --help              this text

Output: query,face,fraction,depth,point_x,point_y,point_z,normal_x,normal_y,normal_z
sorted by query (integers by value, names as text), then face; with --motions - in the order of the
motions, each as soon as its line has arrived, and a query may come twice. A face's number is its
place among the faces of the mesh file, from 0; a polygon of k corners counts as k - 2 faces: a convex
one as the fan around its first corner, a concave one without faces in the void. In the paper's modes
the columns after face are empty. A motion without contact has no line; with --margin, --clearance or
--placement it has one, in which the columns from face to normal_z are empty. Their columns follow,
the same in all lines of a motion, and empty in the paper's modes.

With --margin or --clearance:
  clearance           known; beyond_margin: no face was found within the margin at the end of the
                      step, and the columns below are empty; upper_bound: the query reached its work
                      limit, and the true distances may be smaller than those below. If it reached
                      this limit and found no face, it says beyond_margin, too: a face may then still
                      be within the margin
  distance            at the end of the step; negative while a shaft touches
  least               the smallest distance during the step; 0 if anything was touched during a swept
                      motion, even if distance is negative
  least_fraction      when that was, from 0 to 1; the first touch if there was one
  nearest_face        the face with the nearest point at the end of the step
  on_organ_x,_y,_z    this point
  on_tool_x,_y,_z     the nearest point of the tool
  clearance_normal_x,_y,_z   unit vector from the tool to the organ
  normal_defined      0 if the axis and the face meet, so that this is the face's normal; else 1

With --placement, at the end of the step:
  tip_side            inside, outside, on_surface (exactly), or unknown: the organ is not closed
  trocar_side         the same for the trocar
  crossings           how often the axis crosses the organ's surface
  crossed_faces       the crossed faces from trocar to tip, separated by blanks
  crossing_directions 1 where the axis enters, against the face's outward normal; -1 where it leaves
  crossing_places     their places on the axis, from 0 at the trocar to 1 at the tip
  length_inside       length of the axis within the organ; empty if a side is unknown

Exit status: 0 done; 2 bad input, with one line on stderr and nothing on stdout; 1 other failures.
With --motions - the motions before a bad line are answered first.
)";

constexpr int kMostJobs = 1024;
/// The most motions of a round for each thread, which bounds the memory.
constexpr std::size_t kMostForEachThread = 512;

struct Options {
  std::string mesh, mesh_before, motions;  ///< files
  QueryOptions asked;                      ///< about each motion, whose mode does not count
  bool blank_lines = false;                ///< whether a blank line follows each answer
  PickerSettings picker;
  std::size_t jobs = thread_count(0);
};

/// Returns none if --help is asked for.
std::optional<Options> parse_options(const std::vector<std::string>& arguments) {
  Options options;
  const auto jobs = [&](int count) {
    if (count < 1 || count > kMostJobs) {
      throw std::invalid_argument(
          concatenate("--jobs is ", count, "; must be from 1 to ", kMostJobs));
    }
    options.jobs = static_cast<std::size_t>(count);
  };
  const auto margin = [&](double metres) {
    if (!std::isfinite(metres) || !(metres > 0.0)) {
      throw std::invalid_argument(
          concatenate("--margin is ", metres, "; must be a finite number above 0, in metres"));
    }
    options.asked.margin = metres;
  };
  const auto picker = [&](const std::string& name) { options.picker.kind = picker_kind(name); };
  const auto gone = [](const char* why) {
    return [why](const std::string&) { throw std::invalid_argument(why); };
  };
  namespace po = boost::program_options;
  po::options_description legal;
  auto add = legal.add_options();
  add("mesh", po::value(&options.mesh)->required());
  add("mesh-before", po::value(&options.mesh_before));
  add("motions", po::value(&options.motions)->required());
  add("jobs", po::value<int>()->notifier(jobs));
  add("picker", po::value<std::string>()->notifier(picker));
  add("margin", po::value<double>()->notifier(margin));
  add("clearance", po::bool_switch(&options.asked.clearance));
  add("placement", po::bool_switch(&options.asked.placement));
  add("blank-lines", po::bool_switch(&options.blank_lines));
  add("shapes", po::value<std::string>()->notifier(
                    gone("--shapes is gone; give each step its --mesh and --mesh-before")));
  add("gl", po::value<std::string>()->notifier(
                gone("--gl is gone; OSMesa is used where there is one, otherwise EGL")));
  if (!read_command_line("query_offline", kUsage, arguments, legal)) return std::nullopt;
  return options;
}

/// The vertices [m], rounded to 32-bit floats.
std::vector<float> vertices_of(const MeshFile& mesh) {
  return {mesh.vertices.begin(), mesh.vertices.end()};
}

/// Throws InputError if the file is not legal, or the mesh too large.
TriangleMesh mesh_of(const std::string& file) {
  try {
    const MeshFile mesh = read_mesh(file);
    return {vertices_of(mesh), mesh.triangles};
  } catch (const MeshError& error) {
    throw InputError(file + ": " + error.what());
  }
}

/// Another shape of `mesh`, which was read from `mesh_file`. Throws InputError, naming the first
/// difference, if the other file does not have the same faces and the same number of vertices.
TriangleMesh shape_of(const std::string& file, TriangleMesh mesh, const std::string& mesh_file) {
  const auto counts = [](std::size_t vertices, std::size_t faces) {
    return concatenate(vertices, " vertices and ", faces, " faces");
  };
  const MeshFile shape = read_mesh(file);
  const std::string found = counts(shape.vertices.size() / 3, shape.triangles.size() / 3);
  const std::string right = counts(mesh.vertex_count(), mesh.face_count());
  if (found != right) {
    throw InputError(concatenate(file, ": has ", found, "; ", mesh_file, " has ", right));
  }
  const auto text = [](const FaceIndices& face) {
    return concatenate(face[0], ' ', face[1], ' ', face[2]);
  };
  for (std::size_t face = 0; face < mesh.face_count(); ++face) {
    const std::uint32_t* const corners = &shape.triangles[3 * face];
    const FaceIndices indices{corners[0], corners[1], corners[2]};
    if (indices == mesh.faces()[face]) continue;
    throw InputError(concatenate(file, ": face ", face, " has the vertices ", text(indices),
                                 ", counted from 0; in ", mesh_file, " they are ",
                                 text(mesh.faces()[face])));
  }
  mesh.move_vertices(vertices_of(shape));
  return mesh;
}

/// Returns whether there is a doubt.
bool warn(const std::string& doubt) {
  if (!doubt.empty()) std::cerr << "query_offline: warning: " << doubt << std::endl;
  return !doubt.empty();
}

/// Answers all motions in rounds. A round has the motions that are there without waiting, up to a
/// number that bounds the memory. The threads share a round. Answers are printed in the order of
/// the motions, while later motions of the round are still being answered.
class Evaluation {
 public:
  /// Throws GlError if OpenGL picking does not work.
  Evaluation(const Options& options, Motions& motions, const AskedOrgan& organ)
      : options_(options),
        motions_(motions),
        organ_(organ),
        threads_(options.jobs, options.picker),
        progress_("query_offline", "motions", motions.count()) {}

  /// Prints the header line first. If a motion is not legal, throws InputError after the answers to
  /// the motions before it are printed.
  void run() {
    print(contacts_header(options_.asked));
    while (next_round()) answer_round();
    if (error_) std::rethrow_exception(error_);
  }

 private:
  /// Gets the motions of the next round. Waits for the first motion only. Returns false if there is
  /// none.
  bool next_round() {
    round_.clear();
    if (error_) return false;
    try {
      while (round_.size() < kMostForEachThread * threads_.count() &&
             (round_.empty() || motions_.is_ready())) {
        std::optional<Motion> motion = motions_.next();
        if (!motion) break;
        const std::string shaft = concatenate(motions_.name(), ":", motion->line, ": the shaft");
        if (!has_warned_) has_warned_ = warn(doubt_about_radius(shaft, motion->radius));
        round_.push_back(std::move(*motion));
      }
    } catch (const InputError&) {
      error_ = std::current_exception();
    }
    return !round_.empty();
  }

  /// A thread answers a block of motions before it takes the next one. Small blocks keep all
  /// threads busy until the end of a round. Each block costs a few microseconds.
  void answer_round() {
    const std::size_t size = std::clamp<std::size_t>(round_.size() / (4 * threads_.count()), 1, 8);
    const auto begin = [&](std::size_t block) { return std::min(block * size, round_.size()); };
    std::vector<std::string> answers((round_.size() + size - 1) / size);
    const auto answer = [&](std::size_t worker, std::size_t block) {
      for (std::size_t i = begin(block); i < begin(block + 1); ++i) {
        CollisionResult result;
        threads_.query(worker).evaluate(request_of(round_[i], organ_, options_.asked), result);
        append_contacts(round_[i], result, options_.asked, answers[block]);
        if (options_.blank_lines) answers[block] += '\n';
      }
    };
    const auto deliver = [&](std::size_t block) {
      print(std::exchange(answers[block], {}));
      progress_.report(done_ += begin(block + 1) - begin(block));
    };
    threads_.run(answers.size(), answer, deliver);
  }

  const Options& options_;
  Motions& motions_;
  AskedOrgan organ_;
  std::vector<Motion> round_;
  std::exception_ptr error_;  ///< why no round follows, if that is an error
  QueryThreads<CollisionQuery> threads_;
  Progress progress_;
  bool has_warned_ = false;  ///< of the first shaft of implausible radius
  std::size_t done_ = 0;     ///< how many motions are answered
};

void answer(const Options& options) {
  const TriangleMesh mesh = mesh_of(options.mesh);
  const bool moves = !options.mesh_before.empty();
  const TriangleMesh before = moves ? shape_of(options.mesh_before, mesh, options.mesh) : mesh;
  warn(doubt_about_organ(options.mesh, mesh.box().cast<double>()));
  std::optional<SurfaceTopology> topology;
  if (options.asked.placement) topology.emplace(mesh.faces(), mesh.vertices());
  AskedOrgan organ{&mesh, moves ? &before : nullptr};
  organ.topology = topology ? &*topology : nullptr;
  Motions motions(options.motions);
  Evaluation(options, motions, organ).run();
  if (!motions.ends_within_line()) return;
  std::cerr
      << motions.error("warning: the last line has no line feed; its end may be missing").what()
      << std::endl;
}

}  // namespace
}  // namespace organ_collision

int main(int argc, char** argv) {
  using namespace organ_collision;
  // If SIGPIPE is ignored, a closed pipe on stdout is reported like any other failed write.
  std::signal(SIGPIPE, SIG_IGN);
  return exit_code("query_offline", [&] {
    const std::optional<Options> options = parse_options({argv + 1, argv + argc});
    if (options) answer(*options);
  });
}
