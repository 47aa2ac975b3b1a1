#include "text_reader.hpp"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace organ_collision {
namespace {

constexpr std::size_t kPiece = 1 << 16;  // [bytes] read at once, at most
constexpr int kForEver = -1;

}  // namespace

TextReader::TextReader(std::string file)
    : file_(std::move(file)), descriptor_(open(file_.c_str(), O_RDONLY | O_CLOEXEC)) {
  if (descriptor_ < 0) fail("cannot be opened");
}

TextReader::TextReader(StandardInput) : file_("standard input"), descriptor_(STDIN_FILENO) {}

TextReader::~TextReader() {
  if (descriptor_ != STDIN_FILENO) close(descriptor_);
}

bool TextReader::next() {
  find_line(true);
  if (line_.empty()) return false;
  ends_within_line_ = end_ == buffer_.size();
  go_behind_line();
  return true;
}

/// Makes the next line that is not blank the current one. At the end of the file, it is empty.
/// Returns false if more must be read first, and `waits` is false.
bool TextReader::find_line(bool waits) {
  while (true) {
    end_ = std::min(buffer_.find('\n', begin_), buffer_.size());
    if (end_ == buffer_.size() && !at_end_) {
      if (!waits && !has_input(0)) return false;
      read_piece();
      continue;
    }
    line_ = std::string_view(buffer_).substr(begin_, end_ - begin_);
    if (number_ == 0) line_ = without_byte_order_mark(line_);
    line_ = trimmed(line_);
    if (!line_.empty() || begin_ == buffer_.size()) return true;
    go_behind_line();
  }
}

void TextReader::go_behind_line() {
  ++number_;
  begin_ = std::min(end_ + 1, buffer_.size());
}

/// Whether there is input to read. Waits for it, but at most for `wait` [ms].
bool TextReader::has_input(int wait) const {
  pollfd wanted{descriptor_, POLLIN, 0};
  const int ready = TEMP_FAILURE_RETRY(poll(&wanted, 1, wait));
  if (ready < 0) fail("cannot be read");
  return ready > 0;
}

void TextReader::read_piece() {
  has_input(kForEver);  // Otherwise, read() fails if the pipe does not block.
  buffer_.erase(0, begin_);
  begin_ = 0;
  const std::size_t size = buffer_.size();
  buffer_.resize(size + kPiece);
  const ssize_t count = TEMP_FAILURE_RETRY(read(descriptor_, &buffer_[size], kPiece));
  if (count < 0) fail("cannot be read");
  buffer_.resize(size + static_cast<std::size_t>(count));
  at_end_ = count == 0;
}

void TextReader::fail(const std::string& what) const {
  throw InputError(file_ + ": " + what + ": " + std::strerror(errno));
}

}  // namespace organ_collision
