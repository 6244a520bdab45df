// SPDX-License-Identifier: Apache-2.0
// A socket that says exactly the bytes it is told to, for tests of what no proper client would
// send.
#pragma once
#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace wellspring::test {

// Seconds that a test waits for what is to happen: only who fails waits so long, however busy the
// machine is.
inline constexpr double patience = 60;

class RawClient {
 public:
  explicit RawClient(uint16_t port, int receive_buffer = 0) : RawClient() {
    if (receive_buffer > 0)
      setsockopt(fd_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof(receive_buffer));
    connect(port);
  }
  // Has its descriptor, but is connected nowhere yet.
  RawClient() : fd_(socket(AF_INET, SOCK_STREAM, 0)) {
    const int on = 1;
    setsockopt(fd_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
  }
  ~RawClient() { close(); }
  RawClient(const RawClient&) = delete;

  bool connect(uint16_t port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    connected_ = ::connect(fd_, reinterpret_cast<sockaddr*>(&address), sizeof(address)) == 0;
    return connected_;
  }
  bool connected() const { return connected_; }
  void close() {
    if (fd_ >= 0) ::close(fd_);
    fd_ = -1;
  }

  bool send(std::string_view bytes) {
    while (!bytes.empty()) {
      const auto sent = ::send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (sent <= 0) return false;
      bytes.remove_prefix(size_t(sent));
    }
    return true;
  }

  // Reads more into `input`; false at the end of the stream, an error, or when nothing came in
  // time.
  bool more(double timeout = patience) {
    if (fd_ < 0) return false;
    pollfd waiting{fd_, POLLIN, 0};
    if (poll(&waiting, 1, int(timeout * 1000)) <= 0) return false;
    char bytes[65536];
    const auto count = recv(fd_, bytes, sizeof(bytes), 0);
    if (count <= 0) {
      ended_ = true;
      close();  // as any client does; a server may wait for it
      return false;
    }
    input.append(bytes, size_t(count));
    return true;
  }

  // True when the other side ends the connection within `timeout` seconds.
  bool ends(double timeout = patience) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(timeout);
    while (!ended_ && std::chrono::steady_clock::now() < end) more(0.05);
    return ended_;
  }

  // One HTTP reply off the front of `input`; head includes the status line. Empty where none came.
  struct Reply {
    int status = 0;
    std::string head, body;
    std::string header(std::string_view name) const {
      const auto at = head.find("\r\n" + std::string(name) + ": ");
      if (at == std::string::npos) return "";
      const auto begin = at + 4 + name.size();
      return head.substr(begin, head.find("\r\n", begin) - begin);
    }
  };
  Reply reply(bool to_head = false) {
    Reply reply;
    size_t end = 0;
    while ((end = input.find("\r\n\r\n")) == std::string::npos)
      if (!more()) return reply;
    reply.head = input.substr(0, end + 2);
    input.erase(0, end + 4);
    reply.status = reply.head.size() > 12 ? std::stoi(reply.head.substr(9, 3)) : 0;
    const std::string length = reply.header("Content-Length");
    const size_t bytes = length.empty() || to_head ? 0 : std::stoul(length);
    while (input.size() < bytes)
      if (!more()) break;
    reply.body = input.substr(0, bytes);
    input.erase(0, bytes);
    return reply;
  }
  Reply ask(const std::string& target, const std::string& more_headers = "",
            const std::string& method = "GET") {
    send(method + " " + target + " HTTP/1.1\r\nHost: localhost\r\n" + more_headers + "\r\n");
    return reply(method == "HEAD");
  }

  // ---- WebSocket ----
  Reply upgrade(const std::string& path = "/api/v1/visit", const std::string& more_headers = "") {
    return ask(path,
               "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
               "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
                   more_headers);
  }

  // The same, with a first message.
  Reply join(const std::string& path = "/api/v1/visit", const std::string& more_headers = "") {
    Reply reply = upgrade(path, more_headers);
    if (reply.status == 101) send(frame_bytes(0x81, "first"));
    return reply;
  }

  // first: FIN, reserved bits and opcode, as on the wire (0x81: a whole text).
  static std::string frame_bytes(int first, std::string_view payload, bool masked = true) {
    std::string out(1, char(first));
    const int mask_bit = masked ? 0x80 : 0;
    if (payload.size() < 126) {
      out += char(mask_bit | int(payload.size()));
    } else if (payload.size() < 65536) {
      out += {char(mask_bit | 126), char(payload.size() >> 8), char(payload.size())};
    } else {
      out += char(mask_bit | 127);
      for (int shift = 56; shift >= 0; shift -= 8) out += char(uint64_t(payload.size()) >> shift);
    }
    const char mask[4] = {0x11, 0x22, 0x33, 0x44};
    if (masked) out.append(mask, 4);
    for (size_t i = 0; i < payload.size(); i++)
      out += masked ? char(payload[i] ^ mask[i % 4]) : payload[i];
    return out;
  }

  struct Frame {
    int opcode = 0;
    std::string payload;
    int close_code() const {
      return opcode != 8 || payload.size() < 2 ? 0
                                               : uint8_t(payload[0]) * 256 + uint8_t(payload[1]);
    }
  };
  // The next one, but for pings by which the server measures the line: these have a number.
  std::optional<Frame> next_frame(double timeout = patience) {
    auto frame = any_frame(timeout);
    while (frame && frame->opcode == 9 && !frame->payload.empty()) frame = any_frame(timeout);
    return frame;
  }
  std::optional<Frame> any_frame(double timeout) {
    const auto need = [&](size_t bytes) {
      while (input.size() < bytes)
        if (!more(timeout)) return false;
      return true;
    };
    if (!need(2)) return std::nullopt;
    Frame frame;
    frame.opcode = input[0] & 15;
    uint64_t length = uint8_t(input[1]) & 127;
    size_t header = 2;
    if (length >= 126) {
      const size_t bytes = length == 126 ? 2 : 8;
      header += bytes;
      if (!need(header)) return std::nullopt;
      length = 0;
      for (size_t i = 2; i < header; i++) length = length * 256 + uint8_t(input[i]);
    }
    if (!need(header + length)) return std::nullopt;
    frame.payload = input.substr(header, length);
    input.erase(0, header + length);
    return frame;
  }
  // The close code that the server sends, skipping other frames; 0 where none comes.
  int closed_with(double timeout = patience) {
    while (auto frame = next_frame(timeout))
      if (frame->opcode == 8) return frame->close_code();
    return 0;
  }

  std::string input;

 private:
  int fd_ = -1;
  bool connected_ = false, ended_ = false;
};

}  // namespace wellspring::test
