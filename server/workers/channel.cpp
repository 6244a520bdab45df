// SPDX-License-Identifier: Apache-2.0
#include "workers/channel.h"

#include <chrono>
#include <nats/nats.h>
#include <stdexcept>
#include <utility>

#include "base/log.h"

namespace wellspring::workers {
namespace {

constexpr size_t most_outbox_bytes = 16 << 20;
constexpr int most_pending_messages = 4096, most_pending_bytes = 64 << 20;
constexpr int64_t reconnect_wait_ms = 500, ping_interval_ms = 2000, write_deadline_ms = 2000,
                  connect_timeout_ms = 2000;
constexpr int most_pings_out = 2;
constexpr std::chrono::milliseconds look_every{100};

void need(natsStatus status, const std::string& what) {
  if (status != NATS_OK) throw std::invalid_argument(what + ": " + natsStatus_GetText(status));
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts;
  for (size_t from = 0; from <= text.size();) {
    const size_t to = std::min(text.find(',', from), text.size());
    if (to > from) parts.push_back(text.substr(from, to - from));
    from = to + 1;
  }
  return parts;
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

// The library tells its threads' news here.
void say_lost(natsConnection*, void*) { log::warn("the connection to NATS is lost"); }
void say_back(natsConnection*, void*) { log::info("connected to NATS again"); }
void say_connected(natsConnection*, void*) { log::info("connected to NATS"); }
void say_error(natsConnection*, natsSubscription*, natsStatus status, void*) {
  log::debug("NATS: {}", natsStatus_GetText(status));
}

}  // namespace

struct Channel::Connection {
  natsOptions* options = nullptr;
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
    natsOptions_Destroy(options);
  }
};

static void set_options(const ChannelSettings& settings, natsOptions* options) {
  const std::vector<std::string> urls = split(settings.url);
  std::vector<const char*> names;
  for (const std::string& url : urls) names.push_back(url.c_str());
  if (names.empty()) throw std::invalid_argument("no address of a NATS server");
  need(natsOptions_SetServers(options, names.data(), int(names.size())), settings.url);
  if (!settings.token.empty())
    need(natsOptions_SetToken(options, settings.token.c_str()), "token of NATS");
  const bool tls = settings.url.starts_with("tls://") || !settings.authority.empty() ||
                   !settings.certificate.empty();
  if (tls) need(natsOptions_SetSecure(options, true), "TLS");
  if (!settings.authority.empty())
    need(natsOptions_LoadCATrustedCertificates(options, settings.authority.c_str()),
         settings.authority);
  if (!settings.certificate.empty())
    need(natsOptions_LoadCertificatesChain(options, settings.certificate.c_str(),
                                           settings.key.c_str()),
         settings.certificate);
  need(natsOptions_SetName(options, settings.name.c_str()), "name");
  natsOptions_DisableNoResponders(options, true);  // who is not there says nothing
  natsOptions_SetMaxReconnect(options, -1);
  natsOptions_SetReconnectWait(options, reconnect_wait_ms);
  natsOptions_SetTimeout(options, connect_timeout_ms);
  natsOptions_SetPingInterval(options, ping_interval_ms);
  natsOptions_SetMaxPingsOut(options, most_pings_out);
  natsOptions_SetWriteDeadline(options, write_deadline_ms);
  natsOptions_SetDisconnectedCB(options, say_lost, nullptr);
  natsOptions_SetReconnectedCB(options, say_back, nullptr);
  natsOptions_SetErrorHandler(options, say_error, nullptr);
  natsOptions_SetRetryOnFailedConnect(options, true, say_connected, nullptr);
}

Channel::Channel(const ChannelSettings& settings, std::vector<Subscription> subscriptions)
    : connection_(std::make_unique<Connection>()) {
  need(natsOptions_Create(&connection_->options), "NATS");
  set_options(settings, connection_->options);
  const natsStatus status = natsConnection_Connect(&connection_->connection, connection_->options);
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
