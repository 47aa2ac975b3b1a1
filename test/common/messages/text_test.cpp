#include "common/messages/text.hpp"

#include <gtest/gtest.h>

#include <random>

namespace organ_collision {
namespace {

constexpr std::size_t kMost = 100;

std::string repeated(const std::string& text, std::size_t times) {
  std::string all;
  for (std::size_t i = 0; i < times; ++i) all += text;
  return all;
}

TEST(PlainText, ControlCharactersAndBytesThatAreNoUtf8AreReplaced) {
  const std::pair<std::string, std::string> rows[] = {
      {"", ""},
      {"a b/c", "a b/c"},
      {"ø肝臓🫀\u00A0\uFFFD", "ø肝臓🫀\u00A0\uFFFD"},
      {"a\nb\tc\x1B[31md\x7F", "a b c [31md "},
      {std::string("a\0b", 3), "a b"},
      {"a\u0085b\u009Bc\u009F", "a b c "},
      {"a\xFF\xFE", "a??"},
      {"\x80", "?"},
      {"\xC3(", "?("},
      {"\xE8\x82", "??"},
      {"\xC0\xAF", "??"},            // overlong
      {"\xE0\x80\xAF", "???"},       // overlong
      {"\xF0\x80\x80\xAF", "????"},  // overlong
      {"\xED\xA0\x80", "???"},       // surrogate
      {"\xF4\x90\x80\x80", "????"},  // beyond U+10FFFF
      {std::string(kMost, 'x'), std::string(kMost, 'x')},
      {std::string(kMost + 1, 'x'), std::string(60, 'x') + "... (41 more bytes)"},
      {"y" + repeated("肝", 40), "y" + repeated("肝", 19) + "... (63 more bytes)"},
      {std::string(10'000'000, '\n'), std::string(60, ' ') + "... (9999940 more bytes)"}};
  for (const auto& [text, plain] : rows) EXPECT_EQ(plain_text(text, kMost), plain);
}

TEST(Text, DurationsHaveThreeDigitsOrAllBeforeThePoint) {
  EXPECT_EQ(duration_text(0.0), "0 ms");
  EXPECT_EQ(duration_text(0.0073), "7.3 ms");
  EXPECT_EQ(duration_text(0.020004), "20 ms");
  EXPECT_EQ(duration_text(0.9994), "999 ms");
  EXPECT_EQ(duration_text(0.9999), "1 s");
  EXPECT_EQ(duration_text(2.4123), "2.41 s");
  EXPECT_EQ(duration_text(999.9), "1000 s");
  EXPECT_EQ(duration_text(123456.7), "123457 s");
}

TEST(LegalName, TheFirstOfThoseWithTheFewestEditsIsTheNearest) {
  const struct {
    std::string name;
    std::vector<std::string> legal;
    std::string nearest;
  } rows[] = {{"b", {"a", "c"}, "a"},
              {"rates", {"radius", "rate", "raters"}, "rate"},  // One deletion.
              {"rte", {"route_s", "rotten", "rate"}, "rate"},   // One insertion.
              {"raduis", {"rates", "radium", "radius"}, "radius"},
              {"kitten", {"sitting", "mittens", "knitting"}, "mittens"},
              {"saturday", {"monday", "sunday", "friday"}, "sunday"},
              {"", {"abc", "ab"}, "ab"}};
  for (const auto& row : rows) EXPECT_EQ(nearest_name(row.name, row.legal), row.nearest);
}

TEST(LegalName, AFaultSaysWhatIsWrongAndWhatIsLegal) {
  for (const std::string name : {"", "liver", "a b/c", "肝臓"}) EXPECT_EQ(name_fault(name), "");
  EXPECT_EQ(name_fault(std::string(kLongestName, 'x')), "");
  const std::string too_long = name_fault(std::string(kLongestName + 1, 'x'));
  EXPECT_NE(too_long.find("has 257 bytes; a name must be"), std::string::npos) << too_long;
  EXPECT_LT(too_long.size(), 2 * kLongestName);
  EXPECT_EQ(name_fault("a\nb"),
            "'a b' has control characters, or bytes that are no UTF-8; a name must be UTF-8 "
            "without control characters, of at most 256 bytes");
  EXPECT_NE(name_fault("\xFF"), "");
}

}  // namespace
}  // namespace organ_collision
