#pragma once

#include <organ_collision/ContactArray.h>
#include <rosbag/bag.h>
#include <rosbag/message_instance.h>
#include <rosbag/view.h>

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace organ_collision {

/// The messages of a bag in the order in which they were recorded. rosbag::View alone orders them
/// by time: messages of the same simulated time would lose their order, and a clock that jumped
/// back would mix the times before and after the jump.
class RecordedMessages : private rosbag::View {
 public:
  /// Those of the connections for which `is_wanted` returns true. `bag` must outlive this.
  RecordedMessages(const rosbag::Bag& bag,
                   const std::function<bool(const rosbag::ConnectionInfo&)>& is_wanted);

  std::size_t size() const { return places_.size(); }
  /// Calls `take` for each message. Throws what rosbag throws if the bag cannot be read.
  void for_each(const std::function<void(const rosbag::MessageInstance&)>& take);

 private:
  struct Place {
    rosbag::IndexEntry entry;
    const rosbag::ConnectionInfo* connection;
  };

  const rosbag::Bag& bag_;
  std::vector<Place> places_;
};

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
