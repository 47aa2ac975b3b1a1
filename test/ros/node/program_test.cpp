#include "ros/node/program.hpp"

#include <gtest/gtest.h>

namespace organ_collision {
namespace {

ProgramHelp help() {
  ProgramHelp help{"cutter", "Cuts what it is told to cut."};
  help.published = {{"pieces", "std_msgs/Int32", "how many there are"}};
  help.parameters = {{"~depth", "0.5", "[m] of a cut"}};
  return help;
}

TEST(ProgramHelp, ShowsWhatThereIsAndNoEmptySection) {
  EXPECT_EQ(help_text(help()),
            "Usage: rosrun organ_collision cutter [NAME:=VALUE ...]\n\n"
            "Cuts what it is told to cut.\n\n"
            "Published topics:\n  pieces (std_msgs/Int32)\n      how many there are\n\n"
            "Parameters, private (~), with their defaults:\n  ~depth (0.5)\n      [m] of a cut\n");
}

TEST(ProgramHelp, LongTextsAreWrappedBetweenWords) {
  ProgramHelp longer = help();
  longer.purpose.clear();
  for (int i = 0; i < 100; ++i) longer.purpose += "word ";
  std::istringstream lines(help_text(longer));
  int words = 0;
  for (std::string line; std::getline(lines, line);) {
    EXPECT_LE(line.size(), 100u) << line;
    if (line.rfind("word", 0) == 0) words += static_cast<int>(line.size() + 1) / 5;
  }
  EXPECT_EQ(words, 100);
}

TEST(ProgramHelp, ArgumentsAreAnsweredUnlessTheyAreForRos) {
  struct Case {
    std::vector<std::string> arguments;
    std::optional<int> exit_code;
    std::string out, err;
  };
  const std::string unknown = "cutter: unknown argument '";
  const std::string legal = "'; legal are --help, and ROS's NAME:=VALUE\n";
  const std::vector<Case> cases = {
      {{"--help"}, 0, help_text(help()), ""},
      {{"-h"}, 0, help_text(help()), ""},
      {{"__name:=other", "--help"}, 0, help_text(help()), ""},
      {{"-x", "-h"}, 0, help_text(help()), ""},
      {{}, std::nullopt, "", ""},
      {{"__name:=other", "_depth:=1", "pieces:=parts"}, std::nullopt, "", ""},
      {{"__name:=other", "--depth"}, 2, "", unknown + "--depth" + legal},
      {{"-x"}, 2, "", unknown + "-x" + legal},
      {{"deep"}, 2, "", unknown + "deep" + legal},
  };
  for (const Case& row : cases) {
    std::vector<std::string> arguments = row.arguments;
    arguments.insert(arguments.begin(), "/path/of/cutter");
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    const auto exit_code = answer_arguments(static_cast<int>(argv.size()), argv.data(), help());
    EXPECT_EQ(testing::internal::GetCapturedStdout(), row.out);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), row.err);
    EXPECT_EQ(exit_code, row.exit_code);
  }
}

}  // namespace
}  // namespace organ_collision
