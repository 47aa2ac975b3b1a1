#include "evaluation.hpp"

#include <algorithm>
#include <exception>
#include <optional>
#include <utility>
#include <vector>

#include "contacts_csv.hpp"

namespace organ_collision {
namespace {

/// How many motions a thread answers before it takes the next ones. Small blocks keep all threads
/// busy until the end of a round; each costs a few microseconds.
std::size_t block_size(std::size_t motions, std::size_t threads) {
  return std::clamp<std::size_t>(motions / (4 * threads), 1, 8);
}

class Evaluation {
 public:
  Evaluation(const Questions& questions, MotionSource& motions, ShapeSource& shapes)
      : questions_(questions),
        added_{questions.margin > 0.0 || questions.clearance, questions.placement},
        source_(motions),
        shapes_(shapes),
        threads_(questions.jobs, questions.picker) {
    const TriangleMesh& organ = shapes_.first();
    if (questions.placement) topology_.emplace(organ.faces(), organ.vertices());
  }

  void run(const Print& print) {
    print(contacts_header(added_), 0);
    while (next_round()) answer_round(print);
    if (error_) std::rethrow_exception(error_);
    if (shapes_.remaining() == 0) return;
    throw InputError(source_.name() + ": the motions end; shapes without a motion: " +
                     std::to_string(shapes_.remaining()) + "; each shape needs one");
  }

 private:
  /// Whether there are further motions. Waits for the first one only.
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
    threads_.start_for(motions_.size());
    get_shapes();
    if (error_) is_last_ = true;
    return !motions_.empty();
  }

  /// Leaves only the motions that have shapes.
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
    append_contacts(motion, result, csv, added_);
    if (questions_.blank_lines) csv += '\n';
  }

  const Questions& questions_;
  const AddedColumns added_;
  MotionSource& source_;
  ShapeSource& shapes_;
  std::optional<SurfaceTopology> topology_;  ///< only if the placement is asked for
  std::vector<Motion> motions_;              ///< of the present round
  bool is_last_ = false;                     ///< whether no round follows
  std::exception_ptr error_;                 ///< why not, if motions are left
  QueryWorkers threads_;
};

}  // namespace

void evaluate(const Questions& questions, MotionSource& motions, ShapeSource& shapes,
              const Print& print) {
  Evaluation(questions, motions, shapes).run(print);
}

}  // namespace organ_collision
