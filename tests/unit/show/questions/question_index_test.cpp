// SPDX-License-Identifier: Apache-2.0
#include "show/questions/question_index.h"

#include <gtest/gtest.h>

#include "show/exhibit/load/exhibit_load.h"
#include "unit/show/tiny_exhibit.h"

namespace wellspring::test {
namespace {

// Questions that nobody wrote down for the castle, in words of their own, and words of the answer.
struct Asked {
  const char *lang, *question, *answer;
};
const Asked asked_of_the_castle[] = {
    {"en", "Who wore the crown?", "queen"},
    {"en", "What is a bell made of?", "bronze"},
    {"en", "How were wells dug?", "dug"},
    {"en", "When did the baker light his oven?", "oven"},
    {"en", "Where was the ammonite found?", "ammonite"},
    {"en", "how deep is that well", "eventy metres"},
    {"de", "Wer trug die Krone?", "Königin"},
    {"de", "Woraus ist eine Glocke?", "Bronze"},
    {"de", "Wann wurde das Tor geöffnet?", "Tor"},
    {"de", "Wie tief ist der Brunnen hier?", "iebzig Meter"},
    {"sk", "Kto nosil korunu?", "kráľovn"},
    {"sk", "Z čoho je zvon?", "bronz"},
    {"sk", "Aká hlboká je tá studňa?", "edemdesiat metrov"},
};

TEST(QuestionIndex, FindsTheCastlesAnswers) {
  const Exhibit castle = load_exhibit(std::string(WELLSPRING_SOURCE) + "/content/castle");
  const QuestionIndex index = make_question_index(castle);
  int right = 0, count = 0;
  for (const Asked& one : asked_of_the_castle) {
    const FoundAnswer found = find_answer(index, castle, one.question, one.lang);
    std::string said;
    const LocalScript script = words_for(index, found);
    for (const StoryLine& line : script.at(one.lang)) said += line.text + " ";
    const bool is_right = said.find(one.answer) != std::string::npos;
    printf("%s (%.2f, %.2f) %s\n", one.question, found.score, found.share, said.c_str());
    right += is_right, count++;
  }
  EXPECT_GE(right, count - 2) << "two in Slovak begin a story that knows it";
  for (const auto& [lang, question] : {std::pair("en", "Who won the world cup in football?"),
                                       {"en", "What is the weather tomorrow?"},
                                       {"en", "what is it about?"},
                                       {"de", "Welche Partei soll ich wählen?"},
                                       {"sk", "Kedy odchádza vlak do Bratislavy?"},
                                       {"en", ""},
                                       {"en", "\xff\xff"}})
    EXPECT_NE(find_answer(index, castle, question, lang).kind, FoundAnswer::Kind::sure) << question;
}

struct TinyQuestions : testing::Test {
  Exhibit exhibit = make_tiny_exhibit();
  QuestionIndex index;
  void SetUp() override {
    exhibit.questions = {{{{{"en", "May I take photographs?"}}, {{"en", "Are cameras allowed?"}}},
                          {{"en", "Yes, without a flash."}}}};
    PointOfInterest& jug = exhibit.points.emplace_back();
    jug.id = "jug";
    jug.title = {{"en", "The painted jug"}};
    jug.text = {{"en", "A potter called Hana made it for her daughter's wedding."}};
    jug.provenance = {{"date", {{"en", "about 1612"}}}};
    index = make_question_index(exhibit);
  }
  FoundAnswer ask(const std::string& question) {
    return find_answer(index, exhibit, question, "en");
  }
};

TEST_F(TinyQuestions, SaysWhyAndHowSure) {
  const FoundAnswer found = ask("Which potter made the JUG?");
  EXPECT_EQ(found.kind, FoundAnswer::Kind::sure);
  EXPECT_EQ(index.passages[size_t(found.passage)].id, "jug");
  EXPECT_EQ(found.words, (std::vector<std::string>{"JUG", "potter"}));
  EXPECT_NEAR(found.share, 1, 1e-5f);
  EXPECT_EQ(words_for(index, found).at("en").size(), 1u);
}

TEST_F(TinyQuestions, AnotherWayToAskFindsTheCuratorsAnswer) {
  const FoundAnswer found = ask("Is a camera allowed here?");
  ASSERT_GE(found.passage, 0);
  EXPECT_EQ(index.passages[size_t(found.passage)].kind, Passage::Kind::answer);
  EXPECT_EQ(words_for(index, found).at("en").front().text, "Yes, without a flash.");
  EXPECT_EQ(index.passages[size_t(ask("What is from 1612?").passage)].id, "jug");
}

TEST_F(TinyQuestions, WhereOnlySomeIsKnownItIsSaidWithCaution) {
  const FoundAnswer found = ask("Is the jug waterproof?");
  EXPECT_EQ(found.kind, FoundAnswer::Kind::partly);
  const auto said = words_for(index, found).at("en");
  ASSERT_EQ(said.size(), 2u);
  EXPECT_NE(said[0].text.find("not sure"), std::string::npos);
}

TEST_F(TinyQuestions, WhatIsNotThereIsNotInvented) {
  for (const char* question :
       {"Who painted the Sistine Chapel's ceiling?", "", "?!", "what is the"}) {
    const FoundAnswer found = ask(question);
    if (found.kind == FoundAnswer::Kind::none) {
      EXPECT_EQ(found.passage, -1);
      EXPECT_NE(words_for(index, found).at("de").front().text.find("leider"), std::string::npos);
    } else {
      EXPECT_EQ(found.kind, FoundAnswer::Kind::partly) << question;
    }
  }
  const QuestionIndex nothing = make_question_index({});
  EXPECT_EQ(find_answer(nothing, exhibit, "jug", "en").kind, FoundAnswer::Kind::none);
}

}  // namespace
}  // namespace wellspring::test
