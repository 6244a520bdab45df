// SPDX-License-Identifier: Apache-2.0
// Names, addresses, floods and places, over sockets.
#include "unit/stream/fixture.h"

namespace wellspring::test {
namespace {

static std::string frame_bytes(int first, std::string_view payload) {
  return RawClient::frame_bytes(first, payload);
}

// Loopback is a stranger.
static StreamSettings strange_settings() {
  StreamSettings settings = quick_settings();
  settings.trust_loopback = false;
  return settings;
}

TEST(Limits, a_foreign_host_gets_421_whatever_it_asks) {
  House house;
  for (const char* line : {"GET /a", "HEAD /a", "GET /api/v1/visit", "POST /api/v1/admin/announce"})
    for (const char* more :
         {"", "Origin: http://evil.example\r\n", "Connection: Upgrade\r\nUpgrade: websocket\r\n"}) {
      RawClient client(house.port());
      client.send(std::string(line) + " HTTP/1.1\r\nHost: evil.example\r\nContent-Length: 0\r\n" +
                  more + "\r\n");
      const auto reply = client.reply(std::string_view(line).starts_with("HEAD"));
      EXPECT_EQ(reply.status, 421) << line << more;
      const bool told = reply.body.find("--allow-host evil.example") != std::string::npos;
      EXPECT_NE(told, std::string_view(line).starts_with("HEAD"));
      EXPECT_TRUE(client.ends());
    }
  RawClient odd(house.port()), old(house.port());
  odd.send("GET /a HTTP/1.1\r\nHost: \xff\"<\r\n\r\n");
  EXPECT_EQ(odd.reply().status, 400);
  old.send("GET /a HTTP/1.0\r\n\r\n");  // no browser
  EXPECT_EQ(old.reply().status, 200);
}

TEST(Limits, empty_fragments_are_a_flood_like_others) {
  for (const std::string& bytes :
       {frame_bytes(0x00, ""), frame_bytes(0x00, "x"), frame_bytes(0x89, "")}) {
    House house;
    RawClient client(house.port());
    client.join();
    ASSERT_TRUE(house.link());
    std::string many = frame_bytes(0x01, "");
    for (int i = 0; i < 100'000; i++) many += bytes;
    std::thread sending([&] { client.send(many); });  // until it is cut
    EXPECT_EQ(client.closed_with(), 1008);
    EXPECT_TRUE(eventually([&] { return house.server.counters().open == 0; }));
    client.close();
    sending.join();
    EXPECT_EQ(house.server.counters().flood_closed, 1u);
    EXPECT_TRUE(house.link()->closed());
  }
}

TEST(Limits, a_peer_without_a_first_message_is_closed_and_never_joins) {
  auto settings = quick_settings();
  settings.first_message_timeout = 0.3;
  House house(settings);
  RawClient silent(house.port()), pinging(house.port()), half(house.port()), good(house.port());
  for (RawClient* client : {&silent, &pinging, &half, &good})
    ASSERT_EQ(client->upgrade().status, 101);
  pinging.send(frame_bytes(0x89, "here"));
  half.send(frame_bytes(0x01, "never ends"));
  good.send(frame_bytes(0x81, "hello"));
  ASSERT_TRUE(house.link(0));
  EXPECT_EQ(silent.closed_with(), 1008);
  EXPECT_EQ(pinging.closed_with(), 1008);
  EXPECT_EQ(half.closed_with(), 1008);
  EXPECT_TRUE(eventually([&] { return house.server.counters().silent_closed == 3; }));
  EXPECT_EQ(house.first_texts, "hello;");
  EXPECT_FALSE(house.link(0)->closed());
}

TEST(Limits, what_one_address_may_have) {
  auto settings = strange_settings();
  settings.limits.websockets_an_address = 2;
  settings.limits.requests_at_once = 8;
  settings.limits.requests_a_second = 0;
  House house(settings);
  {
    RawClient first(house.port()), second(house.port()), third(house.port());
    EXPECT_EQ(first.join().status, 101);
    EXPECT_EQ(second.join().status, 101);
    const auto reply = third.join();
    EXPECT_EQ(reply.status, 429);
    EXPECT_FALSE(reply.header("Retry-After").empty());
  }
  EXPECT_TRUE(eventually([&] { return house.server.counters().open == 0; }));
  RawClient again(house.port());  // places are given back
  EXPECT_EQ(again.join().status, 101);
  RawClient asking(house.port());
  for (int i = 0; i < 4; i++) EXPECT_EQ(asking.ask("/a").status, 200);
  EXPECT_EQ(asking.ask("/a").status, 429);
  EXPECT_TRUE(asking.ends());
  EXPECT_EQ(house.server.counters().limited, 2u);
}

TEST(Limits, new_connections_of_an_address) {
  auto settings = strange_settings();
  settings.limits.new_connections_at_once = 3;
  settings.limits.new_connections_a_second = 0;
  House house(settings);
  for (int i = 0; i < 3; i++) EXPECT_EQ(RawClient(house.port()).ask("/a").status, 200);
  RawClient fourth(house.port());
  EXPECT_EQ(fourth.ask("/a").status, 429);
  EXPECT_EQ(house.server.counters().refused, 1u);
}

TEST(Limits, what_all_addresses_together_may_have) {
  auto settings = strange_settings();
  settings.limits.all_frames_at_once = 206;  // three WebSockets, their first messages, 200 more
  settings.limits.all_frames_a_second = 0;
  settings.limits.all_requests_at_once = 5;
  settings.limits.all_requests_a_second = 0;
  House house(settings);
  RawClient first(house.port()), loud(house.port()), modest(house.port());
  for (RawClient* client : {&first, &loud, &modest}) ASSERT_EQ(client->join().status, 101);
  ASSERT_TRUE(house.link(2));
  std::string many;
  for (int i = 0; i < 200; i++) many += frame_bytes(0x81, "x");
  size_t arrived = 0;
  auto arrive = [&] {
    for (size_t i = 0; i < 3; i++) arrived += house.link(i)->take_heard().size();
    return arrived == 200;
  };
  first.send(many);
  EXPECT_TRUE(eventually(arrive));
  RawClient late(house.port());
  EXPECT_EQ(late.join().status, 503);
  std::string more = many;
  for (int i = 0; i < 590; i++) more += frame_bytes(0x81, "x");
  loud.send(more);
  EXPECT_EQ(loud.closed_with(), 1008);
  arrive();  // takes the messages that came before that
  arrived = 0;
  modest.send(many);
  EXPECT_TRUE(eventually(arrive)) << "no more than a page says";
  RawClient asking(house.port());
  EXPECT_EQ(asking.ask("/a").status, 200);
  const auto refused = RawClient(house.port()).ask("/a");
  EXPECT_EQ(refused.status, 503);
  EXPECT_FALSE(refused.header("Retry-After").empty());
  EXPECT_EQ(house.server.counters().limited_in_all, 2u);
}

TEST(Limits, frames_of_all_visits_of_an_address) {
  auto settings = strange_settings();
  settings.limits.frames_at_once = 350;
  settings.limits.frames_a_second = 0;
  House house(settings);
  RawClient first(house.port()), second(house.port());
  first.join();
  second.join();
  std::string many;
  for (int i = 0; i < 200; i++) many += frame_bytes(0x81, "x");
  first.send(many);
  ASSERT_TRUE(house.link(0));
  size_t arrived = 0;
  EXPECT_TRUE(eventually([&] {
    arrived += house.link(0)->take_heard().size() + house.link(1)->take_heard().size();
    return arrived == 200;
  }));
  second.send(many);
  EXPECT_EQ(second.closed_with(), 1008);
}

TEST(Limits, those_who_never_finish_a_request_make_place) {
  auto settings = strange_settings();
  settings.limits.connections = 8;
  settings.limits.reserve = 0;
  House house(settings);
  std::vector<std::unique_ptr<RawClient>> slow;
  for (int i = 0; i < 8; i++) {
    slow.push_back(std::make_unique<RawClient>(house.port()));
    slow.back()->send("GET / HTTP/1.1\r\nX-");
    ASSERT_TRUE(eventually([&] { return house.server.counters().open == size_t(i + 1); }));
  }
  RawClient visitor(house.port());
  EXPECT_EQ(visitor.join().status, 101);
  EXPECT_TRUE(slow[0]->ends());
  EXPECT_EQ(house.server.counters().dropped, 1u);
  for (int i = 0; i < 20; i++) EXPECT_EQ(RawClient(house.port()).ask("/a").status, 200);
  ASSERT_TRUE(house.link());
  EXPECT_FALSE(house.link()->closed());
}

TEST(Limits, strangers_leave_places_to_loopback) {
  auto settings = quick_settings();
  settings.limits.connections = 8;
  settings.limits.reserve = 2;
  settings.proxies = {"127.0.0.1"};  // so that they can be strangers
  House house(settings);
  const std::string stranger = "X-Forwarded-For: 203.0.113.1\r\n";
  std::vector<std::unique_ptr<RawClient>> visits;
  for (int i = 0; i < 6; i++) {
    visits.push_back(std::make_unique<RawClient>(house.port()));
    EXPECT_EQ(visits.back()->join("/api/v1/visit", stranger).status, 101);
  }
  RawClient seventh(house.port()), health(house.port());
  EXPECT_EQ(seventh.join("/api/v1/visit", stranger).status, 503);
  EXPECT_TRUE(seventh.ends());
  EXPECT_EQ(health.ask("/healthz").status, 200);
}

TEST(Limits, count_for_whom_a_proxy_asks) {
  auto settings = quick_settings();
  settings.proxies = {"127.0.0.1"};
  settings.limits.websockets_an_address = 1;
  House house(settings);
  const auto visit = [&](RawClient& client, const std::string& forwarded) {
    return client.join("/api/v1/visit", "X-Forwarded-For: " + forwarded + "\r\n").status;
  };
  RawClient first(house.port()), second(house.port()), third(house.port()), liar(house.port()),
      odd(house.port());
  EXPECT_EQ(visit(first, "203.0.113.1"), 101);
  ASSERT_TRUE(house.link(0));
  EXPECT_TRUE(house.link(0)->peer.starts_with("203.0.113.0/24 "));
  EXPECT_EQ(visit(second, "203.0.113.1"), 429);
  EXPECT_EQ(visit(third, "203.0.113.2"), 101);
  EXPECT_EQ(visit(liar, "127.0.0.1, 203.0.113.1"), 429);
  EXPECT_EQ(visit(odd, "somebody"), 400);
}

TEST(Limits, a_proxy_that_nobody_named_lends_no_trust) {
  auto settings = quick_settings();
  settings.limits.websockets_an_address = 1;
  House house(settings);
  RawClient first(house.port()), second(house.port()), own(house.port()), more(house.port());
  EXPECT_EQ(first.join("/api/v1/visit", "X-Forwarded-For: 203.0.113.1\r\n").status, 101);
  EXPECT_EQ(second.join("/api/v1/visit", "Via: 1.1 proxy\r\n").status, 429);
  EXPECT_EQ(own.join().status, 101);
  EXPECT_EQ(more.join().status, 101);
}

TEST(Limits, settings_that_mean_nothing_are_named) {
  const auto message_of = [](const StreamSettings& settings) -> std::string {
    try {
      Server server(settings, {});
    } catch (const std::runtime_error& e) {
      return e.what();
    }
    return "";
  };
  auto settings = quick_settings();
  settings.trusted = {"10.0.0.0/40"};
  EXPECT_NE(message_of(settings).find("10.0.0.0/40"), std::string::npos);
  settings = quick_settings();
  settings.proxies = {"proxy"};
  EXPECT_NE(message_of(settings).find("'proxy'"), std::string::npos);
  settings = quick_settings();
  settings.certificate = "/nowhere/cert.pem";
  EXPECT_NE(message_of(settings).find("both"), std::string::npos);
  settings.key = "/nowhere/key.pem";
  EXPECT_NE(message_of(settings).find("/nowhere/cert.pem"), std::string::npos);
}

TEST(AgentPort, tells_every_caller_one_line) {
  auto settings = quick_settings();
  {
    House finding;  // a port that is free, as it has just been
    settings.agent_port = finding.port();
  }
  std::atomic<bool> known = false;
  Server server(settings, {.answer = House::echo,
                           .joined = [](std::shared_ptr<Link>) {},
                           .agent = [&] { return known ? "18%" : std::string(); }});
  auto told = [&] {
    RawClient caller(settings.agent_port);
    EXPECT_TRUE(caller.ends());
    return caller.input;
  };
  EXPECT_EQ(told(), "");
  known = true;
  for (int i = 0; i < 3; i++) EXPECT_EQ(told(), "18%\n");
  server.stop();
}

}  // namespace
}  // namespace wellspring::test
