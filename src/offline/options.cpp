#include "options.hpp"

#include <cmath>
#include <optional>
#include <stdexcept>

#include "command_line.hpp"
#include "query/worker_threads.hpp"
#include "text_reader.hpp"

namespace organ_collision {
namespace {

constexpr long long kMostJobs = 1024;

PickerSettings picker_of(const CommandLine& given) {
  PickerSettings settings;
  try {
    if (given.has("--picker")) settings.kind = picker_kind(given.value("--picker"));
    if (given.has("--gl")) settings.gl = gl_platform(given.value("--gl"));
    return settings;
  } catch (const std::invalid_argument& error) {
    given.refuse(error.what());
  }
}

double margin_of(const CommandLine& given) {
  const std::optional<double> margin = parse_number(given.value("--margin"));
  if (margin && std::isfinite(*margin) && *margin > 0.0) return *margin;
  given.refuse("--margin is " + in_quotes(given.value("--margin")) +
               "; must be a finite number above 0, in metres");
}

std::size_t jobs_of(const CommandLine& given) {
  if (!given.has("--jobs")) return thread_count(0);
  const std::optional<long long> jobs = parse_integer(given.value("--jobs"));
  if (jobs && *jobs >= 1 && *jobs <= kMostJobs) return static_cast<std::size_t>(*jobs);
  given.refuse("--jobs is " + in_quotes(given.value("--jobs")) +
               "; must be a whole number from 1 to " + std::to_string(kMostJobs));
}

/// Takes the options for the organ: one mesh, or a folder of shapes.
void set_organ(const CommandLine& given, Options& options) {
  options.shapes = given.value("--shapes");
  if (options.shapes.empty()) {
    options.mesh = given.required("--mesh");
    options.mesh_before = given.value("--mesh-before");
    return;
  }
  for (const char* const other : {"--mesh", "--mesh-before"}) {
    if (!given.has(other)) continue;
    given.refuse("options --shapes and " + std::string(other) +
                 " are given; the folder has all shapes");
  }
}

}  // namespace

Options parse_options(const std::vector<std::string>& arguments) {
  Options options;
  options.help = asks_for_help(arguments);
  if (options.help) return options;

  const CommandLine given({"query_offline",
                           {"--mesh", "--motions", "--mesh-before", "--shapes", "--jobs",
                            "--picker", "--gl", "--margin"},
                           {"--clearance", "--placement", "--blank-lines"}},
                          arguments);
  set_organ(given, options);
  options.motions = given.required("--motions");
  options.jobs = jobs_of(given);
  options.picker = picker_of(given);
  if (given.has("--margin")) options.margin = margin_of(given);
  options.clearance = given.has("--clearance");
  options.placement = given.has("--placement");
  options.blank_lines = given.has("--blank-lines");
  return options;
}

std::string usage() {
  return R"(Usage: query_offline --mesh FILE [--mesh-before FILE] --motions FILE [OPTIONS]
       query_offline --shapes FOLDER --motions FILE [OPTIONS]
Options: [--jobs NUMBER] [--picker NAME] [--gl NAME] [--margin METRES] [--clearance]
         [--placement] [--blank-lines]

Prints the faces that a tool touches, or touched while it moved, as CSV. Needs no ROS master.

  --mesh FILE         the organ, an OBJ file in metres; vertices are rounded to 32-bit floats
  --motions FILE      CSV file, or - for standard input; one motion in each line:
                      query,mode,trocar_x,trocar_y,trocar_z,previous_x,previous_y,previous_z,
                      tip_x,tip_y,tip_z,radius
                      query: a number or a name, each once
                      mode: static (previous ignored), swept, paper_static, paper_swept, paper_naive
                      lengths in metres, in the mesh's frame; the trocar rests; a header line may
                      come first
  --mesh-before FILE  the same faces at the start of the step: swept motions then meet the organ
                      moving linearly from there to --mesh; without it the organ rests
  --shapes FOLDER     a recorded simulation: an OBJ file with the same faces for each motion, in the
                      order of the files' names (step_2.obj before step_10.obj). During a swept
                      motion, the organ moves linearly from the shape before to that of the motion;
                      in the first motion it rests
  --jobs NUMBER       threads, 1 to 1024; by default one for each core. The output does not depend on
                      it
  --picker NAME       feedback (default), select or cpu: the same contacts; select is much slower on
                      large meshes, and cpu needs no OpenGL
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
the mesh's f lines, from 0; a polygon is cut into a fan and counts as so many faces. Without the
options below, a motion without contact has no line. In the paper's modes the columns after face
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
}

}  // namespace organ_collision
