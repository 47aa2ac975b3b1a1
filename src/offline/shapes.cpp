#include "shapes.hpp"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include "obj_reader.hpp"
#include "user_input.hpp"

namespace organ_collision {
namespace {

namespace fs = std::filesystem;

class FixedShapes : public ShapeSource {
 public:
  FixedShapes(const std::string& mesh, const std::string& mesh_before)
      : now_(mesh_of(read_obj(mesh))) {
    if (mesh_before.empty()) return;
    ObjFile before = read_obj(mesh_before);
    check_same_faces(before, now_, mesh);
    before_ = now_;
    before_->move_vertices(std::move(before.vertices));
  }

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

class RecordedShapes : public ShapeSource {
 public:
  explicit RecordedShapes(std::vector<fs::path> files)
      : files_(std::move(files)), first_(mesh_of(read_obj(files_.at(0)))), shapes_{first_} {}

  std::size_t most_for_each_thread() const override { return 4; }
  std::size_t get(std::size_t count, QueryWorkers& threads, std::exception_ptr& error) override {
    std::swap(shapes_[0], shapes_[count_]);
    if (shapes_.size() <= count) shapes_.resize(count + 1, first_);
    count_ = 0;
    try {
      threads.run(
          std::min(count, remaining()),
          [this](std::size_t, std::size_t task) { read(next_ + task, shapes_[task + 1]); },
          [this](std::size_t) { ++count_; });
    } catch (const InputError&) {
      error = std::current_exception();
    }
    next_ += count_;
    return count_;
  }
  OrganShapes shapes_of(std::size_t motion) const override {
    const bool is_first_step = next_ - count_ + motion == 0;
    return {&shapes_[motion + 1], is_first_step ? nullptr : &shapes_[motion]};
  }
  std::size_t remaining() const override { return files_.size() - next_; }
  const TriangleMesh& first() const override { return first_; }

 private:
  /// Moves `shape` to the vertices of a file. A file that is missing, is not legal or has other
  /// faces than the first one is an error.
  void read(std::size_t file, TriangleMesh& shape) const {
    if (file == 0) return;  // It is first_, which all shapes are copies of.
    ObjFile obj = read_obj(files_[file]);
    check_same_faces(obj, first_, files_[0]);
    shape.move_vertices(std::move(obj.vertices));
  }

  std::vector<fs::path> files_;
  std::size_t next_ = 0;  ///< the file of the first motion of the next round
  TriangleMesh first_;
  std::vector<TriangleMesh> shapes_;  ///< that before the present round, then those of the round
  std::size_t count_ = 0;             ///< of the shapes of the round
};

bool is_shape(const fs::path& file) {
  const fs::path extension = file.extension();
  const bool is_hidden = file.filename().native()[0] == '.';
  return !is_hidden && (extension == ".obj" || extension == ".OBJ");
}

}  // namespace

std::unique_ptr<ShapeSource> fixed_shapes(const std::string& mesh, const std::string& mesh_before) {
  return std::make_unique<FixedShapes>(mesh, mesh_before);
}

std::unique_ptr<ShapeSource> recorded_shapes(const std::string& folder) {
  std::vector<fs::path> files;
  try {
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
      if (is_shape(entry.path())) files.push_back(entry.path());
    }
  } catch (const fs::filesystem_error& error) {
    throw InputError(folder + ": cannot be read: " + error.code().message());
  }
  if (files.empty()) {
    throw InputError(folder + ": the folder has no OBJ file; must have at least one");
  }
  std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
    return strverscmp(a.filename().c_str(), b.filename().c_str()) < 0;
  });
  return std::make_unique<RecordedShapes>(std::move(files));
}

}  // namespace organ_collision
