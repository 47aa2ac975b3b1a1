#include "shape_folder.hpp"

#include <algorithm>
#include <filesystem>

#include "input_error.hpp"
#include "natural_order.hpp"

namespace organ_collision {
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

}  // namespace organ_collision
