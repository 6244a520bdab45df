// SPDX-License-Identifier: Apache-2.0
// The one path that takes a body.
#include "fixture.h"

namespace wellspring::test {
namespace {

constexpr const char* path = "/api/v1/admin/announce";
const std::string as_json = "Content-Type: application/json\r\n";

HttpReply repeat(const HttpQuestion& question) {
  return HttpReply{.body = question.method + "|" + question.authorization + "|" + question.body};
}

struct Post : testing::Test {
  House house{quick_settings(), repeat};
  RawClient::Reply post(const std::string& headers, const std::string& body,
                        const std::string& method = "POST", const std::string& target = path) {
    RawClient client(house.port());
    client.send(method + " " + target + " HTTP/1.1\r\nHost: localhost\r\n" + headers +
                "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body);
    return client.reply();
  }
};

TEST_F(Post, body_and_authorization_are_handed_on) {
  const auto reply = post(as_json + "Authorization: Bearer abc\r\n", "{\"a\": 1}");
  EXPECT_EQ(reply.status, 200);
  EXPECT_EQ(reply.body, "POST|Bearer abc|{\"a\": 1}");
  EXPECT_EQ(post("Content-Type: Application/JSON ; charset=utf-8\r\n", "x").body, "POST||x");
  EXPECT_EQ(post(as_json, "x", "POST", std::string(path) + "?a=b").body, "POST||x");
  RawClient chunks(house.port());
  chunks.send("POST " + std::string(path) + " HTTP/1.1\r\nHost: localhost\r\n" + as_json +
              "Transfer-Encoding: chunked\r\n\r\n2\r\nab\r\n1\r\nc\r\n0\r\n\r\n");
  EXPECT_EQ(chunks.reply().body, "POST||abc");
  EXPECT_EQ(chunks.ask("/a").body, "GET||") << "the connection may be used again";
}

TEST_F(Post, everything_else_is_told_what_is_allowed) {
  for (const char* method : {"GET", "HEAD", "PUT", "DELETE", "OPTIONS", "PATCH"}) {
    const auto reply = post(as_json, "", method);
    EXPECT_EQ(reply.status, 405) << method;
    EXPECT_EQ(reply.header("Allow"), "POST") << method;
  }
  for (const char* target : {"/", "/api/v1/admin", "/api/v1/admin/announce/", "/api/v1/visit",
                             "/api/v1/admin/announcements", "/x?/api/v1/admin/announce"}) {
    const auto reply = post(as_json, "", "POST", target);
    EXPECT_EQ(reply.status, 405) << target;
    EXPECT_EQ(reply.header("Allow"), "GET, HEAD") << target;
  }
}

TEST_F(Post, bodies_are_json_of_at_most_16_kib) {
  EXPECT_EQ(post("", "{}").status, 415);
  for (const char* type : {"text/plain", "application/x-www-form-urlencoded", "application/jsonp"})
    EXPECT_EQ(post(std::string("Content-Type: ") + type + "\r\n", "{}").status, 415) << type;
  EXPECT_EQ(post(as_json, std::string(16384, 'x')).status, 200);
  EXPECT_EQ(post(as_json, std::string(16385, 'x')).status, 413);
  RawClient chunks(house.port());
  chunks.send("POST " + std::string(path) + " HTTP/1.1\r\nHost: localhost\r\n" + as_json +
              "Transfer-Encoding: chunked\r\n\r\n4001\r\n" + std::string(0x4001, 'x') +
              "\r\n0\r\n\r\n");
  EXPECT_EQ(chunks.reply().status, 413);
}

TEST_F(Post, pages_of_others_may_not) {
  EXPECT_EQ(post(as_json + "Origin: http://evil.example\r\n", "{}").status, 403);
  EXPECT_EQ(post(as_json + "Origin: null\r\n", "{}").status, 403);
  EXPECT_EQ(post(as_json + "Origin: http://localhost\r\n", "{}").status, 200);
  EXPECT_EQ(post(as_json + "Origin: http://localhost\r\nOrigin: http://localhost\r\n", "{}").status,
            403);
}

TEST_F(Post, an_upgrade_that_is_posted_opens_nothing) {
  const auto reply = post(as_json +
                              "Connection: Upgrade\r\nUpgrade: websocket\r\n"
                              "Sec-WebSocket-Version: 13\r\n"
                              "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n",
                          "");
  EXPECT_EQ(reply.status, 200);
  EXPECT_EQ(house.server.counters().websockets, 0u);
}

}  // namespace
}  // namespace wellspring::test
