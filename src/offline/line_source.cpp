#include "line_source.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <stdexcept>
#include <string>
#include <system_error>

namespace organ_collision {
namespace {

constexpr std::size_t kPiece = 1 << 16;  // [bytes]

[[noreturn]] void fail() { throw std::system_error(errno, std::generic_category()); }

constexpr int kForEver = -1;

/// Waits at most so long [ms].
bool has_input(int descriptor, int wait) {
  pollfd wanted{descriptor, POLLIN, 0};
  const int ready = poll(&wanted, 1, wait);
  if (ready < 0 && errno != EINTR) fail();
  return ready > 0;
}

/// Whether read() is to be called again. If a pipe does not block, waits for its input.
bool is_interrupted(int descriptor) {
  if (errno == EINTR) return true;
  if (errno != EAGAIN) return false;
  has_input(descriptor, kForEver);
  return true;
}

}  // namespace

bool LineSource::next() {
  while (!find_line_end() && !at_end_) read_piece();
  if (begin_ == buffer_.size()) return false;
  ends_within_line_ = searched_ == buffer_.size();
  line_ = std::string_view(buffer_).substr(begin_, searched_ - begin_);
  begin_ = searched_ = std::min(searched_ + 1, buffer_.size());
  return true;
}

bool LineSource::is_ready() {
  while (!find_line_end() && !at_end_) {
    if (!has_input(descriptor_, 0)) return false;
    read_piece();
  }
  return true;
}

/// Moves searched_ to the end of the next line. Returns false, at the end of what was read, if its
/// line feed has not arrived. Throws std::length_error.
bool LineSource::find_line_end() {
  searched_ = std::min(buffer_.find('\n', searched_), buffer_.size());
  if (searched_ - begin_ > kLongestLine) {
    throw std::length_error("the line has more than " + std::to_string(kLongestLine) +
                            " bytes; must be shorter, with a line feed at its end");
  }
  return searched_ < buffer_.size();
}

void LineSource::read_piece() {
  buffer_.erase(0, begin_);
  searched_ -= begin_;
  begin_ = 0;
  const std::size_t size = buffer_.size();
  buffer_.resize(size + kPiece);
  ssize_t count = 0;
  do {
    count = read(descriptor_, &buffer_[size], kPiece);
  } while (count < 0 && is_interrupted(descriptor_));
  buffer_.resize(size + static_cast<std::size_t>(count > 0 ? count : 0));
  if (count < 0) fail();
  at_end_ = count == 0;
}

}  // namespace organ_collision
