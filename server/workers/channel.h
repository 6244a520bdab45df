// SPDX-License-Identifier: Apache-2.0
// Connects to a NATS server, by libnats, which connect.h shows. Nobody who sends waits:
// messages go through a bounded queue to a thread of their own, and are dropped while there is no
// connection. A lost connection comes back by itself, however long that takes. Messages of others
// are handed over on the library's threads.
#pragma once
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "workers/settings.h"

namespace wellspring::workers {

struct Subscription {
  std::string subject;
  std::string group;  // those who share the subject's messages; empty: all get each
  // Any thread, one message at a time.
  std::function<void(std::string_view message, std::string_view reply_to)> heard;
};

class Channel {
 public:
  // Returns at once, connected or not. Throws std::invalid_argument for an address or a file that
  // is wrong.
  Channel(const ChannelSettings& settings, std::vector<Subscription> subscriptions);
  ~Channel();
  Channel(const Channel&) = delete;
  Channel& operator=(const Channel&) = delete;

  // Any thread. Returns false if the message is dropped: there is no connection, or others wait.
  bool send(std::string subject, std::string reply_to, std::string message);
  bool connected() const { return connected_; }  // as it was a tenth of a second ago
  uint64_t dropped() const { return dropped_; }

 private:
  struct Connection;
  struct Parcel {
    std::string subject, reply_to, message;
  };
  void carry(const std::stop_token& end);
  bool ask_connected() const;
  std::unique_ptr<Connection> connection_;
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::deque<Parcel> outbox_;
  size_t outbox_bytes_ = 0;
  std::atomic<uint64_t> dropped_ = 0;
  std::atomic<bool> connected_ = false;
  std::jthread thread_;
};

}  // namespace wellspring::workers
