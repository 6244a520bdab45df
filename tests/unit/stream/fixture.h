// SPDX-License-Identifier: Apache-2.0
// A server on a free port with an answer that echoes what it was asked, and the links it was given.
#pragma once
#include <gtest/gtest.h>

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

#include "raw_client.h"
#include "stream/stream.h"

namespace wellspring::test {

inline StreamSettings quick_settings() { return StreamSettings{.port = 0}; }

// Waits until `condition` holds; false when it does not within `timeout` seconds.
inline bool eventually(const std::function<bool()>& condition, double timeout = patience) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(timeout);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

struct House {
  std::mutex mutex;
  std::condition_variable news;
  std::vector<std::shared_ptr<Link>> links;
  std::string first_texts;  // the links' first texts, in order, each with a semicolon
  Server server;

  explicit House(const StreamSettings& settings = quick_settings(),
                 std::function<HttpReply(const HttpQuestion&)> answer = echo,
                 std::function<bool(const HttpQuestion&)> slow = {})
      : server(settings, {.answer = std::move(answer),
                          .joined =
                              [this](std::shared_ptr<Link> link) {
                                std::lock_guard lock(mutex);
                                first_texts += link->take_heard().at(0).text + ";";
                                links.push_back(std::move(link));
                                news.notify_all();
                              },
                          .slow = std::move(slow)}) {}
  ~House() { server.stop(); }
  uint16_t port() const { return server.port(); }

  // The number-th link that joined; null when there are never that many.
  std::shared_ptr<Link> link(size_t number = 0) {
    std::unique_lock lock(mutex);
    news.wait_for(lock, std::chrono::duration<double>(patience),
                  [&] { return links.size() > number; });
    return links.size() > number ? links[number] : nullptr;
  }

  // The only text that the peer of `link` said since the last call.
  static std::string text_from(const std::shared_ptr<Link>& link) {
    std::vector<Heard> heard;
    eventually([&] { return !(heard = link->take_heard()).empty(); });
    EXPECT_EQ(heard.size(), 1u);
    return heard.empty() ? "nothing came" : heard.front().text;
  }

  static HttpReply echo(const HttpQuestion& question) {
    HttpReply reply{.content_type = "text/plain; charset=utf-8", .body = question.path};
    for (const auto& [name, value] : question.query) reply.body += "|" + name + "=" + value;
    if (question.path == "/missing") reply.status = 404;
    if (question.path == "/tagged") reply.headers["ETag"] = "\"v1\"";
    if (question.path == "/throws") throw std::runtime_error("oh");
    return reply;
  }
};

inline std::shared_ptr<const Packet> picture_packet(uint32_t number, size_t bytes = 1000) {
  Packet packet(std::max(bytes, packet_header_bytes), 0x55);
  write_packet_header({.frame = number, .width = 16, .height = 16}, packet);
  return std::make_shared<const Packet>(std::move(packet));
}

inline uint32_t picture_number(std::string_view bytes) {
  const auto view =
      read_packet(std::span(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()));
  return view ? view->header.frame : 0;
}

}  // namespace wellspring::test
