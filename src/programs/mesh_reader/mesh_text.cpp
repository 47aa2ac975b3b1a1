#include "mesh_text.hpp"

#include <algorithm>
#include <utility>

#include "geometry/concatenate.hpp"

namespace organ_collision {

MeshText::MeshText(std::string file, std::string_view content, char comment, bool continues)
    : file_(std::move(file)),
      content_(without_byte_order_mark(content)),
      comment_(comment),
      continues_(continues) {
  const std::size_t end = content_.find_first_of("\r\n");
  has_lone_returns_ =
      end != std::string_view::npos && content_[end] == '\r' && content_.substr(end, 2) != "\r\n";
}

bool MeshText::next() {
  words_.clear();
  while (words_.empty() && begin_ < content_.size()) {
    line_ = lines_ + 1;
    while (add_words_of_line() && begin_ < content_.size()) continue;
  }
  return !words_.empty();
}

/// Returns whether the next line continues this one.
bool MeshText::add_words_of_line() {
  const std::size_t end = std::min(content_.find_first_of("\r\n", begin_), content_.size());
  std::string_view line = content_.substr(begin_, end - begin_);
  const bool ends_with_both = !has_lone_returns_ && content_.substr(end, 2) == "\r\n";
  begin_ = std::min(end + (ends_with_both ? 2 : 1), content_.size());
  ++lines_;
  const std::size_t comment = line.find(comment_);
  line = trimmed(line.substr(0, comment));
  const bool continues =
      continues_ && comment == std::string_view::npos && !line.empty() && line.back() == '\\';
  if (continues) line.remove_suffix(1);
  split_words(line, words_of_line_);
  words_.insert(words_.end(), words_of_line_.begin(), words_of_line_.end());
  return continues;
}

std::string_view MeshText::word(std::size_t place) const {
  if (place < words_.size()) return words_[place];
  throw error(concatenate("the line has ", words_.size(), " words; must have more"));
}

double MeshText::number(std::size_t place) const {
  const std::optional<double> number = parse_number(word(place));
  if (number) return *number;
  throw error(in_quotes(word(place)) + " is no number");
}

std::string_view MeshText::rest() {
  line_ = 0;
  return content_.substr(begin_);
}

InputError MeshText::error(const std::string& message, std::size_t line) const {
  return line == 0 ? InputError(file_ + ": " + message) : InputError(file_, line, message);
}

}  // namespace organ_collision
