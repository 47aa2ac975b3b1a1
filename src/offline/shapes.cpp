#include "shapes.hpp"

#include <algorithm>
#include <filesystem>
#include <tuple>
#include <utility>

#include "obj_reader.hpp"
#include "text_reader.hpp"

namespace organ_collision {

QueryWorkers::QueryWorkers(std::size_t count, const PickerSettings& picker)
    : queries_(count), workers_(WorkerThreads::Caller::kWorks, [this, picker](std::size_t worker) {
        queries_[worker].emplace(picker);
      }) {
  queries_[0].emplace(picker);
}

void QueryWorkers::run(std::size_t tasks, const WorkerThreads::Work& work,
                       const WorkerThreads::Deliver& deliver) {
  if (tasks > 1) workers_.start(std::min(tasks, count()) - 1);
  workers_.run(tasks, work, deliver);
}

namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Takes the digits at the beginning of `text` away. Returns them without leading zeros.
std::string_view take_number(std::string_view& text) {
  const auto* const end = std::find_if_not(text.begin(), text.end(), is_digit);
  std::string_view number = text.substr(0, static_cast<std::size_t>(end - text.begin()));
  text.remove_prefix(number.size());
  number.remove_prefix(std::min(number.find_first_not_of('0'), number.size()));
  return number;
}

}  // namespace

bool is_naturally_before(std::string_view a, std::string_view b) {
  const std::string_view whole_a = a, whole_b = b;
  while (!a.empty() && !b.empty()) {
    if (is_digit(a[0]) && is_digit(b[0])) {
      const std::string_view number_a = take_number(a), number_b = take_number(b);
      if (number_a == number_b) continue;
      return std::make_tuple(number_a.size(), number_a) <
             std::make_tuple(number_b.size(), number_b);
    }
    if (a[0] != b[0]) return std::string_view(a.data(), 1) < std::string_view(b.data(), 1);
    a.remove_prefix(1);
    b.remove_prefix(1);
  }
  if (a.empty() != b.empty()) return a.empty();
  return whole_a < whole_b;
}

namespace fs = std::filesystem;
namespace {

bool is_shape(const fs::path& file) {
  const fs::path extension = file.extension();
  const bool is_hidden = file.filename().native()[0] == '.';
  return !is_hidden && (extension == ".obj" || extension == ".OBJ");
}

}  // namespace

std::vector<std::string> shape_files(const std::string& folder) {
  std::vector<fs::path> found;
  try {
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
      if (is_shape(entry.path())) found.push_back(entry.path());
    }
  } catch (const fs::filesystem_error& error) {
    throw InputError(folder + ": cannot be read: " + error.code().message());
  }
  if (found.empty())
    throw InputError(folder + ": the folder has no OBJ file; must have at least one");
  std::sort(found.begin(), found.end(), [](const fs::path& a, const fs::path& b) {
    return is_naturally_before(a.filename().native(), b.filename().native());
  });
  return {found.begin(), found.end()};
}

FixedShapes::FixedShapes(const std::string& mesh, const std::string& mesh_before)
    : now_(mesh_of(read_obj(mesh))) {
  if (mesh_before.empty()) return;
  ObjFile before = read_obj(mesh_before);
  check_same_faces(before, now_, mesh);
  before_ = now_;
  before_->move_vertices(std::move(before.vertices));
}

ShapeSequence::ShapeSequence(std::vector<std::string> files)
    : files_(std::move(files)), first_(mesh_of(read_obj(files_.at(0)))), shapes_{first_} {}

std::size_t ShapeSequence::get(std::size_t count, QueryWorkers& threads,
                               std::exception_ptr& error) {
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

OrganShapes ShapeSequence::shapes_of(std::size_t motion) const {
  const bool is_first_step = next_ - count_ + motion == 0;
  return {&shapes_[motion + 1], is_first_step ? nullptr : &shapes_[motion]};
}

/// Moves `shape` to the vertices of a file.
void ShapeSequence::read(std::size_t file, TriangleMesh& shape) const {
  if (file == 0) return;  // It is first_, which all shapes are copies of.
  ObjFile obj = read_obj(files_[file]);
  check_same_faces(obj, first_, files_[0]);
  shape.move_vertices(std::move(obj.vertices));
}

}  // namespace organ_collision
