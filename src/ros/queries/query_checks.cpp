#include "query_checks.hpp"

namespace organ_collision {

static_assert(ContactArray::STATIC == static_cast<int>(QueryMode::kStatic) &&
              ContactArray::SWEPT == static_cast<int>(QueryMode::kSwept) &&
              ContactArray::PAPER_STATIC == static_cast<int>(QueryMode::kPaperStatic) &&
              ContactArray::PAPER_SWEPT == static_cast<int>(QueryMode::kPaperSwept) &&
              ContactArray::PAPER_NAIVE == static_cast<int>(QueryMode::kPaperNaive));

QueryMode checked_mode(std::uint8_t mode) {
  if (mode <= ContactArray::PAPER_NAIVE) return static_cast<QueryMode>(mode);
  refuse("mode is ", static_cast<int>(mode), "; legal are 0 (STATIC) to 4 (PAPER_NAIVE)");
}

void check_tool(const Tool& tool, QueryMode mode) {
  if (!tool.fault.empty()) {
    throw Rejection(ContactArray::INVALID_TOOL, "invalid tool", tool.fault);
  }
  if (is_paper_mode(mode) && !tool.parameters.has_shaft()) {
    refuse("mode is ", static_cast<int>(mode), ", and tool '", tool.parameters.name,
           "' has no shaft, which the paper's modes are of; for links, legal are 0 (STATIC) and 1 "
           "(SWEPT)");
  }
}

}  // namespace organ_collision
