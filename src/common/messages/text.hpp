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

/// Turns a text into plain text of at most `most` bytes (64 or more). A space replaces each control
/// character, and a question mark each byte that is not UTF-8. A shortened text ends with the
/// number of bytes that were left out.
std::string plain_text(const std::string& text, std::size_t most);

/// "1 face", "2208 faces". `noun`: a noun whose plural ends with an s.
std::string counted(std::size_t count, const std::string& noun);

/// "a, b, c"
std::string listed(const std::vector<std::string>& texts);
/// The same, with each text in quotes.
std::string quoted(std::vector<std::string> texts);

/// What is wrong with a name, as "'NAME' has 300 bytes; a name must ..."; empty if it is legal. A
/// legal name is plain text of at most kLongestName bytes (plain_text()). It may be empty.
std::string name_fault(const std::string& name);

/// The name in `legal` that needs the fewest insertions, deletions and replacements of a letter to
/// become `name` (Levenshtein distance). If several names need equally many, the first one. `legal`
/// must not be empty.
std::string nearest_name(const std::string& name, const std::vector<std::string>& legal);

/// "nearest is 'NEAREST', legal are ..."
std::string suggestion(const std::string& name, const std::vector<std::string>& legal);

/// A duration with three significant digits: "7.3 ms" below one second, otherwise "2.41 s". From
/// 1000 s on, it is rounded to whole seconds.
std::string duration_text(double seconds);

}  // namespace organ_collision
