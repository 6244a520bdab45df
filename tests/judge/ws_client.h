// SPDX-License-Identifier: Apache-2.0
// Connects to a WebSocket for our own programs and tests: one connection, one thread, calls that
// block up to a given time. It knows no messages; wire/json.h and wire/packet.h do.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace wellspring::test {

struct WsTarget {
  std::string host = "127.0.0.1";
  uint16_t port = 8080;
  std::string path = "/api/v1/visit";
  std::string subprotocol = "wellspring.v1";  // empty: none offered
  std::string origin = {};                    // empty: none named, as scripts do
};

struct WsMessage {
  bool binary = false;
  std::vector<uint8_t> bytes;
  std::string_view text() const {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }
};

class WsClient {
 public:
  enum class Got { message, nothing, closed };

  WsClient();
  ~WsClient();  // drops the connection; close() before ends it politely
  WsClient(WsClient&&) noexcept;
  WsClient& operator=(WsClient&&) noexcept;

  // Resolves, connects and shakes hands within `timeout` seconds. Throws std::runtime_error naming
  // the address and the cause (for a refused handshake: the HTTP status). Connects anew when called
  // again.
  void connect(const WsTarget& target, double timeout = 5);

  // Sends a text. False: the connection is gone, or the message could not be handed to the kernel
  // in time (then the connection is dropped, since a half-written message cannot be taken back).
  bool send_text(std::string_view text, double timeout = 5);

  // Receives the next message, within `timeout` seconds (0: only what is there already). After
  // `nothing` the connection is as before; after `closed` close_code() and close_reason() return
  // the server's.
  Got receive(WsMessage& message, double timeout);

  void close(double timeout = 2);  // with the closing handshake
  bool connected() const;
  std::string subprotocol() const;  // subprotocol that the server chose
  int close_code() const;           // 0: none was received
  std::string close_reason() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace wellspring::test
