#pragma once

#include <cstddef>
#include <string>

namespace organ_collision {

// Text comes with messages, and from TF, in any size and form. What goes on into answers and logs
// is plain: UTF-8 without control characters, which Python subscribers can read and which does not
// steer a terminal.

/// [bytes] The longest legal name of an organ, a tool, a link or a frame.
inline constexpr std::size_t kLongestName = 256;
/// [bytes] The longest message of an answer, and of a failure in the log and on /diagnostics.
inline constexpr std::size_t kLongestMessage = 2000;

/// The text as plain text of at most `most` bytes, at least 64. A space stands for each control
/// character, and a question mark for each byte that is no UTF-8. Where the text is cut, its end
/// says how many bytes are missing.
std::string plain_text(const std::string& text, std::size_t most);

/// What is wrong with a name, as "'NAME' has 300 bytes; a name must ..."; empty if nothing is. A
/// legal name is plain and has at most kLongestName bytes. An empty name passes.
std::string name_fault(const std::string& name);

}  // namespace organ_collision
