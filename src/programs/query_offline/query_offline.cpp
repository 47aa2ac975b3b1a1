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
#include "shapes.hpp"

namespace organ_collision {
namespace {

constexpr char kUsage[] =
    R"(Usage: query_offline --mesh FILE [--mesh-before FILE] --motions FILE [OPTIONS]
       query_offline --shapes FOLDER --motions FILE [OPTIONS]
Options: [--jobs NUMBER] [--picker NAME] [--gl NAME] [--margin METRES] [--clearance]
         [--placement] [--blank-lines]

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
  --shapes FOLDER     a recorded simulation: an OBJ file with the same faces for each motion, in the
                      order of the files' names (step_2.obj before step_10.obj). During a swept
                      motion, the organ moves linearly from the shape before to that of the motion;
                      in the first motion it rests
  --jobs NUMBER       threads, 1 to 1024; by default one for each core. The output does not depend on
                      it
  --picker NAME       feedback (default), select or cpu: the same contacts. In the paper's modes,
                      select draws all faces, which is much slower. cpu needs no OpenGL
  --gl NAME           where the OpenGL for picking comes from: osmesa, egl, or auto (default): OSMesa
                      where there is one, else EGL
  --margin METRES     adds the distance between tool and organ, if it is at most this; above 0
  --clearance         adds the distance without a limit; a margin then changes nothing
  --placement         adds on which side of the organ the tool is, and where its axis crosses it
  --blank-lines       a blank line follows the answer to each motion, so that a program that waits
                      for the answer sees its end
  --help              this text

Output: query,face,fraction,depth,point_x,point_y,point_z,normal_x,normal_y,normal_z
sorted by query (integers by value, names as text), then face; with --motions - and with --shapes, in
the order of the motions, then face. A face's number is its place among
the faces of the mesh file, from 0; a polygon of k corners counts as k - 2 faces: a convex one as the fan
around its first corner, a concave one without faces in the void. Without the options below, a motion
without contact has no line. In the paper's modes the columns after face
are empty.

With --margin, --clearance or --placement each motion has at least one line. Further columns follow,
which are the same in all lines of a motion. A motion without contact has one line, in which the
columns from face to normal_z are empty. In the paper's modes the further columns are empty.

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

With --motions - a motion is answered as soon as its line has arrived. A query may then come twice.

Exit status: 0 done; 2 bad input, with one line on stderr and nothing on stdout; 1 other failures.
With --motions - and with --shapes, the motions before a bad line, or before a bad shape, are answered
first.
)";

constexpr int kMostJobs = 1024;

struct Options {
  std::string mesh;         ///< a mesh file; empty: the folder `shapes` is used
  std::string mesh_before;  ///< a mesh file; empty: the organ rests
  std::string shapes;       ///< a folder with an OBJ file for each motion; empty: `mesh` is used
  std::string motions;      ///< a CSV file, or "-": standard input
  Questions questions;
};

/// Returns none if --help is asked for.
std::optional<Options> parse_options(const std::vector<std::string>& arguments) {
  Options options;
  Questions& questions = options.questions;
  questions.jobs = thread_count(0);
  const auto jobs = [&](int count) {
    if (count < 1 || count > kMostJobs) {
      throw std::invalid_argument(
          concatenate("--jobs is ", count, "; must be from 1 to ", kMostJobs));
    }
    questions.jobs = static_cast<std::size_t>(count);
  };
  const auto margin = [&](double metres) {
    if (!std::isfinite(metres) || !(metres > 0.0)) {
      throw std::invalid_argument(
          concatenate("--margin is ", metres, "; must be a finite number above 0, in metres"));
    }
    questions.margin = metres;
  };
  const auto picker = [&](const std::string& name) { questions.picker.kind = picker_kind(name); };
  const auto gl = [&](const std::string& name) { questions.picker.gl = gl_platform(name); };
  namespace po = boost::program_options;
  po::options_description legal;
  auto add = legal.add_options();
  add("mesh", po::value(&options.mesh));
  add("mesh-before", po::value(&options.mesh_before));
  add("shapes", po::value(&options.shapes));
  add("motions", po::value(&options.motions)->required());
  add("jobs", po::value<int>()->notifier(jobs));
  add("picker", po::value<std::string>()->notifier(picker));
  add("gl", po::value<std::string>()->notifier(gl));
  add("margin", po::value<double>()->notifier(margin));
  add("clearance", po::bool_switch(&questions.clearance));
  add("placement", po::bool_switch(&questions.placement));
  add("blank-lines", po::bool_switch(&questions.blank_lines));
  if (!read_command_line("query_offline", kUsage, arguments, legal)) return std::nullopt;

  const bool has_mesh = !(options.mesh + options.mesh_before).empty();
  if (options.mesh.empty() == options.shapes.empty() || (has_mesh && !options.shapes.empty())) {
    throw InputError(
        "query_offline: give either --mesh, and perhaps --mesh-before, or --shapes, which has all "
        "shapes (--help explains)");
  }
  return options;
}

/// How many motions a thread answers before it takes the next ones. Small blocks keep all threads
/// busy until the end of a round. Each block costs a few microseconds.
std::size_t block_size(std::size_t motions, std::size_t threads) {
  return std::clamp<std::size_t>(motions / (4 * threads), 1, 8);
}

/// Answers all motions in rounds. A round has the motions that are there without waiting, up to a
/// number that bounds the memory. The threads share a round. Answers are printed in the order of
/// the motions, while later motions of the round are still being answered.
class Evaluation {
 public:
  Evaluation(const Questions& questions, Motions& motions, ShapeSource& shapes)
      : questions_(questions),
        source_(motions),
        shapes_(shapes),
        threads_(questions.jobs, questions.picker),
        progress_("query_offline", "motions", motions.count()) {
    const TriangleMesh& organ = shapes_.first();
    if (questions.placement) topology_.emplace(organ.faces(), organ.vertices());
  }

  /// Prints the header line first. If a motion or its shape is not legal, throws InputError after
  /// the answers to the motions before it are printed. Throws GlError if OpenGL picking does not
  /// work.
  void run() {
    print(contacts_header(questions_));
    while (next_round()) answer_round();
    if (error_) std::rethrow_exception(error_);
    if (shapes_.remaining() == 0) return;
    throw InputError(source_.text().name() + ": the motions end; shapes without a motion: " +
                     std::to_string(shapes_.remaining()) + "; each shape needs one");
  }

 private:
  /// Gets the motions of the next round, and their shapes. Waits for the first motion only. Returns
  /// false if there are no further motions with a shape.
  bool next_round() {
    motions_.clear();
    if (error_) return false;
    const std::size_t most = threads_.count() * shapes_.most_for_each_thread();
    try {
      while (motions_.size() < most && (motions_.empty() || source_.is_ready())) {
        std::optional<Motion> motion = source_.next();
        if (!motion) break;
        warn_of(*motion);
        motions_.push_back(std::move(*motion));
      }
    } catch (const InputError&) {
      error_ = std::current_exception();
    }
    try {
      shapes_.get(motions_.size(), threads_);
      if (shapes_.count() < motions_.size()) {
        throw InputError(source_.text().name(), motions_[shapes_.count()].line,
                         "there is no shape for this motion; must have as many shapes");
      }
    } catch (const InputError&) {
      error_ = std::current_exception();
    }
    motions_.resize(shapes_.count());
    return !motions_.empty();
  }

  /// Warns once, of the first shaft of implausible radius.
  void warn_of(const Motion& motion) {
    if (has_warned_) return;
    const std::string doubt = doubt_about_radius(
        concatenate(source_.text().name(), ":", motion.line, ": the shaft"), motion.radius);
    has_warned_ = !doubt.empty();
    if (has_warned_) std::cerr << "query_offline: warning: " << doubt << std::endl;
  }

  void answer_round() {
    const std::size_t size = block_size(motions_.size(), threads_.count());
    const auto begin = [&](std::size_t block) { return std::min(block * size, motions_.size()); };
    std::vector<std::string> answers((motions_.size() + size - 1) / size);
    const auto answer = [&](std::size_t worker, std::size_t block) {
      for (std::size_t motion = begin(block); motion < begin(block + 1); ++motion) {
        append_answer(motion, threads_.query(worker), answers[block]);
      }
    };
    const auto deliver = [&](std::size_t block) {
      print(std::exchange(answers[block], {}));
      progress_.report(done_ += begin(block + 1) - begin(block));
    };
    threads_.run(answers.size(), answer, deliver);
  }

  void append_answer(std::size_t number, CollisionQuery& query, std::string& csv) const {
    const Motion& motion = motions_[number];
    AskedOrgan organ = shapes_.shapes_of(number);
    organ.topology = topology_ ? &*topology_ : nullptr;
    CollisionResult result;
    query.evaluate(request_of(motion, organ, questions_), result);
    append_contacts(motion, result, questions_, csv);
    if (questions_.blank_lines) csv += '\n';
  }

  const Questions& questions_;
  Motions& source_;
  ShapeSource& shapes_;
  std::optional<SurfaceTopology> topology_;  ///< set only if the placement is asked for
  std::vector<Motion> motions_;              ///< the motions of the present round
  std::exception_ptr error_;                 ///< why no round follows, if that is an error
  QueryWorkers threads_;
  Progress progress_;
  bool has_warned_ = false;
  std::size_t done_ = 0;  ///< how many motions are answered
};

void answer(const Options& options) {
  const bool has_recording = !options.shapes.empty();
  ShapeSource shapes =
      has_recording ? ShapeSource(options.shapes) : ShapeSource(options.mesh, options.mesh_before);
  const std::string doubt = doubt_about_organ(has_recording ? options.shapes : options.mesh,
                                              shapes.first().box().cast<double>());
  if (!doubt.empty()) std::cerr << "query_offline: warning: " << doubt << std::endl;
  Motions motions(options.motions,
                  has_recording ? Motions::Order::kAsInFile : Motions::Order::kByQuery);
  const std::optional<std::size_t> count = motions.count();
  if (has_recording && count && *count != shapes.remaining()) {
    throw InputError(concatenate(options.motions, ": the file has ", *count, " motions; ",
                                 options.shapes, " has ", shapes.remaining(),
                                 " OBJ files, and each needs one motion"));
  }
  Evaluation(options.questions, motions, shapes).run();
  const TextReader& text = motions.text();
  if (count || !text.ends_within_line()) return;
  std::cerr << text.error("warning: the last line has no line feed; its end may be missing").what()
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
