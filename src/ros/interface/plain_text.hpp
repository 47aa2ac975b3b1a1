#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace organ_collision {

// Messages and TF bring text of any length and content. Answers and logs contain only plain text:
// UTF-8 without control characters. Python subscribers can decode it, and it contains no commands
// to a terminal.

/// [bytes] The longest legal name of an organ, a tool, a link or a frame.
inline constexpr std::size_t kLongestName = 256;
/// [bytes] The longest message of an answer, and of a failure in the log and on /diagnostics.
inline constexpr std::size_t kLongestMessage = 2000;

/// The text as plain text of at most `most` bytes (64 or more). A space replaces each control
/// character, and a question mark each byte that is not UTF-8. A shortened text ends with the
/// number of bytes that were left out.
std::string plain_text(const std::string& text, std::size_t most);

/// "1 face", "2208 faces". `noun`: one whose plural ends with an s.
std::string counted(std::size_t count, const std::string& noun);

/// "a, b, c"
std::string listed(const std::vector<std::string>& texts);

}  // namespace organ_collision
