#include "ros/interface/rejection.hpp"

#include <gtest/gtest.h>
#include <organ_collision/ContactArray.h>

TEST(Rejection, KeepsWhatItWasMadeOf) {
  const organ_collision::Rejection rejection(4, "wrong size", "7 numbers; must be a multiple of 3");
  EXPECT_EQ(rejection.status(), 4);
  EXPECT_EQ(rejection.reason(), "wrong size");
  EXPECT_STREQ(rejection.what(), "7 numbers; must be a multiple of 3");
}

TEST(Rejection, IllegalNames) {
  organ_collision::check_name("organ", "liver");
  organ_collision::check_name("organ", "");
  try {
    organ_collision::check_name("organ", "li\nver");
    ADD_FAILURE();
  } catch (const organ_collision::Rejection& rejection) {
    EXPECT_EQ(rejection.status(), organ_collision::ContactArray::INVALID_REQUEST);
    EXPECT_EQ(rejection.reason(), "illegal name");
    EXPECT_EQ(std::string(rejection.what()).rfind("organ 'li ver' has control characters", 0), 0U)
        << rejection.what();
  }
}
