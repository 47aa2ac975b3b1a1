#include "contact_array.hpp"

#include <chrono>

#include "geometry/concatenate.hpp"
#include "ros/interface/conversions.hpp"
#include "ros/interface/plain_text.hpp"
#include "ros/interface/rejection.hpp"

namespace organ_collision {

ContactArray answer_about(const std::string& organ, const std::string& tool, std::uint8_t mode,
                          ros::Time stamp) {
  ContactArray answer;
  answer.header.stamp = stamp;
  answer.step_start = stamp;
  answer.organ = plain_text(organ, kLongestName);
  answer.tool = plain_text(tool, kLongestName);
  answer.links = {""};
  answer.mode = mode;
  return answer;
}

void set_links(ContactArray& answer, const ToolParameters& tool) {
  answer.links.assign(tool.has_shaft() ? 1 : 0, "");
  answer.links.insert(answer.links.end(), tool.links.begin(), tool.links.end());
}

void set_organ(ContactArray& answer, const DeformableOrgan& organ, const OrganShape& shape) {
  answer.header.frame_id = organ.frame();
  answer.topology = shape.mesh->topology();
  answer.mesh_stamp = shape.stamp;
}

void set_failure(ContactArray& answer, std::uint8_t status, const std::string& message) {
  answer.status = status;
  answer.message = plain_text(message, kLongestMessage);
  answer.contacts.clear();
  answer.regions.clear();
  answer.unresolved = 0;
  answer.near.clear();
  answer.near_left_out = answer.near_unresolved = 0;
  answer.clearance = {};
  answer.placement = {};
  answer.path_incomplete = false;
}

void set_incomplete(ContactArray& answer, const std::string& unknown) {
  if (unknown.empty() || answer.status != ContactArray::OK) return;
  answer.path_incomplete = true;
  answer.message = plain_text(unknown, kLongestMessage);
}

ContactArray failed_answer(const std::string& organ, const ToolParameters& tool,
                           const std_msgs::Header& header, std::uint8_t status,
                           const std::string& message) {
  const ros::Time stamp = header.stamp.isZero() ? ros::Time::now() : header.stamp;
  ContactArray answer = answer_about(organ, tool.name, ContactArray::STATIC, stamp);
  set_links(answer, tool);
  answer.header.frame_id = plain_text(tf_frame(header.frame_id), kLongestName);
  set_failure(answer, status, message);
  return answer;
}

void count_failure(FailureLog& log, std::uint8_t status, const std::string& message) {
  if (status == ContactArray::OK) return;
  log.add(reason_of(status), message, std::chrono::steady_clock::now());
}

bool is_stale(const OrganShape& shape, ros::Time now, double timeout_sec) {
  return timeout_sec > 0.0 && shape.age(now) > timeout_sec;
}

std::string stale_message(const std::string& organ, const OrganShape& shape, ros::Time now,
                          double timeout_sec) {
  return concatenate("mesh of organ '", organ, "' is ", shape.age(now), " s old; at most ",
                     timeout_sec, " s are allowed (mesh_timeout_sec)");
}

}  // namespace organ_collision
