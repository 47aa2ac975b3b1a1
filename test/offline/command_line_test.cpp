#include "offline/command_line.hpp"

#include <gtest/gtest.h>

#include "temporary_file.hpp"

namespace organ_collision {
namespace {

using Words = std::vector<std::string>;

const CommandLine::Grammar kGrammar{"prog", {"--in", "--size"}, {"--quick"}, true};
const CommandLine::Grammar kWithoutFiles{"prog", {"--in"}};

std::string refusal(const CommandLine::Grammar& grammar, const Words& words) {
  return input_error([&] { CommandLine(grammar, words); });
}

TEST(CommandLine, splits_options_flags_and_files) {
  const CommandLine given(kGrammar, {"a.bag", "--in", "x", "b.bag", "--size=1=2", "--quick", "-3"});
  EXPECT_EQ(given.value("--in"), "x");
  EXPECT_EQ(given.required("--size"), "1=2");
  EXPECT_TRUE(given.has("--quick"));
  EXPECT_EQ(given.files(), (Words{"a.bag", "b.bag", "-3"}));
}

TEST(CommandLine, takes_a_negative_number_as_a_value) {
  EXPECT_EQ(CommandLine(kGrammar, {"--size", "-0.5"}).value("--size"), "-0.5");
}

TEST(CommandLine, says_what_is_not_given) {
  const CommandLine given(kGrammar, {});
  EXPECT_FALSE(given.has("--in"));
  EXPECT_FALSE(given.has("--quick"));
  EXPECT_EQ(given.value("--in"), "");
  EXPECT_TRUE(given.files().empty());
  EXPECT_EQ(input_error([&] { given.required("--in"); }),
            "prog: option --in is missing (--help explains)");
  EXPECT_EQ(input_error([&] { given.refuse("no"); }), "prog: no (--help explains)");
}

TEST(CommandLine, refuses_what_the_program_does_not_understand) {
  const std::string end = " (--help explains)";
  EXPECT_EQ(refusal(kGrammar, {"--fast"}),
            "prog: unknown option \"--fast\"; legal are --in, --size, --quick and --help" + end);
  EXPECT_EQ(refusal(kWithoutFiles, {"a.bag"}),
            "prog: unknown option \"a.bag\"; legal are --in and --help" + end);
  EXPECT_EQ(refusal(kGrammar, {"--in", "--quick"}), "prog: option --in has no value" + end);
  EXPECT_EQ(refusal(kGrammar, {"--in="}), "prog: option --in has no value" + end);
  EXPECT_EQ(refusal(kGrammar, {"--quick=1"}), "prog: option --quick takes no value" + end);
  EXPECT_EQ(refusal(kGrammar, {"--quick", "--quick"}), "prog: option --quick is given twice" + end);
  EXPECT_EQ(refusal(kGrammar, {"--in=a", "--in", "b"}), "prog: option --in is given twice" + end);
}

TEST(CommandLine, sees_a_call_for_help_anywhere) {
  EXPECT_TRUE(asks_for_help({"--in", "--help"}));
  EXPECT_TRUE(asks_for_help({"a.bag", "-h"}));
  EXPECT_FALSE(asks_for_help({"a.bag", "help"}));
}

}  // namespace
}  // namespace organ_collision
