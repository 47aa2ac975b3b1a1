#pragma once

#include <console_bridge/console.h>
#include <organ_collision/ContactArray.h>
#include <ros/time.h>
#include <rosbag/bag.h>
#include <rosbag/message_instance.h>
#include <rosbag/view.h>

#include <boost/function.hpp>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace organ_collision {

/// While an object of this class lives, it keeps what the library that reads bags logs, each line
/// once. Otherwise, the library would print lines of its own beside the error that it throws.
class ScopedBagLog : public console_bridge::OutputHandler {
 public:
  ScopedBagLog() { console_bridge::useOutputHandler(this); }
  ~ScopedBagLog() override { console_bridge::restorePreviousOutputHandler(); }
  ScopedBagLog(const ScopedBagLog&) = delete;
  ScopedBagLog& operator=(const ScopedBagLog&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override;
  const std::set<std::string>& lines() const { return lines_; }

 private:
  std::set<std::string> lines_;
};

/// Opens a bag to read it. Throws InputError. A damaged bag may end the program.
void open(rosbag::Bag& bag, const std::string& file);

/// The messages of a bag in the order in which they were recorded. rosbag::View alone orders them
/// by time: messages of the same simulated time would lose their order, and a clock that jumped
/// back would mix the times before and after the jump.
class RecordedMessages : private rosbag::View {
 public:
  using IsWanted = boost::function<bool(const rosbag::ConnectionInfo*)>;
  using Take = std::function<void(const rosbag::MessageInstance&)>;

  /// The messages of the connections for which `is_wanted` returns true. `bag` must outlive this.
  RecordedMessages(const rosbag::Bag& bag, const IsWanted& is_wanted);

  std::size_t size() const { return places_.size(); }
  /// Calls `take` for each message. Throws InputError if the bag cannot be read.
  void for_each(const Take& take);

 private:
  struct Place {
    rosbag::IndexEntry entry;
    const rosbag::ConnectionInfo* connection;
  };

  const rosbag::Bag& bag_;
  std::vector<Place> places_;
};

/// The name that a bag has until it is complete.
std::string incomplete(const std::string& file);

/// The bag that gets the answers. Until it is complete, its file is NAME.incomplete. A bag that is
/// never completed is removed. The functions throw std::runtime_error if the file cannot be
/// written.
class AnswerBag {
 public:
  /// Throws InputError if the file cannot be written.
  AnswerBag(const std::string& file, std::string topic);
  ~AnswerBag();
  AnswerBag(const AnswerBag&) = delete;
  AnswerBag& operator=(const AnswerBag&) = delete;

  void add(const ContactArray& answer, ros::Time time);
  void copy(const rosbag::MessageInstance& message);
  void complete();

  /// The number of answers.
  std::size_t count() const;
  /// For example "1840 answers on /organ_collision/contacts: 1836 ok, 4 no transform".
  std::string summary() const;

 private:
  void abandon();
  template <typename Write>
  void attempt(const Write& write) const;

  std::string file_;
  std::string topic_;
  std::string incomplete_;
  std::unique_ptr<rosbag::Bag> bag_;
  std::map<std::uint8_t, std::size_t> counts_;  ///< the number of answers, by status
};

}  // namespace organ_collision
