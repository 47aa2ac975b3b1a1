#pragma once

#include <organ_collision/ContactArray.h>
#include <rosbag/bag.h>
#include <rosbag/message_instance.h>

#include <cstddef>
#include <functional>
#include <map>
#include <string>

namespace organ_collision {

/// The name of a bag before it is complete.
std::string incomplete(const std::string& file);

/// The bag that gets the answers. It has its name only when it is complete: before that it is
/// NAME.incomplete, and a bag that is never completed is removed.
class AnswerBag {
 public:
  /// Throws InputError if the file cannot be written.
  AnswerBag(const std::string& file, std::string topic);
  ~AnswerBag();
  AnswerBag(const AnswerBag&) = delete;
  AnswerBag& operator=(const AnswerBag&) = delete;

  /// These throw std::runtime_error if the file cannot be written.
  void add(const ContactArray& answer, ros::Time time);
  void copy(const rosbag::MessageInstance& message);
  void complete();

  /// "1840 answers on /organ_collision/contacts: 1836 ok, 4 no transform"
  std::string summary() const;

 private:
  void write(const std::function<void()>& action) const;

  std::string file_;
  std::string topic_;
  std::string incomplete_;
  rosbag::Bag bag_;
  std::map<std::uint8_t, std::size_t> counts_;  ///< of answers, by status
};

}  // namespace organ_collision
