#include "evaluation.hpp"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <exception>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace organ_collision {
namespace {

constexpr std::size_t kCellsBehindFace = 8, kCellsOfClearance = 15, kCellsOfPlacement = 7;

// append_cell() writes its comma first, because a line of CSV begins with the query's name.

void append_cell(std::string_view text, std::string& csv) { (csv += ',') += text; }

/// Appends a number as printf does with "%.17g". std::to_chars writes the same characters in a
/// fifth of the time, but the C++ library of GCC 10 and older does not have it.
void append_number(double number, std::string& text) {
  char digits[32];  // long enough for every double with 17 significant digits
#ifdef __cpp_lib_to_chars
  const auto end =
      std::to_chars(digits, digits + sizeof digits, number, std::chars_format::general, 17);
  text.append(digits, end.ptr);
#else
  text.append(digits, std::snprintf(digits, sizeof digits, "%.17g", number));
#endif
}

void append_cell(double number, std::string& csv) { append_number(number, csv += ','); }

void append_cells(const Eigen::Vector3d& vector, std::string& csv) {
  for (int axis = 0; axis < 3; ++axis) append_cell(vector[axis], csv);
}

void append_empty_cells(std::size_t count, std::string& csv) { csv.append(count, ','); }

void append_contact(const FaceContact& contact, bool of_paper_mode, std::string& csv) {
  append_cell(std::to_string(contact.face), csv);
  if (of_paper_mode) return append_empty_cells(kCellsBehindFace, csv);
  append_cell(contact.fraction, csv);
  append_cell(contact.depth, csv);
  append_cells(contact.point, csv);
  append_cells(contact.normal, csv);
}

void append_clearance(const ToolClearance& clearance, std::string& csv) {
  if (clearance.state == ClearanceState::kNotAsked) {
    return append_empty_cells(kCellsOfClearance, csv);
  }
  if (clearance.state == ClearanceState::kBeyondMargin) {
    append_cell("beyond_margin", csv);
    return append_empty_cells(kCellsOfClearance - 1, csv);
  }
  append_cell(clearance.is_resolved ? "known" : "upper_bound", csv);
  append_cell(clearance.distance, csv);
  append_cell(clearance.least, csv);
  append_cell(clearance.least_fraction, csv);
  append_cell(std::to_string(clearance.face), csv);
  append_cells(clearance.on_organ, csv);
  append_cells(clearance.on_tool, csv);
  append_cells(clearance.normal, csv);
  append_cell(clearance.normal_defined ? "1" : "0", csv);
}

std::string_view name_of(Side side) {
  if (side == Side::kOutside) return "outside";
  if (side == Side::kInside) return "inside";
  return side == Side::kOnSurface ? "on_surface" : "unknown";
}

void append_placement(const AxisPlacement& placement, std::string& csv) {
  std::string faces, directions, places;
  for (const AxisCrossing& crossing : placement.crossings) {
    for (std::string* const cell : {&faces, &directions, &places}) {
      if (!cell->empty()) *cell += ' ';
    }
    faces += std::to_string(crossing.face);
    directions += std::to_string(int{crossing.direction});
    append_number(crossing.shaft, places);
  }
  append_cell(name_of(placement.tip), csv);
  append_cell(name_of(placement.trocar), csv);
  append_cell(std::to_string(placement.crossings.size()), csv);
  append_cell(faces, csv);
  append_cell(directions, csv);
  append_cell(places, csv);
  csv += ',';
  if (placement.length_known) append_number(placement.length_inside, csv);
}

}  // namespace

std::string contacts_header(const Questions& questions) {
  std::string header =
      "query,face,fraction,depth,point_x,point_y,point_z,normal_x,normal_y,normal_z";
  if (questions.has_clearance()) {
    header +=
        ",clearance,distance,least,least_fraction,nearest_face"
        ",on_organ_x,on_organ_y,on_organ_z,on_tool_x,on_tool_y,on_tool_z"
        ",clearance_normal_x,clearance_normal_y,clearance_normal_z,normal_defined";
  }
  if (questions.placement) {
    header +=
        ",tip_side,trocar_side,crossings,crossed_faces,crossing_directions,crossing_places"
        ",length_inside";
  }
  return header + '\n';
}

void append_contacts(const Motion& motion, const CollisionResult& result,
                     const Questions& questions, std::string& csv) {
  const bool of_paper_mode = is_paper_mode(motion.mode);
  std::string added;
  if (questions.has_clearance()) append_clearance(result.clearance, added);
  if (questions.placement && of_paper_mode) append_empty_cells(kCellsOfPlacement, added);
  if (questions.placement && !of_paper_mode) append_placement(result.placement, added);
  for (const FaceContact& contact : result.contacts) {
    csv += motion.query;
    append_contact(contact, of_paper_mode, csv);
    csv += added + '\n';
  }
  if (result.contacts.empty() && !added.empty()) {
    csv += motion.query;
    append_empty_cells(1 + kCellsBehindFace, csv);
    csv += added + '\n';
  }
}

namespace {

/// How many motions a thread answers before it takes the next ones. Small blocks keep all threads
/// busy until the end of a round. Each block costs a few microseconds.
std::size_t block_size(std::size_t motions, std::size_t threads) {
  return std::clamp<std::size_t>(motions / (4 * threads), 1, 8);
}

class Evaluation {
 public:
  Evaluation(const Questions& questions, MotionSource& motions, ShapeSource& shapes)
      : questions_(questions),
        source_(motions),
        shapes_(shapes),
        threads_(questions.jobs, questions.picker) {
    const TriangleMesh& organ = shapes_.first();
    if (questions.placement) topology_.emplace(organ.faces(), organ.vertices());
  }

  void run(const Print& print) {
    print(contacts_header(questions_), 0);
    while (next_round()) answer_round(print);
    if (error_) std::rethrow_exception(error_);
    if (shapes_.remaining() == 0) return;
    throw InputError(source_.name() + ": the motions end; shapes without a motion: " +
                     std::to_string(shapes_.remaining()) + "; each shape needs one");
  }

 private:
  /// Gets the motions of the next round, and waits for the first of them only. Returns false if
  /// there are no further motions.
  bool next_round() {
    motions_.clear();
    if (is_last_) return false;
    const std::size_t most = threads_.count() * shapes_.most_for_each_thread();
    try {
      while (motions_.size() < most && (motions_.empty() || source_.is_ready())) {
        std::optional<Motion> motion = source_.next();
        if (!motion) {
          is_last_ = true;
          break;
        }
        motions_.push_back(std::move(*motion));
      }
    } catch (const InputError&) {
      error_ = std::current_exception();
    }
    get_shapes();
    if (error_) is_last_ = true;
    return !motions_.empty();
  }

  /// Gets the shapes of the round's motions, and drops the motions that have no shape.
  void get_shapes() {
    std::exception_ptr error;
    const std::size_t count = shapes_.get(motions_.size(), threads_, error);
    if (count == motions_.size()) return;
    const InputError too_many(source_.name(), motions_[count].line,
                              "there is no shape for this motion; must have as many shapes");
    error_ = error ? error : std::make_exception_ptr(too_many);
    motions_.resize(count);
  }

  void answer_round(const Print& print) {
    const std::size_t size = block_size(motions_.size(), threads_.count());
    const auto begin = [&](std::size_t block) { return std::min(block * size, motions_.size()); };
    std::vector<std::string> answers((motions_.size() + size - 1) / size);
    const auto answer = [&](std::size_t worker, std::size_t block) {
      for (std::size_t motion = begin(block); motion < begin(block + 1); ++motion) {
        append_answer(motion, threads_.query(worker), answers[block]);
      }
    };
    const auto deliver = [&](std::size_t block) {
      print(std::exchange(answers[block], {}), begin(block + 1) - begin(block));
    };
    threads_.run(answers.size(), answer, deliver);
  }

  void append_answer(std::size_t number, CollisionQuery& query, std::string& csv) const {
    const Motion& motion = motions_[number];
    const OrganShapes organ = shapes_.shapes_of(number);
    CollisionRequest request;
    request.organ = organ.now;
    request.organ_before = organ.before;
    request.path = path_of(motion);
    request.radius = motion.radius;
    request.mode = motion.mode;
    if (!is_paper_mode(motion.mode)) {
      request.margin = questions_.margin;
      request.clearance = questions_.clearance;
      request.placement = questions_.placement;
      request.surface_topology = topology_ ? &*topology_ : nullptr;
    }
    CollisionResult result;
    query.evaluate(request, result);
    append_contacts(motion, result, questions_, csv);
    if (questions_.blank_lines) csv += '\n';
  }

  const Questions& questions_;
  MotionSource& source_;
  ShapeSource& shapes_;
  std::optional<SurfaceTopology> topology_;  ///< set only if the placement is asked for
  std::vector<Motion> motions_;              ///< the motions of the present round
  bool is_last_ = false;                     ///< whether no round follows this one
  std::exception_ptr error_;                 ///< why no round follows, if that is an error
  QueryWorkers threads_;
};

}  // namespace

void evaluate(const Questions& questions, MotionSource& motions, ShapeSource& shapes,
              const Print& print) {
  Evaluation(questions, motions, shapes).run(print);
}

}  // namespace organ_collision
