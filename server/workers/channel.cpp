// SPDX-License-Identifier: Apache-2.0
#include "workers/channel.h"

#include <chrono>
#include <stdexcept>
#include <utility>

#include "base/log.h"
#include "workers/connect.h"

namespace wellspring::workers {
namespace {

constexpr size_t most_outbox_bytes = 16 << 20;
constexpr int most_pending_messages = 4096, most_pending_bytes = 64 << 20;
constexpr std::chrono::milliseconds look_every{100};

void need(natsStatus status, const std::string& what) {
  if (status != NATS_OK) throw std::invalid_argument(what + ": " + natsStatus_GetText(status));
}

// The library's thread may outlive the channel, and ends the listener when it is done.
struct Listener {
  std::mutex mutex;
  std::function<void(std::string_view, std::string_view)> heard;  // empty: the channel has ended
};

void take_message(natsConnection*, natsSubscription*, natsMsg* message, void* closure) {
  const char* reply = natsMsg_GetReply(message);
  auto* listener = static_cast<Listener*>(closure);
  {
    std::lock_guard lock(listener->mutex);
    if (listener->heard)
      listener->heard({natsMsg_GetData(message), size_t(natsMsg_GetDataLength(message))},
                      reply ? reply : "");
  }
  natsMsg_Destroy(message);
}

void end_listener(void* closure) { delete static_cast<Listener*>(closure); }

natsStatus publish(natsConnection* connection, const std::string& subject,
                   const std::string& reply_to, const std::string& message) {
  const int size = int(message.size());
  if (reply_to.empty())
    return natsConnection_Publish(connection, subject.c_str(), message.data(), size);
  return natsConnection_PublishRequest(connection, subject.c_str(), reply_to.c_str(),
                                       message.data(), size);
}

}  // namespace

struct Channel::Connection {
  ConnectOptions options;
  natsConnection* connection = nullptr;
  std::vector<std::pair<natsSubscription*, Listener*>> subscriptions;
  ~Connection() {
    for (const auto& [one, listener] : subscriptions) {
      {
        std::lock_guard lock(listener->mutex);  // waits for what is being heard
        listener->heard = nullptr;
      }
      natsSubscription_Unsubscribe(one);
      natsSubscription_Destroy(one);
    }
    natsConnection_Destroy(connection);
  }
};

Channel::Channel(const ChannelSettings& settings, std::vector<Subscription> subscriptions)
    : connection_(std::make_unique<Connection>()) {
  connection_->options = make_options(settings);
  const natsStatus status =
      natsConnection_Connect(&connection_->connection, connection_->options.get());
  if (status == NATS_NOT_YET_CONNECTED)
    log::warn("no NATS server answers at {}; it is tried again and again", settings.url);
  else need(status, settings.url);
  for (Subscription& one : subscriptions) {
    natsSubscription* made = nullptr;
    auto listener = std::make_unique<Listener>();
    listener->heard = std::move(one.heard);
    need(one.group.empty()
             ? natsConnection_Subscribe(&made, connection_->connection, one.subject.c_str(),
                                        take_message, listener.get())
             : natsConnection_QueueSubscribe(&made, connection_->connection, one.subject.c_str(),
                                             one.group.c_str(), take_message, listener.get()),
         one.subject);
    natsSubscription_SetOnCompleteCB(made, end_listener, listener.get());
    connection_->subscriptions.emplace_back(made, listener.release());
    natsSubscription_SetPendingLimits(made, most_pending_messages, most_pending_bytes);
  }
  thread_ = std::jthread([this](const std::stop_token& end) { carry(end); });
}

Channel::~Channel() {
  thread_.request_stop();
  thread_.join();
}

// The library may hold its lock for as long as a connection takes.
bool Channel::ask_connected() const {
  return natsConnection_Status(connection_->connection) == NATS_CONN_STATUS_CONNECTED;
}

bool Channel::send(std::string subject, std::string reply_to, std::string message) {
  std::lock_guard lock(mutex_);
  if (!connected_ || outbox_bytes_ + message.size() > most_outbox_bytes) {
    dropped_++;
    return false;
  }
  outbox_bytes_ += message.size();
  outbox_.push_back({std::move(subject), std::move(reply_to), std::move(message)});
  wake_.notify_one();
  return true;
}

void Channel::carry(const std::stop_token& end) {
  std::unique_lock lock(mutex_);
  while (!end.stop_requested()) {
    wake_.wait_for(lock, end, look_every, [this] { return !outbox_.empty(); });
    std::deque<Parcel> parcels = std::exchange(outbox_, {});
    outbox_bytes_ = 0;
    lock.unlock();
    for (const Parcel& parcel : parcels) {
      connected_ = ask_connected();  // otherwise the library would keep it for later
      if (!connected_ || publish(connection_->connection, parcel.subject, parcel.reply_to,
                                 parcel.message) != NATS_OK)
        dropped_++;
    }
    connected_ = ask_connected();
    lock.lock();
  }
}

}  // namespace wellspring::workers
