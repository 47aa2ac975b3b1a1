#pragma once

#include <cstddef>
#include <exception>
#include <string>
#include <vector>

#include "shape_source.hpp"

namespace organ_collision {

/// The shapes of a recorded simulation: an OBJ file for each step, with the same faces. During the
/// motion of a step, the organ moves from the shape of the step before to that of the step. In the
/// first step it rests. Files are read side by side, a few for each thread at once.
class ShapeSequence : public ShapeSource {
 public:
  /// `files`: at least one, in the order of the steps. Reads the first one. Throws InputError if it
  /// is missing or is not legal.
  explicit ShapeSequence(std::vector<std::string> files);

  std::size_t most_for_each_thread() const override { return 4; }
  /// A file that is missing, is not legal or has other faces than the first one is an error.
  std::size_t get(std::size_t count, QueryWorkers& threads, std::exception_ptr& error) override;
  OrganShapes shapes_of(std::size_t motion) const override;
  const TriangleMesh& first() const override { return first_; }
  std::size_t remaining() const override { return files_.size() - next_; }

 private:
  void read(std::size_t file, TriangleMesh& shape) const;

  std::vector<std::string> files_;
  std::size_t next_ = 0;  ///< the file of the first motion of the next round
  TriangleMesh first_;
  std::vector<TriangleMesh> shapes_;  ///< that before the present round, then those of the round
  std::size_t count_ = 0;             ///< of the shapes of the round
};

}  // namespace organ_collision
