#pragma once

#include <ros/node_handle.h>
#include <ros/subscription_callback_helper.h>

#include <boost/make_shared.hpp>
#include <chrono>
#include <functional>
#include <string>

#include "checked_stream.hpp"
#include "failure_log.hpp"
#include "plain_text.hpp"

namespace organ_collision {

// Subscribers and services that read with CheckedStream what peers send. Otherwise they are those
// of roscpp.

/// A subscription that refuses a message whose bytes are not one, and counts it.
template <typename Message>
class CheckedSubscription
    : public ros::SubscriptionCallbackHelperT<const ros::MessageEvent<const Message>&> {
 public:
  using Base = ros::SubscriptionCallbackHelperT<const ros::MessageEvent<const Message>&>;

  CheckedSubscription(const typename Base::Callback& callback, FailureLog& rejected)
      : Base(callback), rejected_(rejected) {}

  /// Returns null if the bytes are no message. roscpp then drops them.
  ros::VoidConstPtr deserialize(
      const ros::SubscriptionCallbackHelperDeserializeParams& params) override {
    const auto message = boost::make_shared<Message>();
    try {
      CheckedStream(params.buffer, params.length).next(*message);
      return message;
    } catch (const std::exception& error) {
      reject(params, error.what());
      return {};
    }
  }

 private:
  void reject(const ros::SubscriptionCallbackHelperDeserializeParams& params,
              const std::string& why) {
    const auto sender = params.connection_header->find("callerid");
    const std::string from =
        sender == params.connection_header->end() ? "a nameless node" : sender->second;
    rejected_.add("unreadable message",
                  std::to_string(params.length) + " bytes from " + plain_text(from, kLongestName) +
                      " are no " + ros::message_traits::datatype<Message>() + ": " + why,
                  std::chrono::steady_clock::now());
  }

  FailureLog& rejected_;
};

/// A service that refuses a request whose bytes are not one: the caller gets an error, which roscpp
/// logs.
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

/// As NodeHandle::subscribe() with TCP_NODELAY. `rejected` counts unreadable messages, and must
/// outlive the subscriber.
template <typename Message>
ros::Subscriber subscribe_checked(
    ros::NodeHandle node, const std::string& topic, std::uint32_t queue,
    const std::function<void(const ros::MessageEvent<const Message>&)>& callback,
    FailureLog& rejected) {
  ros::SubscribeOptions options(topic, queue, ros::message_traits::md5sum<Message>(),
                                ros::message_traits::datatype<Message>());
  options.helper = boost::make_shared<CheckedSubscription<Message>>(callback, rejected);
  options.transport_hints = ros::TransportHints().tcpNoDelay();
  return node.subscribe(options);
}

/// As NodeHandle::advertiseService().
template <typename Service>
ros::ServiceServer advertise_checked(ros::NodeHandle node, const std::string& service,
                                     const typename CheckedService<Service>::Answer& answer) {
  ros::AdvertiseServiceOptions options;
  options.init<Service>(service, answer);
  options.helper = boost::make_shared<CheckedService<Service>>(answer);
  return node.advertiseService(options);
}

}  // namespace organ_collision
