// SPDX-License-Identifier: Apache-2.0
// Who gets a WebSocket, and what a close says.
#include "judge/ws_client.h"
#include "unit/stream/fixture.h"

namespace wellspring::test {
namespace {

TEST(Upgrade, visit_and_eye_become_links_of_their_kind) {
  House house;
  RawClient visit(house.port()), eye(house.port());
  const auto reply = visit.join();
  EXPECT_EQ(reply.status, 101);
  EXPECT_EQ(reply.header("Sec-WebSocket-Accept"), "s3pPLMBiTxaQ9kYGzzhZRbK+xOo=");  // RFC 6455, 1.3
  EXPECT_EQ(reply.header("Sec-WebSocket-Protocol"), "");
  EXPECT_EQ(reply.header("X-Content-Type-Options"), "nosniff");
  ASSERT_TRUE(house.link(0));
  EXPECT_EQ(house.link(0)->kind, LinkKind::visit);
  EXPECT_TRUE(house.link(0)->peer.starts_with("127.0.0.1:"));
  EXPECT_EQ(eye.join("/api/v1/eye?kiosk=hall").status, 101);
  ASSERT_TRUE(house.link(1));
  EXPECT_EQ(house.link(1)->kind, LinkKind::eye);
  EXPECT_NE(house.link(0)->id, house.link(1)->id);
  EXPECT_EQ(house.server.counters().websockets, 2u);
}

TEST(Upgrade, no_compression_is_agreed_on) {
  House house;
  RawClient client(house.port());
  const auto reply =
      client.join("/api/v1/visit", "Sec-WebSocket-Extensions: permessage-deflate\r\n");
  EXPECT_EQ(reply.status, 101);
  EXPECT_EQ(reply.header("Sec-WebSocket-Extensions"), "");
}

TEST(Upgrade, subprotocol_is_echoed_when_offered_and_refused_when_only_others_are) {
  House house;
  RawClient good(house.port()), second(house.port()), other(house.port());
  EXPECT_EQ(good.join("/api/v1/visit", "Sec-WebSocket-Protocol: x, wellspring.v1\r\n")
                .header("Sec-WebSocket-Protocol"),
            "wellspring.v1");
  EXPECT_EQ(second
                .join("/api/v1/visit",
                      "Sec-WebSocket-Protocol: x\r\nSec-WebSocket-Protocol: wellspring.v1\r\n")
                .status,
            101);
  EXPECT_EQ(other.join("/api/v1/visit", "Sec-WebSocket-Protocol: wellspring.v2\r\n").status, 400);
  EXPECT_FALSE(house.server.counters().websockets > 2);
}

TEST(Upgrade, elsewhere_is_404_and_a_plain_get_is_426) {
  House house;
  RawClient elsewhere(house.port()), plain(house.port()), old(house.port()), keyless(house.port()),
      posted(house.port()), early(house.port());
  EXPECT_EQ(elsewhere.join("/api/v1/other").status, 404);
  const auto reply = plain.ask("/api/v1/visit");
  EXPECT_EQ(reply.status, 426);
  EXPECT_EQ(reply.header("Upgrade"), "websocket");
  EXPECT_EQ(plain.ask("/a").status, 200);
  const auto version =
      old.ask("/api/v1/visit",
              "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 8\r\n"
              "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n");
  EXPECT_EQ(version.status, 426);
  EXPECT_EQ(version.header("Sec-WebSocket-Version"), "13");
  EXPECT_EQ(keyless
                .ask("/api/v1/visit",
                     "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n")
                .status,
            400);
  EXPECT_EQ(posted
                .ask("/api/v1/visit",
                     "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
                     "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n",
                     "POST")
                .status,
            405);
  early.send(
      "GET /api/v1/visit HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\nUpgrade: "
      "websocket\r\n"
      "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n" +
      RawClient::frame_bytes(0x81, "x"));
  EXPECT_EQ(early.reply().status, 400);
  EXPECT_EQ(house.server.counters().websockets, 0u);
}

static int status_with_origin(House& house, const std::string& headers) {
  RawClient client(house.port());
  client.send(
      "GET /api/v1/visit HTTP/1.1\r\nHost: museum.org:8080\r\nConnection: Upgrade\r\n"
      "Upgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
      "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
      headers + "\r\n");
  return client.reply().status;
}

static StreamSettings museum_settings() {
  StreamSettings settings = quick_settings();
  settings.allowed_hosts = {"museum.org"};
  return settings;
}

TEST(Upgrade, foreign_origins_are_refused_before_it) {
  House house(museum_settings());
  EXPECT_EQ(status_with_origin(house, ""), 101);
  EXPECT_EQ(status_with_origin(house, "Origin: http://museum.org:8080\r\n"), 101);
  EXPECT_EQ(status_with_origin(house, "Origin: HTTP://Museum.Org:8080\r\n"), 101);
  for (const char* origin :
       {"http://museum.org", "http://museum.org:8081", "https://museum.org", "null",
        "http://museum.org:8080.evil.net", "http://museum.org.evil.net:8080",
        "http://evil-museum.org:8080", "http://museum.or:8080"})
    EXPECT_EQ(status_with_origin(house, "Origin: " + std::string(origin) + "\r\n"), 403) << origin;
  EXPECT_EQ(
      status_with_origin(house, "Origin: http://museum.org:8080\r\nOrigin: http://evil.net\r\n"),
      403);
  EXPECT_EQ(status_with_origin(
                house, "Origin: http://museum.org:8080\r\nOrigin: http://museum.org:8080\r\n"),
            403);
}

TEST(Upgrade, who_is_not_admitted_is_told_before_it) {
  std::atomic<int> asked = 0;
  Server server(quick_settings(),
                {.answer = House::echo,
                 .admit = [&](const HttpQuestion& question) -> UpgradeAnswer {
                   asked++;
                   if (question.authorization == "Bearer right") return {{}, "hall"};
                   HttpReply reply{.status = 401};
                   reply.headers["WWW-Authenticate"] = "Bearer";
                   reply.body = question.local ? "local" : "elsewhere";
                   return {reply};
                 },
                 .joined =
                     [&](std::shared_ptr<Link> link) {
                       link->send_text((link->local ? "local " : "elsewhere ") + link->kiosk);
                     }});
  RawClient own(server.port()), proxied(server.port()), kiosk(server.port());
  const auto reply = own.upgrade("/api/v1/eye");
  EXPECT_EQ(reply.status, 401);
  EXPECT_EQ(reply.header("WWW-Authenticate"), "Bearer");
  EXPECT_EQ(reply.body, "local");
  const std::string by_proxy = "X-Forwarded-For: 10.0.0.7\r\n";
  EXPECT_EQ(proxied.upgrade("/api/v1/eye", by_proxy).body, "elsewhere");
  EXPECT_EQ(kiosk.upgrade("/api/v1/eye", by_proxy + "Authorization: Bearer right\r\n").status, 101);
  kiosk.send(RawClient::frame_bytes(0x81, "{}"));
  const auto said = kiosk.next_frame();
  ASSERT_TRUE(said);
  EXPECT_EQ(said->payload, "elsewhere hall");
  EXPECT_EQ(asked, 3);
  EXPECT_EQ(server.counters().websockets, 1u);
}

TEST(Upgrade, more_origins_can_be_allowed) {
  auto settings = museum_settings();
  settings.allowed_origins = {"https://www.museum.org", "https://Tickets.example"};
  House house(settings);
  EXPECT_EQ(status_with_origin(house, "Origin: https://www.museum.org\r\n"), 101);
  EXPECT_EQ(status_with_origin(house, "Origin: https://tickets.example\r\n"), 101);
  EXPECT_EQ(status_with_origin(house, "Origin: http://museum.org:8080\r\n"), 101);
  EXPECT_EQ(status_with_origin(house, "Origin: https://evil.net\r\n"), 403);
}

TEST(Upgrade, a_link_that_the_show_closes_says_all_and_then_goodbye) {
  House house;
  RawClient client(house.port());
  client.join();
  auto link = house.link();
  ASSERT_TRUE(link);
  link->send_text("last");
  link->close("the museum closes");
  const auto text = client.next_frame();
  ASSERT_TRUE(text);
  EXPECT_EQ(text->payload, "last");
  const auto close = client.next_frame();
  ASSERT_TRUE(close);
  EXPECT_EQ(close->close_code(), 1000);
  EXPECT_EQ(close->payload.substr(2), "the museum closes");
  client.send(RawClient::frame_bytes(0x88, "\x03\xe8"));
  EXPECT_TRUE(client.ends());
  EXPECT_TRUE(eventually([&] { return link->closed() && house.server.counters().open == 0; }));
}

TEST(Upgrade, a_peer_that_leaves_closes_its_link) {
  House house;
  {
    RawClient rude(house.port());
    rude.join();
    ASSERT_TRUE(house.link(0));
  }
  EXPECT_TRUE(eventually([&] { return house.link(0)->closed(); }));
  RawClient polite(house.port());
  polite.join();
  ASSERT_TRUE(house.link(1));
  polite.send(RawClient::frame_bytes(0x88, "\x03\xe8"));
  EXPECT_EQ(polite.closed_with(), 1000);
  EXPECT_TRUE(house.link(1)->closed());
  EXPECT_TRUE(polite.ends());
  EXPECT_TRUE(eventually([&] { return house.server.counters().websockets == 0; }));
}

TEST(Upgrade, stop_closes_with_1001_even_those_that_do_not_answer) {
  House house;
  RawClient polite(house.port()), mute(house.port());
  polite.join();
  mute.join();
  ASSERT_TRUE(house.link(1));
  std::thread stopping([&] { house.server.stop(); });
  EXPECT_EQ(polite.closed_with(), 1001);
  polite.send(RawClient::frame_bytes(0x88, "\x03\xe9"));
  EXPECT_EQ(mute.closed_with(), 1001);
  stopping.join();  // although `mute` never said goodbye
  EXPECT_TRUE(mute.ends());
  EXPECT_TRUE(house.link(0)->closed() && house.link(1)->closed());
  EXPECT_EQ(house.server.counters().open, 0u);
  house.link(0)->send_text("after the end");  // the show may not have noticed yet
}

TEST(Client, talks_both_ways_and_keeps_what_arrived_meanwhile) {
  House house;
  WsClient client;
  client.connect({.port = house.port()});
  client.send_text("first");
  EXPECT_EQ(client.subprotocol(), "wellspring.v1");
  WsMessage message;
  EXPECT_EQ(client.receive(message, 0.01), WsClient::Got::nothing);
  auto link = house.link();
  ASSERT_TRUE(link);
  link->send_text("hello");
  EXPECT_TRUE(client.send_text("{\"type\":\"bye\"}"));
  EXPECT_EQ(House::text_from(link), "{\"type\":\"bye\"}");
  ASSERT_EQ(client.receive(message, patience), WsClient::Got::message);
  EXPECT_FALSE(message.binary);
  EXPECT_EQ(message.text(), "hello");
  link->send_picture(picture_packet(7, 300'000));
  ASSERT_EQ(client.receive(message, patience), WsClient::Got::message);
  EXPECT_TRUE(message.binary);
  EXPECT_EQ(message.bytes.size(), 300'000u);
  EXPECT_EQ(read_packet(message.bytes)->header.frame, 7u);
  link->close("enough");
  ASSERT_EQ(client.receive(message, patience), WsClient::Got::closed);
  EXPECT_EQ(client.close_code(), 1000);
  EXPECT_EQ(client.close_reason(), "enough");
  EXPECT_FALSE(client.connected());
  EXPECT_FALSE(client.send_text("x"));
  EXPECT_EQ(client.receive(message, patience), WsClient::Got::closed);
}

TEST(Client, closes_politely_and_connects_anew) {
  House house;
  WsClient client;
  client.connect({.port = house.port(), .path = "/api/v1/eye"});
  client.send_text("first");
  ASSERT_TRUE(house.link(0));
  client.close();
  EXPECT_TRUE(eventually([&] { return house.link(0)->closed(); }));
  client.connect({.port = house.port(), .subprotocol = ""});
  client.send_text("first");
  ASSERT_TRUE(house.link(1));
  EXPECT_EQ(client.subprotocol(), "");
}

TEST(Client, errors_name_address_and_cause) {
  House house;
  WsClient client;
  const auto message_of = [&](const WsTarget& target) -> std::string {
    try {
      client.connect(target, 2);
    } catch (const std::runtime_error& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_NE(message_of({.port = house.port(), .origin = "http://evil.net"}).find("HTTP status 403"),
            std::string::npos);
  EXPECT_NE(message_of({.port = house.port(), .path = "/api/v1/nowhere"}).find("HTTP status 404"),
            std::string::npos);
  const uint16_t port = house.port();
  house.server.stop();
  EXPECT_NE(message_of({.port = port}).find("127.0.0.1:" + std::to_string(port)),
            std::string::npos);
  WsMessage message;
  EXPECT_EQ(client.receive(message, patience), WsClient::Got::closed);
}

}  // namespace
}  // namespace wellspring::test
