#include "bags.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "offline/text_reader.hpp"
#include "ros/messages/failure_log.hpp"

namespace organ_collision {

RecordedMessages::RecordedMessages(
    const rosbag::Bag& bag, const std::function<bool(const rosbag::ConnectionInfo&)>& is_wanted)
    : View(bag, [is_wanted](
                    const rosbag::ConnectionInfo* connection) { return is_wanted(*connection); }),
      bag_(bag) {
  for (const rosbag::MessageRange* range : ranges_) {
    for (auto entry = range->begin; entry != range->end; ++entry) {
      places_.push_back({*entry, range->connection_info});
    }
  }
  // A bag is written from its beginning to its end.
  std::sort(places_.begin(), places_.end(), [](const Place& a, const Place& b) {
    return std::tie(a.entry.chunk_pos, a.entry.offset) <
           std::tie(b.entry.chunk_pos, b.entry.offset);
  });
}

void RecordedMessages::for_each(const std::function<void(const rosbag::MessageInstance&)>& take) {
  for (const Place& place : places_) {
    const std::unique_ptr<rosbag::MessageInstance> message(
        newMessageInstance(place.connection, place.entry, bag_));
    take(*message);
  }
}

std::string incomplete(const std::string& file) { return file + ".incomplete"; }

AnswerBag::AnswerBag(const std::string& file, std::string topic)
    : file_(file), topic_(std::move(topic)), incomplete_(incomplete(file)) {
  try {
    bag_.open(incomplete_, rosbag::bagmode::Write);
  } catch (const rosbag::BagException& error) {
    throw InputError(file + ": cannot be written: " + error.what());
  }
}

AnswerBag::~AnswerBag() {
  if (incomplete_.empty()) return;
  try {
    bag_.close();
  } catch (const std::exception&) {  // For example, the disk is full. The file is removed anyway.
  }
  std::error_code ignored;
  std::filesystem::remove(incomplete_, ignored);
}

void AnswerBag::add(const ContactArray& answer, ros::Time time) {
  ++counts_[answer.status];
  write([&] { bag_.write(topic_, std::max(time, ros::TIME_MIN), answer); });  // No time is zero.
}

void AnswerBag::copy(const rosbag::MessageInstance& message) {
  write([&] {
    bag_.write(message.getTopic(), message.getTime(), message, message.getConnectionHeader());
  });
}

void AnswerBag::write(const std::function<void()>& action) const {
  try {
    action();
  } catch (const rosbag::BagException& error) {
    throw std::runtime_error(file_ + ": cannot be written: " + error.what());
  }
}

void AnswerBag::complete() {
  bag_.close();
  std::filesystem::rename(incomplete_, file_);
  incomplete_.clear();
}

std::string AnswerBag::summary() const {
  std::size_t all = 0;
  std::string by_status;
  for (const auto& [status, count] : counts_) {
    all += count;
    by_status +=
        (by_status.empty() ? ": " : ", ") + std::to_string(count) + " " + reason_of(status);
  }
  return std::to_string(all) + " answers on " + topic_ + by_status;
}

}  // namespace organ_collision
