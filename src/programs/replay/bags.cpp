#include "bags.hpp"

#include <ros/serialization.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <exception>
#include <filesystem>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "common/messages/failure_log.hpp"
#include "common/messages/text.hpp"
#include "common/program/user_input.hpp"

namespace organ_collision {

void ScopedBagLog::log(const std::string& text, console_bridge::LogLevel level, const char*, int) {
  if (level >= console_bridge::CONSOLE_BRIDGE_LOG_WARN) lines_.insert(plain_text(text, 200));
}

void open(rosbag::Bag& bag, const std::string& file) {
  try {
    bag.open(file, rosbag::bagmode::Read);
  } catch (const rosbag::BagUnindexedException&) {
    throw InputError(file +
                     ": has no index, as after an interrupted recording; repair it with "
                     "`rosbag reindex`");
  } catch (const std::exception& error) {
    throw InputError(file + ": is no bag that can be read: " + plain_text(error.what(), 200));
  }
}

RecordedMessages::RecordedMessages(const rosbag::Bag& bag, const IsWanted& is_wanted)
    : View(bag, is_wanted), bag_(bag) {
  for (const rosbag::MessageRange* range : ranges_) {
    for (auto entry = range->begin; entry != range->end; ++entry) {
      places_.push_back({*entry, range->connection_info});
    }
  }
  // A bag is written from its beginning to its end, so positions in the file tell the order.
  std::sort(places_.begin(), places_.end(), [](const Place& a, const Place& b) {
    return std::tie(a.entry.chunk_pos, a.entry.offset) <
           std::tie(b.entry.chunk_pos, b.entry.offset);
  });
}

void RecordedMessages::for_each(const Take& take) try {
  for (const Place& place : places_) {
    const std::unique_ptr<rosbag::MessageInstance> message(
        newMessageInstance(place.connection, place.entry, bag_));
    take(*message);
  }
} catch (const rosbag::BagException& error) {
  throw InputError(bag_.getFileName() +
                   ": cannot be read to its end: " + plain_text(error.what(), 200));
} catch (const ros::serialization::StreamOverrunException&) {
  throw InputError(bag_.getFileName() +
                   ": a message is damaged: it is shorter than its contents say");
} catch (const std::bad_alloc&) {
  throw InputError(bag_.getFileName() + ": a message claims more bytes than there is memory");
}

std::string incomplete(const std::string& file) { return file + ".incomplete"; }

/// Calls `write`. Throws std::runtime_error, with the reason of the system, if it throws.
template <typename Write>
void AnswerBag::attempt(const Write& write) const {
  errno = 0;
  try {
    write();
  } catch (const rosbag::BagException& error) {
    throw std::runtime_error(
        file_ + ": cannot be written: " + (errno == 0 ? error.what() : std::strerror(errno)));
  }
}

AnswerBag::AnswerBag(const std::string& file, std::string topic)
    : file_(file),
      topic_(std::move(topic)),
      incomplete_(incomplete(file)),
      bag_(std::make_unique<rosbag::Bag>()) {
  try {
    attempt([&] { bag_->open(incomplete_, rosbag::bagmode::Write); });
  } catch (const std::runtime_error& error) {
    abandon();
    throw InputError(error.what());
  }
}

AnswerBag::~AnswerBag() {
  if (!incomplete_.empty()) abandon();
}

/// Removes the file. On a full disk, the destructor of rosbag::Bag throws, which would end the
/// program with a signal. What an incomplete bag owns is left to the end of the process.
void AnswerBag::abandon() {
  [[maybe_unused]] const rosbag::Bag* const abandoned = bag_.release();
  std::error_code ignored;
  std::filesystem::remove(incomplete_, ignored);
}

void AnswerBag::add(const ContactArray& answer, ros::Time time) {
  ++counts_[answer.status];
  // rosbag refuses time zero.
  attempt([&] { bag_->write(topic_, std::max(time, ros::TIME_MIN), answer); });
}

void AnswerBag::copy(const rosbag::MessageInstance& message) {
  attempt([&] {
    bag_->write(message.getTopic(), message.getTime(), message, message.getConnectionHeader());
  });
}

void AnswerBag::complete() {
  attempt([&] { bag_->close(); });
  std::filesystem::rename(incomplete_, file_);
  incomplete_.clear();
}

std::size_t AnswerBag::count() const {
  std::size_t all = 0;
  for (const auto& [status, count] : counts_) all += count;
  return all;
}

std::string AnswerBag::summary() const {
  std::string by_status;
  for (const auto& [status, count] : counts_) {
    by_status +=
        (by_status.empty() ? ": " : ", ") + std::to_string(count) + " " + reason_of(status);
  }
  return std::to_string(count()) + " answers on " + topic_ + by_status;
}

}  // namespace organ_collision
