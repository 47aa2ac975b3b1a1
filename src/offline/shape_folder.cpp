#include "shape_folder.hpp"

#include <algorithm>
#include <filesystem>

#include "input_error.hpp"
#include "natural_order.hpp"

namespace organ_collision {

std::vector<std::string> shape_files(const std::string& folder) {
  namespace fs = std::filesystem;
  std::vector<fs::path> found;
  try {
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
      const fs::path extension = entry.path().extension();
      if (extension == ".obj" || extension == ".OBJ") found.push_back(entry.path());
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
