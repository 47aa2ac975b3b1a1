#include "offline/input_error.hpp"

#include <gtest/gtest.h>

namespace organ_collision {
namespace {

TEST(InputError, names_file_and_line) {
  EXPECT_STREQ(InputError("liver.obj", 12, "x is abc").what(), "liver.obj:12: x is abc");
}

TEST(InputError, puts_in_quotes_what_can_stand_in_one_line) {
  EXPECT_EQ(in_quotes("a b"), "\"a b\"");
  EXPECT_EQ(in_quotes(""), "\"\"");
  EXPECT_EQ(in_quotes(std::string_view("a\nb\tc\0d\x7f", 8)), "\"a?b?c?d?\"");
  EXPECT_EQ(in_quotes(std::string(60, 'x')), '"' + std::string(60, 'x') + '"');
  EXPECT_EQ(in_quotes(std::string(61, 'x')), '"' + std::string(60, 'x') + "...\"");
}

}  // namespace
}  // namespace organ_collision
