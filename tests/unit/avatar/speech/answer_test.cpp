// SPDX-License-Identifier: Apache-2.0
// What a broken voice program may answer.
#include "avatar/speech/answer.h"
#include "base/layers.h"

#include <gtest/gtest.h>

namespace wellspring::test {
namespace {

std::string refusal(const std::string& json) {
  const SpeechRequest request{.text = "The tower."};
  std::string error;
  EXPECT_EQ(read_speech_answer(request, json, std::vector<int16_t>(22050), error), nullptr) << json;
  return error;
}

std::string answer(const std::string& rate, const std::string& word, const std::string& phoneme) {
  return R"({"rate": )" + rate + R"(, "words": [)" + word + R"(], "phonemes": [)" + phoneme + "]}";
}

TEST(SpeechAnswer, ARefusalAlwaysSaysWhy) {
  EXPECT_EQ(refusal(R"({"error": "no such language"})"), "no such language");
  EXPECT_NE(refusal(R"({"error": ""})"), "");
  EXPECT_NE(refusal("[]"), "");
}

TEST(SpeechAnswer, NumbersThatNoIntegerHoldsAreRefused) {
  const std::string word = "[0, 0, 3]", phoneme = R"([0, 0, "t", "t"])";
  const SpeechRequest request{.text = "The tower."};
  std::string error;
  ASSERT_NE(read_speech_answer(request, answer("22050", word, phoneme), std::vector<int16_t>(22050),
                               error),
            nullptr)
      << error;
  for (const char* number : {"1e300", "-1e300", "4294967296"}) {
    const std::string large = number;
    for (const std::string& json :
         {answer(large, word, phoneme), answer("22050", "[0, " + large + ", 3]", phoneme),
          answer("22050", "[0, 0, " + large + "]", phoneme),
          answer("22050", word, "[0, " + large + R"(, "t", "t"])")})
      EXPECT_NE(refusal(json).find("too large"), std::string::npos) << json;
  }
}

}  // namespace
}  // namespace wellspring::test
