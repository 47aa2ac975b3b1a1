#include "ros/parameters/live_parameters.hpp"

#include <gtest/gtest.h>

#include "ros/parameters/program_help.hpp"

using namespace organ_collision;

namespace {

const std::vector<LiveParameter> kParameters = {{"rate", "[Hz]", 1.0, 0.0, {0.0, 10.0}},
                                                {"loud", "", true, false}};

XmlRpc::XmlRpcValue change(const char* name, const XmlRpc::XmlRpcValue& value) {
  XmlRpc::XmlRpcValue changes;
  changes[name] = value;
  return changes;
}

}  // namespace

// test/rostest/live_changes_test.py tests the topics and the service.

TEST(LiveParameters, ChangesAreAGroupOfParameters) {
  const ParameterGroup group = live_group(change("rate", 5), kParameters);
  EXPECT_EQ(group.number("rate", 1.0, kParameters[0].range), 5.0);
  EXPECT_TRUE(group.flag("loud", true));
}

TEST(LiveParameters, AnIllegalValueIsRefusedByItsRange) {
  const ParameterGroup group = live_group(change("rate", 10.5), kParameters);
  EXPECT_THROW(group.number("rate", 1.0, kParameters[0].range), ParameterError);
}

TEST(LiveParameters, AnUnknownNameIsRefused) {
  try {
    live_group(change("rates", 5), kParameters);
    ADD_FAILURE() << "accepted";
  } catch (const ParameterError& error) {
    EXPECT_EQ(std::string(error.what()),
              "~rates is no parameter; nearest is 'rate', legal are rate, loud");
  }
}

using namespace organ_collision;

namespace {

ProgramHelp help() {
  ProgramHelp help{"cutter", "Cuts what it is told to cut."};
  help.published = {{"pieces", "std_msgs/Int32", "how many there are"}};
  help.parameters = {{"~depth", "0.5", "[m] of a cut"}};
  return help;
}

struct Answer {
  std::optional<int> exit_code;
  std::string out, err;
};

Answer answer(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "/path/of/cutter");
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  const auto exit_code = answer_arguments(static_cast<int>(argv.size()), argv.data(), help());
  return {exit_code, testing::internal::GetCapturedStdout(),
          testing::internal::GetCapturedStderr()};
}

}  // namespace

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

TEST(ProgramHelp, IsPrintedWhenAskedFor) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"--help"}, {"-h"}, {"__name:=other", "--help"}, {"-x", "-h"}}) {
    const Answer found = answer(arguments);
    EXPECT_EQ(found.exit_code, 0);
    EXPECT_EQ(found.out, help_text(help()));
    EXPECT_EQ(found.err, "");
  }
}

TEST(ProgramHelp, RosArgumentsAreNotAnswered) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{}, {"__name:=other", "_depth:=1", "pieces:=parts"}}) {
    const Answer found = answer(arguments);
    EXPECT_EQ(found.exit_code, std::nullopt);
    EXPECT_EQ(found.out + found.err, "");
  }
}

TEST(ProgramHelp, OtherArgumentsAreRefusedInOneLine) {
  for (const char* argument : {"--depth", "-x", "deep"}) {
    const Answer found = answer({"__name:=other", argument});
    EXPECT_EQ(found.exit_code, 2);
    EXPECT_EQ(found.out, "");
    EXPECT_EQ(found.err, "cutter: unknown argument '" + std::string(argument) +
                             "'; legal are --help, and ROS's NAME:=VALUE\n");
  }
}

TEST(ProgramHelp, DefaultsAreShownAsTheyAreWrittenInYaml) {
  EXPECT_EQ(shown(false), "false");
  EXPECT_EQ(shown(2'000'000), "2000000");
  EXPECT_EQ(shown(0.02), "0.02");
}

TEST(ProgramHelp, TextsAreFoundByName) {
  EXPECT_EQ(text_of(help().parameters, "~depth"), "[m] of a cut");
  EXPECT_THROW(text_of(help().parameters, "~width"), std::out_of_range);
}
