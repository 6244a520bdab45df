// SPDX-License-Identifier: Apache-2.0
#include "base/layers.h"
#include "show/questions/question_index.h"

#include <gtest/gtest.h>

namespace wellspring::test {
namespace {

std::string stems(const std::string& text, const std::string& lang) {
  std::string all;
  for (const Word& word : words_of(text, lang)) all += (all.empty() ? "" : " ") + word.stem;
  return all;
}

TEST(Words, AreComparedByTheirBeginningsWithoutMarks) {
  EXPECT_EQ(stems("Who wore the CROWN, and the crowns?", "en"), "wore crown crown");
  EXPECT_EQ(stems("Wie groß sind die Brunnen von Straßburg?", "de"), "gross brunn strass");
  EXPECT_EQ(stems("Aká hlboká je studňa?", "sk"), stems("hlboká studna", "sk"));
  EXPECT_EQ(stems("studni", "sk"), stems("studňa", "sk"));
  EXPECT_EQ(stems("nosila", "sk"), stems("nosil", "sk"));
  EXPECT_EQ(stems("L'œuvre d'Ève", "fr"), "oeuvr eve");
  EXPECT_EQ(stems("¿Cuándo murió la reina?", "es"), "muri rein");
  EXPECT_EQ(stems("the 12 bells", "xx"), "the 12 bell") << "a language without a list";
  EXPECT_EQ(stems("the bells", "en-GB"), "bell");
}

TEST(Words, AreKeptAsTheyWereWritten) {
  const auto words = words_of("Große Glocke!", "de");
  ASSERT_EQ(words.size(), 2u);
  EXPECT_EQ(words[0].spoken, "Große");
}

TEST(Words, AnyBytesAreRead) {
  for (const char* text :
       {"", "\xff\xfe", "\xc3", "\xe2\x82", "\xf0\x9f\x98\x80", "\x80\x80", "   "})
    EXPECT_TRUE(words_of(text, "en").empty()) << text;
  EXPECT_EQ(words_of(std::string(100000, 'a'), "en").size(), 1u);
}

}  // namespace
}  // namespace wellspring::test
