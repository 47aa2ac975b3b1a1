#include "ros/interface/rejection.hpp"

#include <gtest/gtest.h>
#include <organ_collision/ContactArray.h>

#include <set>
#include <string>

using namespace organ_collision;

TEST(Rejection, KeepsWhatItWasMadeOf) {
  const Rejection rejection(4, "wrong size", "7 numbers; must be a multiple of 3");
  EXPECT_EQ(rejection.status(), 4);
  EXPECT_EQ(rejection.reason(), "wrong size");
  EXPECT_STREQ(rejection.what(), "7 numbers; must be a multiple of 3");
}

TEST(Rejection, EachStatusHasItsOwnReason) {
  std::set<std::string> reasons;
  for (std::uint8_t status = 0; status <= ContactArray::INVALID_TOOL; ++status) {
    reasons.insert(reason_of(status));
  }
  EXPECT_EQ(reasons.size(), ContactArray::INVALID_TOOL + 1u);
}

TEST(Rejection, IllegalNames) {
  check_name("organ", "liver");
  check_name("organ", "");
  try {
    check_name("organ", "li\nver");
    ADD_FAILURE();
  } catch (const Rejection& rejection) {
    EXPECT_EQ(rejection.status(), ContactArray::INVALID_REQUEST);
    EXPECT_EQ(rejection.reason(), "illegal name");
    EXPECT_EQ(std::string(rejection.what()).rfind("organ 'li ver' has control characters", 0), 0U)
        << rejection.what();
  }
}
