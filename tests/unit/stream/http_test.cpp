// SPDX-License-Identifier: Apache-2.0
#include <sys/resource.h>

#include <future>

#include "stream/session.h"
#include "unit/folder.h"
#include "unit/stream/fixture.h"

namespace wellspring::test {
namespace {

TEST(Http, get_and_head_on_one_connection) {
  House house;
  RawClient client(house.port());
  const auto get = client.ask("/a/b?x=1&y=%20");
  EXPECT_EQ(get.status, 200);
  EXPECT_EQ(get.body, "/a/b|x=1|y= ");
  EXPECT_EQ(get.header("Content-Type"), "text/plain; charset=utf-8");
  const auto head = client.ask("/a/b", "", "HEAD");
  EXPECT_EQ(head.status, 200);
  EXPECT_EQ(head.header("Content-Length"), "4");
  const auto missing = client.ask("/missing");  // would misread if HEAD had sent a body
  EXPECT_EQ(missing.status, 404);
  EXPECT_EQ(missing.body, "/missing");
  EXPECT_EQ(house.server.counters().accepted, 1u);
  EXPECT_EQ(house.server.counters().http_requests, 3u);
}

TEST(Http, pipelined_requests_are_answered_in_order) {
  House house;
  RawClient client(house.port());
  const std::string rest = " HTTP/1.1\r\nHost: localhost\r\n\r\n";
  client.send("GET /1" + rest + "GET /2" + rest + "GET /3" + rest);
  EXPECT_EQ(client.reply().body, "/1");
  EXPECT_EQ(client.reply().body, "/2");
  EXPECT_EQ(client.reply().body, "/3");
}

TEST(Http, http_1_0_and_connection_close_end_the_connection) {
  House house;
  RawClient old(house.port());
  old.send("GET /a HTTP/1.0\r\n\r\n");
  EXPECT_EQ(old.reply().body, "/a");
  EXPECT_TRUE(old.ends());
  RawClient closing(house.port());
  EXPECT_EQ(closing.ask("/a", "Connection: close\r\n").header("Connection"), "close");
  EXPECT_TRUE(closing.ends());
}

TEST(Http, every_reply_carries_the_security_headers) {
  auto settings = quick_settings();
  settings.limits.connections = 9;
  House house(settings);
  std::map<int, std::string> heads;  // one of each status
  const auto note = [&](const RawClient::Reply& reply) { heads[reply.status] = reply.head; };
  const auto ask = [&](const std::string& line, const std::string& more = "") {
    RawClient client(house.port());
    client.send(line + " HTTP/1.1\r\n" + more + "\r\n");
    note(client.reply(line.starts_with("HEAD")));
  };
  const std::string host = "Host: localhost\r\n";
  for (const char* target : {"/a", "/missing", "/throws", "/../x", "/api/v1/visit"})
    ask("GET " + std::string(target), host);
  ask("GET /tagged", host + "If-None-Match: \"v1\"\r\n");
  ask("PUT /a", host);
  ask("GET /" + std::string(3000, 'a'), host);
  ask("GET /a", host + "X: " + std::string(20000, 'a') + "\r\n");
  ask("GET /a", host + "Content-Length: 999999\r\n");
  ask("GET /a", "Host: evil.example\r\n");
  ask("POST /api/v1/admin/announce", host + "Content-Length: 0\r\n");
  ask("POST /api/v1/admin/announce", host + "Origin: http://a\r\nContent-Length: 0\r\n");
  std::vector<std::unique_ptr<RawClient>> visits;
  while (!heads.contains(503) && visits.size() < 100) {
    visits.push_back(std::make_unique<RawClient>(house.port()));
    note(visits.back()->join());
  }
  for (const int status :
       {101, 200, 304, 400, 403, 404, 405, 413, 414, 415, 421, 426, 431, 500, 503})
    EXPECT_TRUE(heads.contains(status)) << status;
  for (const auto& [status, head] : heads) {
    for (const char* line :
         {"X-Content-Type-Options: nosniff", "Referrer-Policy: no-referrer",
          "Content-Security-Policy: default-src 'none'; script-src 'self'; ",
          "Permissions-Policy: camera=(), microphone=()", "X-Frame-Options: SAMEORIGIN",
          "Cross-Origin-Opener-Policy: same-origin", "Cross-Origin-Resource-Policy: same-site"})
      EXPECT_NE(head.find("\r\n" + std::string(line)), std::string::npos) << status << line;
    EXPECT_EQ(head.find("Strict-Transport-Security"), std::string::npos) << "without TLS";
    if (status == 101) continue;
    EXPECT_NE(head.find("\r\nCache-Control: "), std::string::npos) << status;
    EXPECT_NE(head.find("\r\nDate: "), std::string::npos) << status;
  }
}

TEST(Http, other_methods_are_told_what_is_allowed) {
  House house;
  for (const char* method : {"POST", "PUT", "DELETE", "OPTIONS", "PATCH", "BREW"}) {
    RawClient client(house.port());
    const auto reply = client.ask("/a", "", method);
    EXPECT_EQ(reply.status, 405) << method;
    EXPECT_EQ(reply.header("Allow"), "GET, HEAD") << method;
    EXPECT_TRUE(client.ends()) << method;
  }
}

TEST(Http, etag_makes_a_304_without_body) {
  House house;
  RawClient client(house.port());
  EXPECT_EQ(client.ask("/tagged").header("ETag"), "\"v1\"");
  const auto same = client.ask("/tagged", "If-None-Match: W/\"v1\"\r\n");
  EXPECT_EQ(same.status, 304);
  EXPECT_EQ(same.header("ETag"), "\"v1\"");
  EXPECT_EQ(same.body, "");
  EXPECT_EQ(client.ask("/tagged", "If-None-Match: \"v0\"\r\n").body, "/tagged");
}

TEST(Http, files_come_in_pieces_and_in_parts) {
  Folder folder;
  std::string bytes(2 * file_piece_bytes + 12345, ' ');
  for (size_t i = 0; i < bytes.size(); i++) bytes[i] = char(i * 31 + i / 977);
  const std::string path = folder.write("film", bytes);
  House house(quick_settings(), [&](const HttpQuestion& question) {
    HttpReply reply;
    // "/long" is shorter on the disk than was promised.
    reply.file = FilePart{path, 0, bytes.size() + (question.path == "/long" ? 1000 : 0)};
    return reply;
  });
  RawClient client(house.port());
  const auto whole = client.ask("/film");
  EXPECT_EQ(whole.status, 200);
  EXPECT_TRUE(whole.body == bytes);
  const auto part = client.ask("/film", "Range: bytes=1000-300000\r\n");
  EXPECT_EQ(part.status, 206);
  EXPECT_TRUE(part.body == bytes.substr(1000, 299001));
  EXPECT_EQ(part.header("Content-Range"), "bytes 1000-300000/" + std::to_string(bytes.size()));
  const auto none = client.ask("/film", "Range: bytes=" + std::to_string(bytes.size()) + "-\r\n");
  EXPECT_EQ(none.status, 416);
  EXPECT_EQ(client.ask("/film", "", "HEAD").header("Content-Length"), std::to_string(bytes.size()));
  EXPECT_EQ(house.server.counters().accepted, 1u) << "one connection for all of them";
  RawClient cut(house.port());
  cut.send("GET /long HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_TRUE(cut.ends()) << "the rest will not come";
}

TEST(Http, an_answer_that_throws_is_a_500_and_no_end) {
  House house;
  RawClient client(house.port());
  EXPECT_EQ(client.ask("/throws").status, 500);
  EXPECT_EQ(client.ask("/a").status, 200);
}

TEST(Http, no_target_leads_out) {
  House house;
  for (const char* target :
       {"/../etc/passwd", "/a/../../x", "/%2e%2e/x", "/%2E%2e%2Fx", "/%252e%252e/x", "/..%2fx",
        "/%2F..%2F", "//etc/passwd", "/..\\x", "/a%5c..%5cx", "/a%00.js", "/./a", "/a//b",
        "http://x/../y", "/%c0%ae/"}) {
    RawClient client(house.port());
    const auto reply = client.ask(target);
    EXPECT_EQ(reply.status, 400) << target;
    EXPECT_EQ(reply.body.find("passwd"), std::string::npos) << target;
  }
}

TEST(Http, what_is_not_http_is_refused_and_closed) {
  House house;
  for (const char* bytes :
       {"hello\r\n\r\n", "GET\r\n\r\n", "GET /a\r\n\r\n", "GET /a HTTP/9.9\r\n\r\n",
        "GET /a b HTTP/1.1\r\n\r\n", "GET /a HTTP/1.1\r\nHost localhost\r\n\r\n",
        "GET /a HTTP/1.1\r\nHost: localhost\r\nContent-Length: x\r\n\r\n",
        "GET /a HTTP/1.1\r\nHost: localhost\r\nContent-Length: -1\r\n\r\n",
        "GET /a HTTP/1.1\r\n\r\n", "GET /a HTTP/1.1\r\nHost: localhost\r\nHost: localhost\r\n\r\n",
        "GET /a HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1\r\nTransfer-Encoding: "
        "chunked\r\n\r\n0\r\n\r\n",
        "\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03\r\n\r\n"}) {
    RawClient client(house.port());
    client.send(bytes);
    EXPECT_EQ(client.reply().status, 400) << bytes;
    EXPECT_TRUE(client.ends()) << bytes;
  }
}

TEST(Http, too_large_headers_targets_and_bodies) {
  House house;
  RawClient header(house.port());
  EXPECT_EQ(header.ask("/a", "X: " + std::string(20'000, 'x') + "\r\n").status, 431);
  RawClient target(house.port());
  EXPECT_EQ(target.ask("/" + std::string(3000, 'a')).status, 414);
  RawClient body(house.port());
  EXPECT_EQ(body.ask("/a", "Content-Length: 70000\r\n").status, 413);
  RawClient huge(house.port());
  EXPECT_EQ(huge.ask("/a", "Content-Length: 99999999999999\r\n").status, 413);
  RawClient chunks(house.port());
  chunks.send("GET /a HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\n");
  for (int i = 0; i < 5; i++) chunks.send("4000\r\n" + std::string(0x4000, 'x') + "\r\n");
  EXPECT_EQ(chunks.reply().status, 413);
  RawClient fine(house.port());
  fine.send("GET /a HTTP/1.1\r\nHost: localhost\r\nContent-Length: 5\r\n\r\nhello");
  EXPECT_EQ(fine.reply().status, 200);
  EXPECT_EQ(fine.ask("/b").body, "/b");
}

TEST(Http, a_transfer_encoding_that_is_unknown_is_told_so_and_ends_the_connection) {
  House house;
  for (const char* coding : {"gzip", "gzip, chunked", "identity"}) {
    RawClient client(house.port());
    client.send(std::string("GET /a HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: ") + coding +
                "\r\n\r\nGET /b HTTP/1.1\r\nHost: localhost\r\n\r\n");
    EXPECT_EQ(client.reply().status, 501) << coding;
    EXPECT_TRUE(client.ends()) << coding;
  }
}

TEST(Http, slow_headers_are_cut_while_others_are_served) {
  auto settings = quick_settings();
  settings.header_timeout = 0.3;
  House house(settings);
  RawClient slow(house.port());
  slow.send("GET /a HTTP/1.1\r\n");
  std::atomic<bool> cut{false};
  std::thread dripping([&] {
    const auto start = std::chrono::steady_clock::now();
    while (std::chrono::steady_clock::now() - start < std::chrono::duration<double>(patience)) {
      slow.send("X: y\r\n");
      slow.more(0.02);
      if (slow.ends(0.001)) {
        cut = true;
        return;
      }
    }
  });
  RawClient other(house.port());
  EXPECT_EQ(other.ask("/b").status, 200);
  dripping.join();
  EXPECT_TRUE(cut);
  RawClient silent(house.port());
  EXPECT_TRUE(silent.ends());
}

TEST(Http, a_slow_answer_holds_up_nobody_else) {
  std::promise<void> gate;
  auto opened = gate.get_future().share();
  std::atomic<int> begun{0};
  const auto answer = [&](const HttpQuestion& question) {
    if (question.path == "/still") begun++, opened.wait();
    return House::echo(question);
  };
  House house(quick_settings(), answer, [](const HttpQuestion& q) { return q.path == "/still"; });
  // Two threads and eight places: more are told to come back.
  std::vector<std::unique_ptr<RawClient>> waiting;
  const std::string request = "GET /still HTTP/1.1\r\nHost: localhost\r\n\r\n";
  for (int i = 0; i < 2; i++) {
    waiting.push_back(std::make_unique<RawClient>(house.port()));
    waiting.back()->send(request);
    // The first two must be off the queue before it is filled.
    ASSERT_TRUE(eventually([&] { return begun == i + 1; }));
  }
  for (int i = 0; i < 9; i++) {
    waiting.push_back(std::make_unique<RawClient>(house.port()));
    waiting.back()->send(request);
  }
  RawClient quick(house.port());
  for (int i = 0; i < 5; i++) EXPECT_EQ(quick.ask("/healthz").status, 200);
  EXPECT_TRUE(eventually(
      [&] { return std::erase_if(waiting, [](auto& client) { return client->more(0); }) == 1; }));
  gate.set_value();
  int answered = 0;
  EXPECT_EQ(waiting.size(), 10u);
  for (auto& client : waiting) answered += client->reply().status == 200;
  EXPECT_EQ(answered, 10);
}

TEST(Http, beyond_the_limit_of_connections_503_with_retry_after) {
  auto settings = quick_settings();
  settings.limits.connections = 2;
  House house(settings);
  RawClient first(house.port()), second(house.port());
  EXPECT_EQ(first.ask("/a").status, 200);
  EXPECT_EQ(second.ask("/a").status, 200);
  {
    RawClient third(house.port());
    const auto reply = third.ask("/a");
    EXPECT_EQ(reply.status, 503);
    EXPECT_FALSE(reply.header("Retry-After").empty());
    EXPECT_TRUE(third.ends());
  }
  EXPECT_EQ(house.server.counters().refused, 1u);
  first.close();
  EXPECT_TRUE(eventually([&] { return house.server.counters().open <= 1; }));
  RawClient fourth(house.port());
  EXPECT_EQ(fourth.ask("/a").status, 200);
}

TEST(Http, out_of_descriptors_the_door_stays_open) {
  House house;
  {
    // The client has its descriptor before there are none: a number that looks free belongs for
    // moments to the server, since the kernel takes one before it sees that nobody is to be
    // accepted.
    RawClient client;
    rlimit old{};
    getrlimit(RLIMIT_NOFILE, &old);
    rlimit none = old;
    none.rlim_cur = 0;
    setrlimit(RLIMIT_NOFILE, &none);
    EXPECT_TRUE(client.connect(house.port()));  // by the kernel, but nobody can accept it
    EXPECT_TRUE(eventually([&] { return house.server.counters().accept_errors >= 2; }));
    EXPECT_EQ(house.server.counters().accepted, 0u);
    setrlimit(RLIMIT_NOFILE, &old);
    EXPECT_EQ(client.ask("/a").status, 200);  // the one that waited is served
  }
  RawClient client(house.port());
  EXPECT_EQ(client.ask("/a").status, 200);
}

TEST(Http, a_port_in_use_is_named) {
  House house;
  auto settings = quick_settings();
  settings.port = house.port();
  try {
    Server second(settings, {});
    FAIL() << "two servers on one port";
  } catch (const std::runtime_error& e) {
    EXPECT_NE(std::string(e.what()).find("127.0.0.1:" + std::to_string(house.port())),
              std::string::npos)
        << e.what();
  }
  settings.host = "no.such.host.invalid";
  EXPECT_THROW(Server(settings, {}), std::runtime_error);
}

TEST(Http, stop_finishes_the_answer_under_way_and_is_idempotent) {
  std::promise<void> asked;
  House house(quick_settings(), [&](const HttpQuestion& question) {
    asked.set_value();
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    return House::echo(question);
  });
  RawClient busy(house.port()), idle(house.port()), half(house.port());
  busy.send("GET /late HTTP/1.1\r\nHost: localhost\r\n\r\n");
  half.send("GET /half HT");
  asked.get_future().wait();
  house.server.stop();
  house.server.stop();
  EXPECT_EQ(busy.reply().body, "/late");
  EXPECT_TRUE(idle.ends());
  EXPECT_TRUE(half.ends());
  EXPECT_EQ(house.server.counters().open, 0u);
  RawClient late(house.port());
  EXPECT_FALSE(late.connected());
}

}  // namespace
}  // namespace wellspring::test
