#pragma once

#include <organ_collision/ContactArray.h>
#include <ros/time.h>

#include <cstdint>
#include <string>

#include "ros/organs/deformable_organ.hpp"
#include "ros/parameters/node_parameters.hpp"

namespace organ_collision {

/// An answer about one organ and one tool, a shaft alone, still without contacts; header.stamp and
/// step_start are `stamp`. The names are those of a message and need not be legal: the answer has
/// them as plain text of at most kLongestName bytes (plain_text.hpp).
ContactArray answer_about(const std::string& organ, const std::string& tool, std::uint8_t mode,
                          ros::Time stamp);

/// The names of the tool's parts, as ContactArray has them.
void set_links(ContactArray& answer, const ToolParameters& tool);

/// Frame, topology and mesh stamp of the shape that the answer is about.
void set_organ(ContactArray& answer, const DeformableOrgan& organ, const OrganShape& shape);

/// The message is cut to kLongestMessage bytes of plain text.
void set_failure(ContactArray& answer, std::uint8_t status, const std::string& message);

/// Whether the shape is older than `timeout_sec`; 0: never.
bool is_stale(const OrganShape& shape, ros::Time now, double timeout_sec);
/// Says so, with the age and the limit.
std::string stale_message(const DeformableOrgan& organ, ros::Time now, double timeout_sec);

}  // namespace organ_collision
