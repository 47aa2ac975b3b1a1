#include "check_options.hpp"

#include <cmath>
#include <cstdlib>
#include <stdexcept>

namespace organ_collision {
namespace {

constexpr char kSeconds[] = "--seconds";

double seconds(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !std::isfinite(value) || !(value > 0.0)) {
    throw std::invalid_argument("--seconds is '" + text + "'; must be a positive number");
  }
  return value;
}

}  // namespace

CheckOptions parse_check_options(const std::vector<std::string>& arguments) {
  CheckOptions options;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string& word = arguments[i];
    if (word == "--help" || word == "-h") {
      options.help = true;
    } else if (word == kSeconds) {
      if (++i == arguments.size()) throw std::invalid_argument("--seconds needs a number");
      options.seconds = seconds(arguments[i]);
    } else if (word.empty() || word[0] == '-') {
      throw std::invalid_argument("unknown option '" + word +
                                  "'; legal are TOPIC, --seconds and --help");
    } else {
      options.topics.push_back(word);
    }
  }
  if (options.topics.empty()) options.topics = {"organ_collision/contacts"};
  return options;
}

std::string check_usage() {
  return R"(Usage: rosrun organ_collision check_contacts [TOPIC ...] [--seconds S]

Watches topics of type organ_collision/ContactArray for answers that break the contract of the
message files, and prints what it finds: each kind at most once a second, with topic, organ, tool,
stamp and value. When it ends, it prints how many answers came, and how many broke which rule.

  TOPIC        may be given several times; organ_collision/contacts by default
  --seconds S  ends after S seconds, by the wall clock; by default it runs until Ctrl-C
  --help       this text

What is checked: numbers are finite; fractions and places on the shaft are from 0 to 1; normals have
length 1; barycentric coordinates are from 0 to 1, with the sum 1; links and faces exist; contacts
rise by face and link, near faces by distance; names are legal; a failure has a message and nothing
else; static answers have no time but one; clearance and placement agree with themselves; a swept
step begins where the last successful step of its organ and tool ended.

Services:
  ~summary (std_srvs/Trigger)
      what was found so far, in words; `success` is false if something was found

Exit status: 0 nothing found; 1 something found; 2 an illegal option; 3 no answer came.
)";
}

}  // namespace organ_collision
