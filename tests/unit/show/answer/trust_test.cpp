// SPDX-License-Identifier: Apache-2.0
// Who is believed to be a kiosk's page.
#include "show/answer/cameras.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "unit/show/show_stage.h"

namespace wellspring::test {
namespace {

const std::string any = "a token for any kiosk", hall = "the token of the hall";

struct Trust : testing::Test, ShowStage {
  void SetUp() override {
    ShowSettings settings = settings_for("direct");
    settings.kiosk_tokens = {{"", any}, {"hall", hall}};
    begin(make_tiny_exhibit(), settings);
  }
  // A page's claim to be a kiosk's; its number.
  size_t claim(const std::string& token, const std::string& kiosk, bool local = false) {
    const size_t page = connect();
    browsers[page].link->local = local;
    nlohmann::json hello = {{"type", "hello"}, {"role", "kiosk"}, {"width", 32}, {"height", 32}};
    if (!token.empty()) hello["token"] = token;
    if (!kiosk.empty()) hello["kiosk"] = kiosk;
    say(hello.dump(), page);
    step();
    return page;
  }
  // The last visitor's: "kiosk NAME", or what it was told instead.
  std::string outcome(const std::string& token, const std::string& kiosk, bool local = false) {
    const size_t page = claim(token, kiosk, local);
    const Visitor& visitor = show->visits.visitors.back();
    if (visitor.welcomed) return (visitor.kiosk ? "kiosk " : "visitor ") + visitor.name;
    return last("error", page).value("code", "");
  }
};

TEST_F(Trust, AKioskOnAnotherMachineHasAToken) {
  EXPECT_EQ(outcome("", ""), "not_trusted");
  EXPECT_EQ(outcome("", "hall"), "not_trusted");
  EXPECT_EQ(outcome(any + "x", "hall"), "not_trusted");
  EXPECT_EQ(outcome("", "hall", true), "kiosk hall");
  EXPECT_EQ(outcome(any + "x", "yard", true), "kiosk yard") << "from here nobody needs one";
  EXPECT_EQ(outcome(any, ""), "kiosk ");
  EXPECT_EQ(outcome(any, "yard"), "kiosk yard");
  EXPECT_EQ(outcome(hall, "hall"), "kiosk hall");
  EXPECT_EQ(outcome(hall, ""), "kiosk hall") << "it need not be named";
  EXPECT_EQ(outcome(hall, "yard"), "not_trusted");
  EXPECT_EQ(outcome(hall, "yard", true), "not_trusted");
}

TEST_F(Trust, WhoIsNotBelievedChangesNothing) {
  for (int i = 0; i < 3; i++) claim("", "invented " + std::to_string(i));
  EXPECT_TRUE(show->kiosks.all.empty());
  say(nlohmann::json{{"type", "kiosk"}, {"showing", "book"}, {"touched", true}}.dump(), 0);
  step();
  EXPECT_EQ(last("error", 0)["code"], "hello_first");
  EXPECT_TRUE(show->kiosks.all.empty());
  // The same page, once it has its token.
  say(nlohmann::json{{"type", "hello"}, {"role", "kiosk"}, {"token", hall}}.dump(), 0);
  step();
  ASSERT_EQ(show->kiosks.all.size(), 1u);
  EXPECT_EQ(show->kiosks.all[0].settings.name, "hall");
}

TEST_F(Trust, VisitorsNeedNone) {
  const size_t visitor = connect();
  browsers[visitor].link->local = false;
  say(R"({"type":"hello","width":32,"height":32})", visitor);
  step();
  EXPECT_TRUE(show->visits.visitors.back().welcomed);
}

}  // namespace
}  // namespace wellspring::test
