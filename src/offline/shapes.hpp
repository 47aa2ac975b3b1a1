#pragma once

#include <cstddef>
#include <exception>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "organ_collision/query/collision_query.hpp"
#include "query/worker_threads.hpp"

namespace organ_collision {

/// The calling thread and further ones, which do tasks side by side. Each has a CollisionQuery of
/// its own. A thread is started when there are tasks for it.
class QueryWorkers {
 public:
  /// At most `count` threads, at least 1. Throws GlError if OpenGL picking does not work.
  QueryWorkers(std::size_t count, const PickerSettings& picker);

  std::size_t count() const { return queries_.size(); }
  /// The query of a worker, for the tasks of this worker.
  CollisionQuery& query(std::size_t worker) { return *queries_[worker]; }
  /// See WorkerThreads::run().
  void run(std::size_t tasks, const WorkerThreads::Work& work,
           const WorkerThreads::Deliver& deliver);

 private:
  std::vector<std::optional<CollisionQuery>> queries_;  ///< of each worker
  WorkerThreads workers_;
};

/// Whether one name comes before another if numbers in them count by value: step_2 before step_10.
/// All else is compared byte by byte. Names that differ only in leading zeros are ordered as text.
bool is_naturally_before(std::string_view a, std::string_view b);

/// The paths of the files in a folder whose names end in .obj or .OBJ, in the natural order of
/// their names (see natural_order.hpp). Files whose names begin with a dot are left out. Throws
/// InputError if the folder cannot be read or has none.
std::vector<std::string> shape_files(const std::string& folder);

/// The organ that a motion meets.
struct OrganShapes {
  const TriangleMesh* now = nullptr;     ///< at the end of the motion
  const TriangleMesh* before = nullptr;  ///< at its start; null: the organ rests
};

/// Gives the shapes of the organ for motions that are answered in rounds.
class ShapeSource {
 public:
  virtual ~ShapeSource() = default;

  /// The most motions of a round for each thread, so that the shapes and answers of a round do not
  /// take too much memory.
  virtual std::size_t most_for_each_thread() const = 0;
  /// Gets the shapes of a round of `count` motions, which follow those of the last round. Returns
  /// how many motions have their shapes. Further ones have none if there are no more shapes, or
  /// because the next shape is not legal; `error` is then set to its InputError.
  virtual std::size_t get(std::size_t count, QueryWorkers& threads, std::exception_ptr& error) = 0;
  /// The shapes that a motion of the present round meets.
  virtual OrganShapes shapes_of(std::size_t motion) const = 0;
  /// How many shapes need motions after this round.
  virtual std::size_t remaining() const = 0;
  /// A shape that has the faces of all others.
  virtual const TriangleMesh& first() const = 0;
};

/// Each motion meets the organ in the same shape, or while it moves from one shape to another.
class FixedShapes : public ShapeSource {
 public:
  /// `mesh`, `mesh_before`: OBJ files of the shapes at the end and at the start of each motion; an
  /// empty name: the organ rests. Throws InputError if a file is missing or is not legal, or if
  /// their faces differ.
  FixedShapes(const std::string& mesh, const std::string& mesh_before);

  std::size_t most_for_each_thread() const override { return 512; }
  std::size_t get(std::size_t count, QueryWorkers&, std::exception_ptr&) override { return count; }
  OrganShapes shapes_of(std::size_t) const override {
    return {&now_, before_ ? &*before_ : nullptr};
  }
  std::size_t remaining() const override { return 0; }
  const TriangleMesh& first() const override { return now_; }

 private:
  TriangleMesh now_;
  std::optional<TriangleMesh> before_;
};

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
