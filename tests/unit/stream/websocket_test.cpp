// SPDX-License-Identifier: Apache-2.0
// What peers may say over a WebSocket, by RFC 6455 and by our bounds.
#include "unit/stream/fixture.h"
#include "wire/json.h"

namespace wellspring::test {
namespace {

static std::string frame_bytes(int first, std::string_view payload, bool masked = true) {
  return RawClient::frame_bytes(first, payload, masked);
}

// A server and one peer that has joined; `say` sends bytes and returns the server's close code.
struct Talk {
  House house;
  RawClient client;
  std::shared_ptr<Link> link;
  explicit Talk(const StreamSettings& settings = quick_settings())
      : house(settings), client(house.port()) {
    EXPECT_EQ(client.join().status, 101);
    link = house.link();
    EXPECT_TRUE(link);
  }
  int say(const std::string& bytes) {
    client.send(bytes);
    return client.closed_with();
  }
};

TEST(WebSocket, texts_arrive) {
  Talk talk;
  talk.client.send(frame_bytes(0x81, "hello"));
  EXPECT_EQ(House::text_from(talk.link), "hello");
  talk.client.send(frame_bytes(0x81, ""));
  EXPECT_EQ(House::text_from(talk.link), "");
  talk.client.send(frame_bytes(0x81, "\xce\xba\xe1\xbd\xb9"));
  EXPECT_EQ(House::text_from(talk.link), "\xce\xba\xe1\xbd\xb9");
}

TEST(WebSocket, fragments_are_put_together_around_control_frames) {
  Talk talk;
  talk.client.send(frame_bytes(0x01, "he") + frame_bytes(0x89, "ping") + frame_bytes(0x00, "ll") +
                   frame_bytes(0x80, "o"));
  const auto pong = talk.client.next_frame();
  ASSERT_TRUE(pong);
  EXPECT_EQ(pong->opcode, 10);
  EXPECT_EQ(pong->payload, "ping");
  EXPECT_EQ(House::text_from(talk.link), "hello");
  for (const char byte : frame_bytes(0x81, "byte by byte"))
    talk.client.send(std::string_view(&byte, 1));
  EXPECT_EQ(House::text_from(talk.link), "byte by byte");
}

TEST(WebSocket, an_empty_and_a_full_ping_are_answered) {
  Talk talk;
  talk.client.send(frame_bytes(0x89, ""));
  EXPECT_EQ(talk.client.next_frame()->opcode, 10);
  talk.client.send(frame_bytes(0x89, std::string(125, 'p')));
  EXPECT_EQ(talk.client.next_frame()->payload, std::string(125, 'p'));
  talk.client.send(frame_bytes(0x8a, "unasked pong") + frame_bytes(0x81, "x"));
  EXPECT_EQ(House::text_from(talk.link), "x");
}

TEST(WebSocket, breaches_of_the_protocol_close_with_1002) {
  const std::pair<const char*, std::string> breaches[] = {
      {"ping of 126 bytes", frame_bytes(0x89, std::string(126, 'p'))},
      {"close of 126 bytes", frame_bytes(0x88, std::string(126, 'p'))},
      {"fragmented ping", frame_bytes(0x09, "p")},
      {"reserved bit 1", frame_bytes(0xc1, "x")},
      {"reserved bit 2", frame_bytes(0xa1, "x")},
      {"reserved bit 3", frame_bytes(0x91, "x")},
      {"reserved bit on a ping", frame_bytes(0xc9, "x")},
      {"opcode 3", frame_bytes(0x83, "x")},
      {"opcode 7", frame_bytes(0x87, "x")},
      {"opcode 11", frame_bytes(0x8b, "x")},
      {"opcode 15", frame_bytes(0x8f, "x")},
      {"unmasked", frame_bytes(0x81, "x", false)},
      {"continuation of nothing", frame_bytes(0x80, "x")},
      {"continuation of nothing, more to come", frame_bytes(0x00, "x")},
      {"text inside a text", frame_bytes(0x01, "x") + frame_bytes(0x81, "y")},
      {"binary inside a text", frame_bytes(0x01, "x") + frame_bytes(0x82, "y")},
      {"close code of one byte", frame_bytes(0x88, "\x03")},
      {"close code 0", frame_bytes(0x88, std::string_view("\0\0", 2))},
      {"close code 999", frame_bytes(0x88, "\x03\xe7")},
      {"close code 1005", frame_bytes(0x88, "\x03\xed")},
      {"close code 1016", frame_bytes(0x88, "\x03\xf8")},
      {"close code 2999", frame_bytes(0x88, "\x0b\xb7")},
      {"length not in its shortest form", std::string("\x81\xfe\x00\x01\x11\x22\x33\x44x", 9)},
  };
  for (const auto& [what, bytes] : breaches) {
    Talk talk;
    EXPECT_EQ(talk.say(bytes), 1002) << what;
    talk.client.close();
    EXPECT_TRUE(eventually([&] { return talk.link->closed(); })) << what;
    EXPECT_TRUE(talk.link->take_heard().empty()) << what;
  }
}

TEST(WebSocket, what_is_not_utf8_closes_with_1007) {
  for (const std::string text :
       {"\xff", "a\xc0\xaf", "\xed\xa0\x80", "\xf4\x90\x80\x80", "cut\xc3"}) {
    Talk talk;
    EXPECT_EQ(talk.say(frame_bytes(0x81, text)), 1007) << text;
  }
  Talk early;  // at once, not when the message is complete
  EXPECT_EQ(early.say(frame_bytes(0x01, "\xff")), 1007);
  Talk split;  // a character across two fragments is fine
  split.client.send(frame_bytes(0x01, "\xc3") + frame_bytes(0x80, "\xa9"));
  EXPECT_EQ(House::text_from(split.link), "\xc3\xa9");
}

TEST(WebSocket, messages_of_64_kib_are_fine_and_one_byte_more_closes_with_1009) {
  Talk talk;
  talk.client.send(frame_bytes(0x81, std::string(max_message_bytes, 'x')));
  EXPECT_EQ(House::text_from(talk.link).size(), max_message_bytes);
  EXPECT_EQ(talk.say(frame_bytes(0x81, std::string(max_message_bytes + 1, 'x'))), 1009);
  Talk fragments;
  const std::string part(max_message_bytes / 2, 'x');
  EXPECT_EQ(
      fragments.say(frame_bytes(0x01, part) + frame_bytes(0x00, part) + frame_bytes(0x80, "x")),
      1009);
  Talk announced;  // by the header alone, before any of it has come
  EXPECT_EQ(
      announced.say(std::string("\x81\xff\x7f\xff\xff\xff\xff\xff\xff\xff\x11\x22\x33\x44", 14)),
      1009);
}

TEST(WebSocket, binary_messages_close_with_1003) {
  Talk talk;
  EXPECT_EQ(talk.say(frame_bytes(0x82, "binary")), 1003);
  talk.client.send(frame_bytes(0x81, "too late"));
  talk.client.send(frame_bytes(0x88, "\x03\xeb"));
  EXPECT_TRUE(talk.client.ends());
  EXPECT_TRUE(eventually([&] { return talk.link->closed(); }));
  EXPECT_TRUE(talk.link->take_heard().empty());
}

// The peer's close frame is there before the server has sent its own: both sides close at once,
// whatever else is in the buffer.
TEST(WebSocket, closes_that_cross_end_the_connection) {
  const std::string bye = frame_bytes(0x88, "\x03\xe8");
  for (int round = 0; round < 40; round++) {
    Talk talk;
    const int kind = round % 4;
    if (kind == 0) talk.client.send(frame_bytes(0x82, "binary") + frame_bytes(0x81, "text") + bye);
    if (kind == 1) talk.client.send(frame_bytes(0x82, "binary") + frame_bytes(0x89, "ping") + bye);
    if (kind == 2) talk.link->close("bye");
    if (kind >= 2) talk.client.send(frame_bytes(0x81, "text") + bye);
    if (kind == 3) talk.link->close("bye");
    EXPECT_NE(talk.client.closed_with(), 0) << round;
    EXPECT_TRUE(talk.client.ends()) << round;
    EXPECT_TRUE(eventually([&] { return talk.house.server.counters().open == 0; })) << round;
  }
}

TEST(WebSocket, a_flood_closes_with_1008) {
  Talk talk;
  std::string many;
  for (int i = 0; i < 20000; i++) many += frame_bytes(0x81, "x");
  EXPECT_EQ(talk.say(many), 1008);
  EXPECT_EQ(talk.house.server.counters().flood_closed, 1u);
  Talk pings;
  many.clear();
  for (int i = 0; i < 20000; i++) many += frame_bytes(0x89, "");
  EXPECT_EQ(pings.say(many), 1008);
  Talk heavy;
  many.clear();
  for (int i = 0; i < 160; i++) many += frame_bytes(0x81, std::string(max_message_bytes, 'x'));
  EXPECT_EQ(heavy.say(many), 1008);
}

TEST(WebSocket, what_a_busy_client_says_is_no_flood) {
  Talk talk;
  size_t arrived = 0;
  for (int burst = 0; burst < 3; burst++) {
    std::string messages;
    for (int i = 0; i < 200; i++) messages += frame_bytes(0x81, "{}");
    talk.client.send(messages);
    const size_t wanted = arrived + 200;
    EXPECT_TRUE(eventually([&] { return (arrived += talk.link->take_heard().size()) == wanted; }));
  }
  EXPECT_FALSE(talk.link->closed());
}

TEST(WebSocket, texts_go_out_before_the_newest_picture) {
  Talk talk;
  talk.link->send_picture(picture_packet(1));
  EXPECT_EQ(picture_number(talk.client.next_frame()->payload), 1u);
  talk.link->send_text("a");
  talk.link->send_text("b");
  EXPECT_EQ(talk.client.next_frame()->payload, "a");
  EXPECT_EQ(talk.client.next_frame()->payload, "b");
  talk.link->send_picture(picture_packet(2, 200'000));
  const auto big = talk.client.next_frame();
  EXPECT_EQ(big->opcode, 2);
  EXPECT_EQ(big->payload.size(), 200'000u);
  EXPECT_TRUE(eventually([&] { return talk.link->pictures_sent == 2; }));
  EXPECT_EQ(talk.link->bytes_sent, 201'002u);
}

TEST(WebSocket, a_silent_peer_is_pinged_and_dropped) {
  auto settings = quick_settings();
  settings.idle_timeout = 0.6;
  Talk talk(settings);
  const auto ping = talk.client.next_frame();
  ASSERT_TRUE(ping);
  EXPECT_EQ(ping->opcode, 9);
  EXPECT_TRUE(eventually([&] { return talk.link->closed(); }));  // no pong came
}

TEST(WebSocket, a_peer_that_answers_pings_stays) {
  auto settings = quick_settings();
  settings.idle_timeout = 0.3;
  Talk talk(settings);
  for (int i = 0; i < 4; i++) {
    const auto ping = talk.client.next_frame();
    ASSERT_TRUE(ping);
    ASSERT_EQ(ping->opcode, 9);
    talk.client.send(frame_bytes(0x8a, ping->payload));
  }
  EXPECT_FALSE(talk.link->closed());
}

}  // namespace
}  // namespace wellspring::test
