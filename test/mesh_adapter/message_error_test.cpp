#include "mesh_adapter/message_error.hpp"

#include <gtest/gtest.h>

TEST(MessageError, HasReasonAndMessage) {
  const organ_collision::MessageError error("truncated cloud", "data has 3 bytes");
  EXPECT_EQ(error.reason(), "truncated cloud");
  EXPECT_STREQ(error.what(), "data has 3 bytes");
}
