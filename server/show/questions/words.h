// SPDX-License-Identifier: Apache-2.0
// Words of a text in a form in which those that mean the same are mostly equal, in languages with
// Latin letters: small letters without marks, without a plural's end, cut after six letters
// (truncation, which does about as well as stemmers by rules: Dolamic, Savoy 2009), without a last
// vowel.
#pragma once
#include <string>
#include <vector>

namespace wellspring::show {

struct Word {
  std::string stem;    // for comparison
  std::string spoken;  // as it was written
};

// In order. Words that questions share, whatever they ask for ("what", "is", "the"), are left out,
// by the language's list: of en, de, sk, fr and es; others have none.
std::vector<Word> words_of(const std::string& text, const std::string& lang);

}  // namespace wellspring::show
