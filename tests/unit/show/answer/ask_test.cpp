// SPDX-License-Identifier: Apache-2.0
// A visitor's question, and what the storyteller says to it.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "unit/show/show_stage.h"

namespace wellspring::test {
namespace {

struct Asking : testing::Test, ShowStage {
  void begin(bool storyteller) {
    Exhibit exhibit = make_tiny_exhibit();
    if (storyteller) add_storyteller(exhibit, "anna", {-2, 0, 1});
    exhibit.questions = {{{{{"en", "May I take photographs?"}, {"de", "Darf ich fotografieren?"}}},
                          {{"en", "Yes, without a flash."}, {"de", "Ja, ohne Blitz."}}}};
    tick_seconds = 0.1;
    ShowStage::begin(std::move(exhibit), settings_for("direct", 10));
    join(32, 32, "de");
    join(32, 32);
    run(0.3);
  }
};

TEST_F(Asking, SheSaysTheAnswerToWhoAsked) {
  begin(true);
  EXPECT_EQ(last("welcome", 0)["questions"][0], "Darf ich fotografieren?");
  order(R"({"type":"ask","text":"Kann man hier fotografieren?"})", 0);
  run(1);
  const auto reply = last("reply", 0);
  EXPECT_EQ(reply["text"], "Ja, ohne Blitz.");
  EXPECT_EQ(reply["found"], "sure");
  EXPECT_EQ(reply["from"]["kind"], "answer");
  EXPECT_EQ(reply["words"][0], "fotografieren");
  EXPECT_EQ(last("subtitle", 0)["text"], "Ja, ohne Blitz.");
  EXPECT_TRUE(told("subtitle", 1).empty()) << "it is not the other's question";
  EXPECT_TRUE(told("reply", 1).empty());
}

TEST_F(Asking, WhatSheDoesNotKnowSheSaysKindlyAndAStoryIsBrokenOff) {
  begin(true);
  order(R"({"type":"storyteller","story":"tale"})", 1);
  run(1);
  order(R"({"type":"ask","text":"Who won the football?"})", 1);
  run(1);
  EXPECT_EQ(last("reply", 1)["found"], "none");
  EXPECT_EQ(last("subtitle", 1)["text"].get<std::string>().rfind("That I do not know", 0), 0u);
  EXPECT_EQ(last("agent", 1)["story"], nullptr);
}

TEST_F(Asking, WithoutAStorytellerTheAnswerIsThere) {
  begin(false);
  order(R"({"type":"ask","text":"Photographs?"})", 1);
  EXPECT_EQ(last("reply", 1)["text"], "Yes, without a flash.");
  EXPECT_TRUE(told("error", 1).empty());
}

}  // namespace
}  // namespace wellspring::test
