#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <string>

namespace organ_collision {

/// A parser that gets bytes of which nothing is known. What it must not do is crash, hang, take
/// much memory or throw. Each source defines static ones, which the program `fuzz` knows by their
/// names.
struct FuzzTarget {
  using Run = std::function<void(const std::uint8_t* data, std::size_t size)>;
  FuzzTarget(const char* name, Run run);
};

/// Ends the program, as a crash does, if something does not hold that must hold for each input.
inline void demand(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "This must hold, but does not: %s\n", what);
  std::abort();
}

/// The bytes of an input, read from front to back. After the end, all bytes are 0.
class FuzzInput {
 public:
  FuzzInput(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {}

  bool empty() const { return left_ == 0; }
  std::uint8_t byte() { return number<std::uint8_t>(); }

  /// Any value of the type, also infinity and NaN.
  template <typename Number>
  Number number() {
    Number number{};
    const std::size_t size = std::min(sizeof(number), left_);
    if (size > 0) std::memcpy(&number, data_, size);
    skip(size);
    return number;
  }

  /// At most `size` bytes.
  std::string text(std::size_t size) {
    const std::size_t taken = std::min(size, left_);
    std::string text(reinterpret_cast<const char*>(data_), taken);
    skip(taken);
    return text;
  }
  std::string rest() { return text(left_); }

 private:
  void skip(std::size_t size) {
    data_ += size;
    left_ -= size;
  }

  const std::uint8_t* data_;
  std::size_t left_;
};

}  // namespace organ_collision
