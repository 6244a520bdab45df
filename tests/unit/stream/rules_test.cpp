// SPDX-License-Identifier: Apache-2.0
// Pure rules: targets, origins, subprotocols, entity tags, rates, the worker pool.
#include <gtest/gtest.h>

#include <unistd.h>

#include <atomic>
#include <future>

#include "base/clock.h"
#include "stream/core.h"
#include "stream/reply.h"
#include "stream/target.h"

namespace wellspring::test {
namespace {

TEST(Target, good_ones_are_decoded_once) {
  HttpQuestion q;
  ASSERT_EQ(read_target("/", q), 200);
  EXPECT_EQ(q.path, "/");
  ASSERT_EQ(read_target("/a%20b/%C3%A9.js", q), 200);
  EXPECT_EQ(q.path, "/a b/\xc3\xa9.js");
  ASSERT_EQ(read_target("/a/", q), 200);
  EXPECT_EQ(q.path, "/a/");
  ASSERT_EQ(read_target("/...x/.well-known/..a", q), 200);
  ASSERT_EQ(read_target("/100%25", q), 200);
  EXPECT_EQ(q.path, "/100%");
  ASSERT_EQ(read_target("http://museum.org:80/a?x=1", q), 200);
  EXPECT_EQ(q.path, "/a");
  EXPECT_EQ(q.query.at("x"), "1");
  ASSERT_EQ(read_target("http://museum.org", q), 200);
  EXPECT_EQ(q.path, "/");
}

TEST(Target, queries) {
  HttpQuestion q;
  ASSERT_EQ(read_target("/a?x=1&y=a+b%26c&x=2&&flag&=v&e=", q), 200);
  EXPECT_EQ(q.query.at("x"), "2");
  EXPECT_EQ(q.query.at("y"), "a b&c");
  EXPECT_EQ(q.query.at("flag"), "");
  EXPECT_EQ(q.query.at("e"), "");
  EXPECT_EQ(q.query.at(""), "v");
  EXPECT_EQ(q.query.size(), 5u);
  ASSERT_EQ(read_target("/a?p=../../etc%2fpasswd", q), 200);  // a value is no path
  EXPECT_EQ(q.query.at("p"), "../../etc/passwd");
  ASSERT_EQ(read_target("/a", q), 200);
  EXPECT_TRUE(q.query.empty());
  EXPECT_EQ(read_target("/a?x=%", q), 400);
  EXPECT_EQ(read_target("/a?x=%zz", q), 400);
  EXPECT_EQ(read_target("/a?x=%00", q), 400);
  EXPECT_EQ(read_target("/a?x=%ff", q), 400);
  std::string many = "/a?";
  for (size_t i = 0; i <= max_query_fields; i++) many += "k" + std::to_string(i) + "&";
  EXPECT_EQ(read_target(many, q), 400);
}

TEST(Target, ways_out_are_refused) {
  HttpQuestion q;
  for (const char* target : {"",
                             "a",
                             "*",
                             "/..",
                             "/../x",
                             "/a/..",
                             "/a/../b",
                             "/./a",
                             "/a/.",
                             "/%2e%2e/x",
                             "/%2E%2E",
                             "/.%2e/x",
                             "/%252e%252e/x",
                             "/a%252fb",
                             "/..%2fx",
                             "/a%2Fb",
                             "/%2F..%2F",
                             "//etc/passwd",
                             "/a//b",
                             "/a//",
                             "/..\\x",
                             "/a\\b",
                             "/a%5cb",
                             "/a%255cb",
                             "/%00",
                             "/a%00.js",
                             "/a%2500",
                             "/a%0ab",
                             "/a%7f",
                             "/a%",
                             "/a%4",
                             "/a%g1",
                             "/%ff",
                             "/%c0%ae%c0%ae/x",
                             "/%ed%a0%80",
                             "/a#b",
                             "http://",
                             "http:/a"})
    EXPECT_NE(read_target(target, q) == 200 && q.path != "/", true) << target;
  EXPECT_EQ(read_target("/" + std::string(max_target_bytes - 1, 'a'), q), 200);
  EXPECT_EQ(read_target("/" + std::string(max_target_bytes, 'a'), q), 414);
}

TEST(ThisMachine, is_a_loopback_peer_by_its_own_name_and_through_no_proxy) {
  for (const char* peer : {"127.0.0.1:5", "127.9.9.9:65000", "::1:80", "::ffff:127.0.0.1:80"})
    for (const char* host :
         {"localhost", "LocalHost:8080", "127.0.0.1:8080", "127.0.1.1", "[::1]", "[::1]:8080"}) {
      EXPECT_TRUE(is_from_this_machine(peer, false, host)) << peer << " " << host;
      EXPECT_FALSE(is_from_this_machine(peer, true, host)) << peer << " " << host;
    }
  for (const char* peer : {"10.0.0.7:5", "192.168.127.1:80", "2001:db8::1:80", "::ffff:10.0.0.1:80",
                           "12.7.0.1:80", "::2:1:80", ""})
    EXPECT_FALSE(is_from_this_machine(peer, false, "localhost")) << peer;
  // A name of somebody else that leads here.
  for (const char* host :
       {"", "museum.org", "127.0.0.1.evil.net", "localhost.evil.net:8080", "evil.net:8080",
        "localhost@evil.net", "10.0.0.7", "127.0.0.1, evil.net"})
    EXPECT_FALSE(is_from_this_machine("127.0.0.1:5", false, host)) << host;
}

TEST(ThisMachine, proxies_are_known_by_their_headers) {
  for (const char* name : {"Forwarded", "x-forwarded-for", "X-Forwarded-Proto", "X-REAL-IP", "Via"})
    EXPECT_TRUE(is_proxy_header(name)) << name;
  for (const char* name : {"Host", "X-Forward", "Viaduct", ""})
    EXPECT_FALSE(is_proxy_header(name)) << name;
}

static bool allowed(const char* origin, const char* host, const char* extra = "") {
  return origin_allowed({origin}, host, {"https://tickets.example", extra});
}

TEST(Origin, same_host_and_port_only) {
  EXPECT_TRUE(origin_allowed({}, "museum.org", {}));
  EXPECT_TRUE(allowed("http://museum.org:8080", "museum.org:8080"));
  EXPECT_TRUE(allowed("http://museum.org", "museum.org"));
  EXPECT_TRUE(allowed("http://museum.org", "museum.org:80"));
  EXPECT_TRUE(allowed("https://museum.org", "museum.org"));
  EXPECT_TRUE(allowed("https://museum.org", "museum.org:443"));
  EXPECT_TRUE(allowed("HTTP://MUSEUM.org:8080", "museum.ORG:8080"));
  EXPECT_TRUE(allowed("http://[::1]:8080", "[::1]:8080"));
  for (const char* origin :
       {"http://museum.org", "https://museum.org:443", "http://museum.org:8081",
        "http://museum.org:80800", "null", "", "http://museum.org:8080.evil.net",
        "http://museum.org.evil.net:8080", "http://evil-museum.org:8080",
        "http://museum.org:8080@evil.net", "http://museum.or:8080", "http://museum.org:8080/",
        "http://museum.org:8080#", "museum.org:8080", "ftp://museum.org:8080",
        "http://museum.org:8080 http://evil.net", "http://", "http://:8080",
        "file://museum.org:8080"})
    EXPECT_FALSE(allowed(origin, "museum.org:8080")) << origin;
  EXPECT_FALSE(allowed("http://museum.org", "museum.org:443"));
  EXPECT_FALSE(allowed("http://[::1]:8080", "[::2]:8080"));
  EXPECT_FALSE(allowed("http://[::1", "[::1"));
  EXPECT_FALSE(allowed("http://", ""));
}

TEST(Origin, two_are_one_too_many_whatever_they_are) {
  EXPECT_FALSE(origin_allowed({"http://a", "http://a"}, "a", {}));
  EXPECT_FALSE(origin_allowed({"http://a", "http://b"}, "a", {"*"}));
}

TEST(Origin, the_allowed_one_is_exact) {
  EXPECT_TRUE(allowed("https://www.museum.org", "10.0.0.1:8080", "https://www.museum.org"));
  EXPECT_FALSE(allowed("http://www.museum.org", "10.0.0.1:8080", "https://www.museum.org"));
  EXPECT_FALSE(
      allowed("https://www.museum.org.evil.net", "10.0.0.1:8080", "https://www.museum.org"));
  EXPECT_FALSE(allowed("https://www.museum", "10.0.0.1:8080", "https://www.museum.org"));
  EXPECT_TRUE(allowed("https://anybody.net", "10.0.0.1:8080", "*"));
}

TEST(HostNames, addresses_own_names_and_those_named_only) {
  const HostNames hosts({"Museum.example", "kiosk"}, {"https://www.museum.org:8443"}, "hall.lan");
  for (const char* host : {"127.0.0.1", "10.1.2.3:8080", "[::1]", "[2001:db8::7]:80", "localhost",
                           "LOCALHOST:8080", "localhost.", "museum.example", "museum.example.:443",
                           "kiosk:80", "www.museum.org", "hall.lan:1"})
    EXPECT_TRUE(hosts.hold(host)) << host;
  for (const char* host :
       {"", "evil.example", "evil.example:8080", "museum.example.evil.net", "xmuseum.example",
        "127.0.0.1.evil.net", "127.0.0.1.nip.io", "::1", "[evil]", "[127.0.0.1]", "2130706433",
        "0x7f.1", "localhost:x", "localhost evil.example", "museum.example@evil.net", "127.0.0.1,x",
        "museum.org", "/", "*"})
    EXPECT_FALSE(hosts.hold(host)) << host;
  char own[256] = "";
  ASSERT_EQ(gethostname(own, sizeof(own) - 1), 0);
  EXPECT_TRUE(hosts.hold(own));
  EXPECT_TRUE(HostNames({"*"}, {}, "0.0.0.0").hold("evil.example"));
}

TEST(Subprotocol, is_found_in_a_list) {
  EXPECT_TRUE(offers_protocol("wellspring.v1", "wellspring.v1"));
  EXPECT_TRUE(offers_protocol("chat, wellspring.v1 ,x", "wellspring.v1"));
  EXPECT_FALSE(offers_protocol("wellspring.v10, wellspring, WELLSPRING.V1", "wellspring.v1"));
  EXPECT_FALSE(offers_protocol("", "wellspring.v1"));
}

TEST(EntityTag, comparison) {
  EXPECT_TRUE(etag_matches("\"a\"", "\"a\""));
  EXPECT_TRUE(etag_matches("*", "\"a\""));
  EXPECT_TRUE(etag_matches("\"x\", W/\"a\"", "\"a\""));
  EXPECT_TRUE(etag_matches("\"a\"", "W/\"a\""));
  EXPECT_TRUE(etag_matches("\"x,y\" , \"a\"", "\"a\""));
  EXPECT_FALSE(etag_matches("\"ab\"", "\"a\""));
  EXPECT_FALSE(etag_matches("a", "\"a\""));
  EXPECT_FALSE(etag_matches("\"x", "\"a\""));
  EXPECT_FALSE(etag_matches(",,", "\"a\""));
}

TEST(Range, first_last_and_length) {
  auto range = [](const char* value, uint64_t size = 10) -> std::string {
    auto found = read_range(value, size);
    if (!found) return "ignored";
    return std::to_string(found->begin) + "+" + std::to_string(found->size);
  };
  EXPECT_EQ(range("bytes=0-0"), "0+1");
  EXPECT_EQ(range("bytes=2-5"), "2+4");
  EXPECT_EQ(range("bytes=2-"), "2+8");
  EXPECT_EQ(range("bytes=9-"), "9+1");
  EXPECT_EQ(range("bytes=8-99"), "8+2");
  EXPECT_EQ(range("bytes=0-18446744073709551615"), "0+10");
  EXPECT_EQ(range("bytes=-3"), "7+3");
  EXPECT_EQ(range("bytes=-99"), "0+10");
  for (const char* outside : {"bytes=10-", "bytes=10-12", "bytes=99999999999-"})
    EXPECT_EQ(range(outside), "0+0") << outside;
  EXPECT_EQ(read_range("bytes=-0", 10)->size, 0u);
  for (const char* other :
       {"", "bytes", "bytes=", "bytes=-", "bytes=5-2", "bytes=a-b", "lines=0-1", "bytes=0-1,3-4",
        "bytes= 0-1", "bytes=0--1", "bytes=0x1-2", "bytes=99999999999999999999-"})
    EXPECT_EQ(range(other), "ignored") << other;
}

TEST(Range, narrows_replies_of_files_only_for_whom_it_is_meant) {
  auto reply_to = [](const HttpQuestion& question) {
    HttpReply reply;
    reply.headers["ETag"] = "\"a\"";
    reply.file = FilePart{"f", 100, 10};
    finish_reply(question, reply);
    return reply;
  };
  HttpQuestion question{"GET", "/", {}, "", "bytes=2-5", ""};
  HttpReply part = reply_to(question);
  EXPECT_EQ(part.status, 206);
  EXPECT_EQ(part.headers["Content-Range"], "bytes 2-5/10");
  EXPECT_EQ(part.headers["ETag"], "\"a\"");
  EXPECT_EQ(part.file->begin, 102u);
  EXPECT_EQ(part.file->size, 4u);
  question.if_range = "\"a\"";
  EXPECT_EQ(reply_to(question).status, 206);
  for (const char* other : {"\"b\"", "W/\"a\"", "Mon, 23 Nov 2026 19:00:00 GMT"}) {
    question.if_range = other;
    HttpReply whole = reply_to(question);
    EXPECT_EQ(whole.status, 200) << other;
    EXPECT_EQ(whole.file->size, 10u);
    EXPECT_EQ(whole.headers["Accept-Ranges"], "bytes");
  }
  question.if_range = "";
  question.if_none_match = "\"a\"";
  EXPECT_EQ(reply_to(question).status, 304);
  EXPECT_FALSE(reply_to(question).file);
  question.if_none_match = "";
  question.range = "bytes=10-";
  HttpReply none = reply_to(question);
  EXPECT_EQ(none.status, 416);
  EXPECT_EQ(none.headers["Content-Range"], "bytes */10");
  EXPECT_FALSE(none.file);
  question.range = "bytes=2-5";
  question.method = "HEAD";
  EXPECT_EQ(reply_to(question).status, 200);
}

TEST(Reply, a_header_cannot_smuggle_a_line) {
  HttpReply reply;
  reply.headers = {
      {"X-Good", "v"}, {"X-Bad", "v\r\nSet-Cookie: a"}, {"X Bad", "v"}, {"X:Bad", "v"}};
  finish_reply({}, reply);
  EXPECT_EQ(reply.headers.count("X-Good"), 1u);
  EXPECT_EQ(reply.headers.size(), 2u);  // and Cache-Control
}

TEST(RateBound, allows_the_rate_and_a_burst_but_no_more) {
  RateBound bound{.rate = 10, .burst = 20, .last_time = 100};
  for (int i = 0; i < 20; i++) EXPECT_TRUE(bound.take(1, 100)) << i;
  EXPECT_FALSE(bound.take(1, 100));
  EXPECT_FALSE(bound.take(1, 100.05));
  EXPECT_TRUE(bound.take(1, 100.11));
  EXPECT_FALSE(bound.take(1, 100.11));
  int steady = 0;
  RateBound fair{.rate = 10, .burst = 20};
  for (int i = 0; i < 10'000; i++) steady += fair.take(1, 0.1 * i);
  EXPECT_EQ(steady, 10'000);
  int taken = 0;
  RateBound flood{.rate = 10, .burst = 20};
  for (int i = 0; i < 10'000; i++) taken += flood.take(1, 0.001 * i);
  EXPECT_NEAR(taken, 120, 2);
}

TEST(Workers, run_jobs_and_refuse_what_does_not_fit) {
  std::promise<void> gate;
  auto opened = gate.get_future().share();
  std::promise<void> started;
  std::atomic<int> ran{0}, dropped{0};
  Workers workers(1, 2);
  const auto count = [&](bool run) { (run ? ran : dropped)++; };
  ASSERT_TRUE(workers.post([&](bool run) {
    started.set_value();
    opened.wait();
    count(run);
  }));
  started.get_future().wait();
  EXPECT_TRUE(workers.post(count));
  EXPECT_TRUE(workers.post(count));
  EXPECT_FALSE(workers.post(count));
  std::thread stopper([&] { workers.stop(); });
  while (workers.post(count)) std::this_thread::yield();
  gate.set_value();
  stopper.join();
  EXPECT_GE(ran, 1);
  EXPECT_EQ(ran + dropped, 3);
  EXPECT_FALSE(workers.post(count));
}

TEST(Workers, live_on_after_a_job_throws) {
  Workers workers(1, 8);
  ASSERT_TRUE(workers.post([](bool) { throw std::runtime_error("meant to"); }));
  std::promise<bool> done;
  ASSERT_TRUE(workers.post([&](bool run) { done.set_value(run); }));
  EXPECT_TRUE(done.get_future().get());
}

}  // namespace
}  // namespace wellspring::test
