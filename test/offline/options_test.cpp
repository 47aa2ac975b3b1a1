#include "offline/options.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "offline/command_line.hpp"
#include "temporary_files.hpp"

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

std::string reported(std::optional<std::size_t> total) {
  Progress progress(total);
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));
  testing::internal::CaptureStderr();
  progress.report(3);
  return testing::internal::GetCapturedStderr();
}

TEST(Progress, is_told_with_the_total_if_that_is_known) {
  EXPECT_EQ(reported(7), "query_offline: 3 of 7 motions\n");
  EXPECT_EQ(reported(std::nullopt), "query_offline: 3 motions\n");
}

using Arguments = std::vector<std::string>;

TEST(Options, takes_the_mesh_and_the_motions) {
  const Options options = parse_options({"--motions", "m.csv", "--mesh", "a=b.obj"});
  EXPECT_EQ(options.mesh, "a=b.obj");
  EXPECT_EQ(options.motions, "m.csv");
  EXPECT_EQ(options.mesh_before, "");
  EXPECT_EQ(options.shapes, "");
  EXPECT_GE(options.jobs, 1U);
  EXPECT_FALSE(options.blank_lines);
  EXPECT_EQ(options.picker.kind, PickerKind::kFeedback);
  EXPECT_EQ(options.picker.gl, GlPlatform::kAuto);
  EXPECT_FALSE(options.help);
}

TEST(Options, takes_the_earlier_mesh_and_the_picker) {
  const Options options = parse_options(
      {"--mesh=a.obj", "--picker=select", "--mesh-before=old=er.obj", "--motions=m.csv"});
  EXPECT_EQ(options.mesh, "a.obj");
  EXPECT_EQ(options.mesh_before, "old=er.obj");
  EXPECT_EQ(options.picker.kind, PickerKind::kSelect);
}

TEST(Options, takes_the_platform_of_opengl) {
  const Options options = parse_options({"--mesh=a.obj", "--motions=m.csv", "--gl", "egl"});
  EXPECT_EQ(options.picker.kind, PickerKind::kFeedback);
  EXPECT_EQ(options.picker.gl, GlPlatform::kEgl);
}

TEST(Options, takes_standard_input_threads_and_blank_lines) {
  const Options options =
      parse_options({"--mesh=a.obj", "--motions", "-", "--jobs", "3", "--blank-lines"});
  EXPECT_EQ(options.motions, kStandardInput);
  EXPECT_EQ(options.jobs, 3U);
  EXPECT_TRUE(options.blank_lines);
}

TEST(Options, takes_shapes_instead_of_a_mesh) {
  const Options options = parse_options({"--shapes", "folder", "--motions", "m.csv"});
  EXPECT_EQ(options.shapes, "folder");
  EXPECT_EQ(options.mesh, "");
  for (const std::string other : {"--mesh", "--mesh-before"}) {
    EXPECT_EQ(input_error([&] {
                parse_options({"--shapes=folder", "--motions=m.csv", other, "a.obj"});
              }),
              "query_offline: options --shapes and " + other +
                  " are given; the folder has all shapes (--help explains)");
  }
}

TEST(Options, refuses_illegal_numbers_of_threads) {
  for (const std::string text : {"0", "-2", "1025", "two", "1.0", "99999999999999999999"}) {
    EXPECT_EQ(input_error([&] {
                parse_options({"--mesh=a.obj", "--motions=m.csv", "--jobs", text});
              }),
              "query_offline: --jobs is \"" + text +
                  "\"; must be a whole number from 1 to 1024 (--help explains)");
  }
}

TEST(Options, asks_for_clearance_and_placement) {
  const Arguments files{"--mesh=a.obj", "--motions=m.csv"};
  const auto options_with = [&](Arguments arguments) {
    arguments.insert(arguments.end(), files.begin(), files.end());
    return parse_options(arguments);
  };
  const Options none = options_with({});
  EXPECT_EQ(none.margin, 0.0);
  EXPECT_FALSE(none.clearance);
  EXPECT_FALSE(none.placement);
  EXPECT_EQ(options_with({"--margin", "0.02"}).margin, 0.02);
  EXPECT_EQ(options_with({"--margin=1e4"}).margin, 1e4);
  const Options all = options_with({"--clearance", "--placement", "--margin", "1e-9"});
  EXPECT_EQ(all.margin, 1e-9);
  EXPECT_TRUE(all.clearance);
  EXPECT_TRUE(all.placement);
}

TEST(Options, refuses_an_illegal_margin_with_its_value) {
  for (const std::string text : {"-0.01", "0", "nan", "inf", "-inf", "1e999", "2mm", "1,5"}) {
    EXPECT_EQ(input_error([&] {
                parse_options({"--mesh=a.obj", "--motions=m.csv", "--margin=" + text});
              }),
              "query_offline: --margin is \"" + text +
                  "\"; must be a finite number above 0, in metres (--help explains)");
  }
}

TEST(Options, needs_nothing_else_for_help) {
  EXPECT_TRUE(parse_options({"--help"}).help);
  EXPECT_TRUE(parse_options({"--mesh", "a.obj", "-h"}).help);
  for (const char* name :
       {"--mesh ", "--motions ", "--mesh-before ", "--picker ", "--margin ", "--clearance ",
        "--placement ", "--shapes ", "--jobs ", "--blank-lines ", "--help "}) {
    EXPECT_NE(usage().find(name), std::string::npos) << name;
  }
}

TEST(Options, refuses_what_it_cannot_use) {
  const Arguments good{"--mesh", "a.obj", "--motions", "m.csv"};
  const auto refusal = [&](const Arguments& more, bool after_good = true) {
    Arguments arguments = after_good ? good : Arguments();
    arguments.insert(arguments.end(), more.begin(), more.end());
    return input_error([&] { parse_options(arguments); });
  };
  const std::string legal =
      "; legal are --mesh, --motions, --mesh-before, --shapes, --jobs, --picker, --gl, --margin, "
      "--clearance, --placement, --blank-lines and --help (--help explains)";
  EXPECT_EQ(refusal({"--mseh", "b.obj"}), "query_offline: unknown option \"--mseh\"" + legal);
  EXPECT_EQ(refusal({"b.obj"}), "query_offline: unknown option \"b.obj\"" + legal);
  EXPECT_EQ(refusal({""}), "query_offline: unknown option \"\"" + legal);
  EXPECT_EQ(refusal({"--mesh", "b.obj"}),
            "query_offline: option --mesh is given twice (--help explains)");
  EXPECT_EQ(refusal({"--picker"}), "query_offline: option --picker has no value (--help explains)");
  EXPECT_EQ(refusal({"--picker="}),
            "query_offline: option --picker has no value (--help explains)");
  EXPECT_EQ(refusal({"--mesh", "--motions", "m.csv"}, false),
            "query_offline: option --mesh has no value (--help explains)");
  EXPECT_EQ(refusal({"--mesh", "a.obj"}, false),
            "query_offline: option --motions is missing (--help explains)");
  EXPECT_EQ(refusal({}, false), "query_offline: option --mesh is missing (--help explains)");

  const std::string picker = refusal({"--picker", "best"});
  for (const char* word : {"best", "feedback", "select"}) {
    EXPECT_NE(picker.find(word), std::string::npos) << picker;
  }
}

}  // namespace

}  // namespace organ_collision
