#pragma once

#include <cstddef>
#include <exception>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "contacts_csv.hpp"
#include "motions.hpp"
#include "options.hpp"
#include "shapes.hpp"

namespace organ_collision {

/// Answers motions in rounds. A round has the motions that are there without waiting, up to a
/// number that bounds the memory. The threads share it, and their answers are printed in the order
/// of the motions while the round is still being answered.
class Evaluation {
 public:
  /// Takes CSV lines and the number of motions that they answer.
  using Print = std::function<void(const std::string& csv, std::size_t motions)>;

  /// `options` say what is asked about each motion. All arguments must outlive the evaluation.
  Evaluation(const Options& options, MotionSource& motions, ShapeSource& shapes,
             QueryWorkers& threads);

  /// Answers all motions. The header line is printed first, for no motion. If a motion or its shape
  /// is not legal, throws InputError when the answers to the motions before it are printed.
  void run(const Print& print);

 private:
  bool next_round();
  void get_shapes();
  void answer_round(const Print& print);
  void append_answer(std::size_t motion, CollisionQuery& query, std::string& csv) const;

  const Options& options_;
  const AddedColumns added_;
  MotionSource& source_;
  ShapeSource& shapes_;
  QueryWorkers& threads_;
  std::optional<SurfaceTopology> topology_;  ///< only if the placement is asked for
  std::vector<Motion> motions_;              ///< of the present round
  bool is_last_ = false;                     ///< whether no round follows
  std::exception_ptr error_;                 ///< why not, if motions are left
};

}  // namespace organ_collision
