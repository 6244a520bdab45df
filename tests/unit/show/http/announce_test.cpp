// SPDX-License-Identifier: Apache-2.0
// Who may announce what.
#include "show/http/access.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <vector>

namespace wellspring::test {
namespace {

using nlohmann::json;

const std::string token = "a token of many letters";

struct Announce : testing::Test {
  std::vector<Announcement> put;
  AccessRules rules{.admin_token = token, .kiosk_tokens = {}};
  AnnouncementDesk desk{[this](Announcement one) {
    put.push_back(std::move(one));
    return uint32_t(put.size());
  }};
  HttpReply post(const std::string& body, const std::string& authorization = "Bearer " + token) {
    HttpQuestion question{.method = "POST",
                          .path = "/api/v1/admin/announce",
                          .authorization = authorization,
                          .body = body};
    return answer_announce(desk, access_of(rules, question), question);
  }
};

TEST_F(Announce, HandsOverWhatIsSaid) {
  HttpReply reply = post(R"({"text": {"en": "Hello.", "sk": "Ahoj.", "de": ""}, "seconds": 90,
      "urgent": true})");
  EXPECT_EQ(reply.status, 200) << reply.body;
  EXPECT_EQ(json::parse(reply.body), json({{"id", 1}}));
  ASSERT_EQ(put.size(), 1u);
  EXPECT_EQ(put[0].text, (LocalText{{"en", "Hello."}, {"sk", "Ahoj."}}));
  EXPECT_EQ(put[0].seconds, 90);
  EXPECT_TRUE(put[0].urgent);
  EXPECT_EQ(post(R"({"text": "We close soon."})").status, 200);
  EXPECT_EQ(put[1].text, (LocalText{{"en", "We close soon."}}));
  EXPECT_EQ(put[1].seconds, 60);
  EXPECT_FALSE(put[1].urgent);
  for (const char* empty : {R"({"text": ""})", R"({"text": {}})", R"({"text": {"sk": ""}})"}) {
    EXPECT_EQ(post(empty).status, 200) << empty;
    EXPECT_TRUE(put.back().text.empty()) << empty;
  }
}

TEST_F(Announce, NamesTheFieldThatIsWrong) {
  const std::pair<std::string, const char*> wrong[] = {
      {"{}", "text"},
      {R"({"text": 3})", "text"},
      {R"({"text": null})", "text"},
      {R"({"text": {"en": 3}})", "text/en"},
      {R"({"text": {"!": "a"}})", "text/!"},
      {R"({"text": "a", "seconds": 0})", "seconds"},
      {R"({"text": "a", "seconds": 86401})", "seconds"},
      {R"({"text": "a", "seconds": "60"})", "seconds"},
      {R"({"text": "a", "seconds": 1e999})", "seconds"},
      {R"({"text": "a", "urgent": 1})", "urgent"},
      {R"({"text": "a", "loud": true})", "loud"},
      {R"({"text": ")" + std::string(2001, 'a') + "\"}", "text"},
      {R"(["text"])", "object"},
      {R"({"text": "a)", "JSON"},
      {"", "JSON"},
      {std::string(5000, '['), "deeper"},
      {"{\"text\": \"\xff\"}", "JSON"},
  };
  for (const auto& [body, names] : wrong) {
    const HttpReply reply = post(body);
    EXPECT_EQ(reply.status, 400) << body;
    const std::string message = json::parse(reply.body)["error"]["message"];
    EXPECT_NE(message.find(names), std::string::npos) << body << "\n" << message;
  }
  EXPECT_TRUE(put.empty());
  EXPECT_EQ(post(R"({"text": ")" + std::string(2000, 'a') + "\", \"seconds\": 86400}").status, 200);
}

TEST_F(Announce, NeedsTheToken) {
  for (const std::string& wrong : std::vector<std::string>{
           std::string(), token, "Bearer", std::string("Bearer "), "Bearer " + token + " ",
           "Bearer " + token.substr(1), "Bearer x" + token.substr(1), "Bearer " + token + token,
           "Basic " + token, std::string("Bearer ") + std::string(token.size(), '\0')}) {
    const HttpReply reply = post(R"({"text": "a"})", wrong);
    EXPECT_EQ(reply.status, 401) << wrong;
    EXPECT_EQ(reply.headers.at("WWW-Authenticate"), "Bearer");
    EXPECT_EQ(reply.body.find(token), std::string::npos);
  }
  EXPECT_TRUE(put.empty());
  EXPECT_EQ(post(R"({"text": "a"})", "bearer " + token).status, 200) << "a scheme has no case";
}

TEST_F(Announce, WithoutATokenNobodyMay) {
  rules.admin_token.clear();
  for (const char* authorization : {"", "Bearer ", "Bearer a token of many letters"}) {
    const HttpReply reply = post(R"({"text": "a"})", authorization);
    EXPECT_EQ(reply.status, 403);
    EXPECT_NE(reply.body.find("WELLSPRING_ADMIN_TOKEN"), std::string::npos);
  }
  EXPECT_TRUE(put.empty());
}

TEST_F(Announce, IsPosted) {
  HttpQuestion question{.method = "GET"};
  const HttpReply reply = answer_announce(desk, access_of(rules, question), question);
  EXPECT_EQ(reply.status, 405);
  EXPECT_EQ(reply.headers.at("Allow"), "POST");
}

}  // namespace
}  // namespace wellspring::test
