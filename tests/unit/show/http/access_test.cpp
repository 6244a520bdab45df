// SPDX-License-Identifier: Apache-2.0
// Who may read how the server is, who may speak for the house, and whose camera is let in.
#include "show/http/access.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "show/http/answer.h"

namespace wellspring::test {
namespace {

using nlohmann::json;

const std::string admin = "the token of the house", kiosk = "the token of a kiosk";

HttpQuestion ask(const std::string& path, const std::string& token = "", bool local = false) {
  HttpQuestion question{.method = "GET", .path = path};
  if (!token.empty()) question.authorization = "Bearer " + token;
  question.local = local;
  return question;
}

struct Sources : testing::Test {
  AnswerSources sources;
  std::map<std::string, PageFile> pages;
  void SetUp() override {
    sources.pages = &pages;
    sources.failed = {{"ruin", {"/srv/museum/ruin/exhibit.json: is wrong"}}};
    sources.status = sources.speeds = [] { return "{}"; };
    sources.sums = [](const HttpQuestion&) { return HttpReply{}; };
  }
  int status(const HttpQuestion& question) const { return answer(sources, question).status; }
  json problems(const HttpQuestion& question) const {
    return json::parse(answer(sources, question).body)["failed"][0]["problems"];
  }
};

TEST_F(Sources, HowTheServerIsIsToldHereOrWithTheToken) {
  const char* guarded[] = {"/metrics", "/api/v1/status", "/api/v1/speeds", "/api/v1/sums.csv"};
  for (const char* path : guarded) {
    EXPECT_EQ(status(ask(path)), 401) << path;
    EXPECT_EQ(status(ask(path, "", true)), 200) << path;
    const HttpReply none = answer(sources, ask(path, admin));
    EXPECT_EQ(none.status, 401) << path << ": there is no token";
    EXPECT_EQ(json::parse(none.body)["error"]["code"], "no_admin_token");
    EXPECT_NE(none.body.find("WELLSPRING_ADMIN_TOKEN"), std::string::npos);
    EXPECT_EQ(none.headers.at("WWW-Authenticate"), "Bearer");
  }
  sources.access.admin_token = admin;
  for (const char* path : guarded) {
    EXPECT_EQ(status(ask(path, admin)), 200) << path;
    EXPECT_EQ(status(ask(path, "", true)), 200) << path;
    const HttpReply wrong = answer(sources, ask(path, admin + "x"));
    EXPECT_EQ(wrong.status, 401) << path;
    EXPECT_EQ(json::parse(wrong.body)["error"]["code"], "wrong_token");
  }
  sources.access.open_status = true;
  for (const char* path : guarded) EXPECT_EQ(status(ask(path)), 200) << path;
  EXPECT_EQ(status(ask("/api/v1/admin/announce")), 405);
}

TEST_F(Sources, EverybodyMayKnowThatItServesAndWhat) {
  EXPECT_EQ(answer(sources, ask("/healthz")).body, R"({"status":"ok"})");
  EXPECT_EQ(status(ask("/api/v1/exhibits")), 200);
  EXPECT_EQ(problems(ask("/api/v1/exhibits")), json::array()) << "they name files";
  EXPECT_EQ(problems(ask("/api/v1/exhibits", "", true)).size(), 1u);
}

TEST(Access, OnlyTheTokenSpeaksForTheHouse) {
  AccessRules rules{.admin_token = admin, .kiosk_tokens = {{"", kiosk}}, .open_status = true};
  EXPECT_FALSE(access_of(rules, ask("/", "", true)).admin);
  EXPECT_FALSE(access_of(rules, ask("/", kiosk)).admin);
  EXPECT_TRUE(access_of(rules, ask("/", admin)).admin);
  rules.open_status = false;
  EXPECT_FALSE(access_of(rules, ask("/", kiosk)).status);
}

TEST(Access, ACameraComesFromHereOrWithAToken) {
  AccessRules rules{.admin_token = admin, .kiosk_tokens = {}};
  const std::string eye = "/api/v1/eye";
  for (bool has_tokens : {false, true}) {
    if (has_tokens) rules.kiosk_tokens = {{"", kiosk}, {"hall", kiosk + " hall"}};
    ASSERT_TRUE(admit(rules, ask(eye)).refusal);
    EXPECT_EQ(admit(rules, ask(eye)).refusal->status, 401);
    EXPECT_TRUE(admit(rules, ask(eye, admin)).refusal) << "the house's token is no kiosk's";
    EXPECT_FALSE(admit(rules, ask(eye, "", true)).refusal);
    EXPECT_EQ(!admit(rules, ask(eye, kiosk)).refusal, has_tokens);
    EXPECT_FALSE(admit(rules, ask("/api/v1/visit")).refusal) << "visitors are let in";
  }
  EXPECT_EQ(admit(rules, ask(eye, kiosk)).kiosk, "");
  EXPECT_EQ(admit(rules, ask(eye, kiosk + " hall")).kiosk, "hall");
  EXPECT_TRUE(admit(rules, ask(eye, kiosk + " yard")).refusal);
}

}  // namespace
}  // namespace wellspring::test
