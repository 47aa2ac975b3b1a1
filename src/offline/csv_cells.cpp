#include "csv_cells.hpp"

#include <charconv>
#include <cstdio>
#include <string_view>

namespace organ_collision {
namespace {

using Digits = char[32];  ///< long enough for every double with 17 significant digits

/// Writes a number as printf does with "%.17g". std::to_chars writes the same characters in a fifth
/// of the time, but the C++ library of GCC 10 and older does not have it.
std::string_view write(double number, Digits& text) {
#ifdef __cpp_lib_to_chars
  const auto end = std::to_chars(text, text + sizeof text, number, std::chars_format::general, 17);
  return {text, static_cast<std::size_t>(end.ptr - text)};
#else
  return {text, static_cast<std::size_t>(std::snprintf(text, sizeof text, "%.17g", number))};
#endif
}

}  // namespace

std::string number_text(double number) {
  Digits text;
  return std::string(write(number, text));
}

void append_cell(const std::string& text, std::string& csv) { (csv += ',') += text; }

void append_cell(double number, std::string& csv) {
  Digits text;
  (csv += ',') += write(number, text);
}

void append_cells(const Eigen::Vector3d& vector, std::string& csv) {
  for (int axis = 0; axis < 3; ++axis) append_cell(vector[axis], csv);
}

void append_empty_cells(std::size_t count, std::string& csv) { csv.append(count, ','); }

}  // namespace organ_collision
