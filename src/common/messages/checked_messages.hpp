#pragma once

#include <ros/node_handle.h>
#include <ros/serialization.h>
#include <ros/subscription_callback_helper.h>

#include <boost/make_shared.hpp>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "failure_log.hpp"
#include "text.hpp"

namespace organ_collision {

/// Reads a message of roscpp from bytes of a peer that may be wrong. ros::serialization::IStream
/// makes room for as many elements as a list claims to have, before it looks whether the bytes are
/// there: a message of 50 bytes can take 16 GB. CheckedStream looks for the bytes first. A message
/// that it reads takes at most about ten times the memory of its bytes.
class CheckedStream : public ros::serialization::Stream {
 public:
  // roscpp asks for this name. NOLINTNEXTLINE(readability-identifier-naming)
  static constexpr ros::serialization::StreamType stream_type =
      ros::serialization::stream_types::Input;

  /// The stream only reads the bytes, in spite of the const_cast. The bytes must outlive the
  /// stream.
  CheckedStream(const std::uint8_t* bytes, std::uint32_t size)
      : Stream(const_cast<std::uint8_t*>(bytes), size) {}

  /// Throws ros::serialization::StreamOverrunException if the bytes end before the value does.
  template <typename Value>
  void next(Value& value) {
    ros::serialization::deserialize(*this, value);
  }
  template <typename Element, typename Allocator>
  void next(std::vector<Element, Allocator>& list) {
    check_count(ros::serialization::serializationLength(Element()));
    ros::serialization::deserialize(*this, list);
  }

 private:
  /// Throws if fewer bytes are left than the list claims to have. `least`: [bytes] the size of the
  /// shortest possible element.
  void check_count(std::uint32_t least) {
    std::uint32_t count = 0;
    if (getLength() < sizeof count) return;  // deserialize() refuses these bytes.
    std::memcpy(&count, getData(), sizeof count);
    const std::uint64_t there = getLength() - sizeof count;
    if (std::uint64_t{count} * least <= there) return;
    throw ros::serialization::StreamOverrunException(
        "a list claims " + std::to_string(count) + " elements of at least " +
        std::to_string(least) + " bytes, but only " + std::to_string(there) + " bytes follow");
  }
};

// Subscribers and services like those of roscpp, except that they read what peers send with
// CheckedStream.

/// A subscription that refuses and counts bytes that are no complete message of its type.
template <typename Message>
class CheckedSubscription
    : public ros::SubscriptionCallbackHelperT<const ros::MessageEvent<const Message>&> {
 public:
  using Base = ros::SubscriptionCallbackHelperT<const ros::MessageEvent<const Message>&>;

  CheckedSubscription(const typename Base::Callback& callback, FailureLog& rejected)
      : Base(callback), rejected_(rejected) {}

  /// Returns null if the bytes are no complete message. roscpp then drops them.
  ros::VoidConstPtr deserialize(
      const ros::SubscriptionCallbackHelperDeserializeParams& params) override {
    const auto message = boost::make_shared<Message>();
    try {
      CheckedStream(params.buffer, params.length).next(*message);
      return message;
    } catch (const std::exception& error) {
      const auto sender = params.connection_header->find("callerid");
      const std::string from =
          sender == params.connection_header->end() ? "a nameless node" : sender->second;
      rejected_.add("unreadable message", std::to_string(params.length) + " bytes from " +
                                              plain_text(from, kLongestName) + " are no " +
                                              ros::message_traits::datatype<Message>() + ": " +
                                              error.what());
      return {};
    }
  }

 private:
  FailureLog& rejected_;
};

/// A service that refuses bytes that are no complete request. The caller then gets an error, which
/// roscpp logs.
template <typename Service>
class CheckedService : public ros::ServiceCallbackHelper {
 public:
  using Request = typename Service::Request;
  using Response = typename Service::Response;
  using Answer = std::function<bool(Request& request, Response& response)>;

  explicit CheckedService(Answer answer) : answer_(std::move(answer)) {}

  bool call(ros::ServiceCallbackHelperCallParams& params) override {
    const ros::SerializedMessage& bytes = params.request;
    Request request;
    Response response;
    CheckedStream(
        bytes.message_start,
        static_cast<std::uint32_t>(bytes.num_bytes - (bytes.message_start - bytes.buf.get())))
        .next(request);
    const bool is_answered = answer_(request, response);
    params.response = ros::serialization::serializeServiceResponse(is_answered, response);
    return is_answered;
  }

 private:
  Answer answer_;
};

/// Subscribes as NodeHandle::subscribe() with TCP_NODELAY does, but reads messages with
/// CheckedStream. `rejected` counts unreadable messages, and must outlive the subscriber.
template <typename Message>
ros::Subscriber subscribe_checked(
    ros::NodeHandle node, const std::string& topic, std::uint32_t queue,
    const typename CheckedSubscription<Message>::Base::Callback& callback, FailureLog& rejected) {
  ros::SubscribeOptions options(topic, queue, ros::message_traits::md5sum<Message>(),
                                ros::message_traits::datatype<Message>());
  options.helper = boost::make_shared<CheckedSubscription<Message>>(callback, rejected);
  options.transport_hints = ros::TransportHints().tcpNoDelay();
  return node.subscribe(options);
}

/// Advertises as NodeHandle::advertiseService() does, but reads requests with CheckedStream.
template <typename Service>
ros::ServiceServer advertise_checked(ros::NodeHandle node, const std::string& service,
                                     const typename CheckedService<Service>::Answer& answer) {
  ros::AdvertiseServiceOptions options;
  options.init<Service>(service, answer);
  options.helper = boost::make_shared<CheckedService<Service>>(answer);
  return node.advertiseService(options);
}

/// Reads the message whose bytes `holder` has, for example a topic_tools::ShapeShifter or a
/// rosbag::MessageInstance. It reads with CheckedStream, unlike their own instantiate(). `holder`
/// must have a message of this type. Throws ros::serialization::StreamOverrunException.
template <typename Message, typename Holder>
boost::shared_ptr<Message> held_message(const Holder& holder) {
  const std::uint32_t size = holder.size();
  // A damaged bag may claim 4 GB. Bytes that nobody writes take no memory, so they are not set to
  // zero. One byte more: Stream needs an address.
  const std::unique_ptr<std::uint8_t[]> bytes(new std::uint8_t[std::size_t{size} + 1]);
  ros::serialization::OStream copy(bytes.get(), size);
  holder.write(copy);
  auto message = boost::make_shared<Message>();
  CheckedStream(bytes.get(), size).next(*message);
  return message;
}

}  // namespace organ_collision
