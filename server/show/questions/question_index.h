// SPDX-License-Identifier: Apache-2.0
// Finds the words of an exhibit that answer a question. Ranking is BM25 (Robertson, Zaragoza: The
// Probabilistic Relevance Framework, 2009, section 3.4) over passages; how sure it is says the
// share of the question's words, each by its weight, that the passage has.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "show/exhibit/exhibit.h"

namespace wellspring::show {

// Words of a text in a form in which those that mean the same are mostly equal, in languages with
// Latin letters: small letters without marks, without a plural's end, cut after six letters
// (truncation, which does about as well as stemmers by rules: Dolamic, Savoy 2009), without a last
// vowel.

struct Word {
  std::string stem;    // for comparison
  std::string spoken;  // as it was written
};

// In order. Words that questions share, whatever they ask for ("what", "is", "the"), are left out,
// by the language's list: of en, de, sk, fr and es; others have none.
std::vector<Word> words_of(const std::string& text, const std::string& lang);
std::string_view stop_words_json();  // show/questions/stop_words.json

// Something that can be said in answer.
struct Passage {
  enum class Kind : uint8_t { answer, object, story, tour, topic };
  Kind kind = Kind::answer;
  std::string id;     // id of the object, story, tour or topic; empty: an answer
  LocalText title;    // title of that; the question of an answer
  LocalScript said;   // a few sentences
  LocalText further;  // words to find it by that are not said
};
inline constexpr const char* passage_kinds[] = {"answer", "object", "story", "tour", "topic"};

struct QuestionIndex {
  std::vector<Passage> passages;
  struct Entry {
    std::map<std::string, float> counts;  // stem -> how often, weighted
    float length = 0;
  };
  struct Language {
    std::vector<Entry> entries;            // one for each passage; empty: it has no words in it
    std::map<std::string, int> documents;  // stem -> passages that have it
    float mean_length = 1;
  };
  std::map<std::string, Language> languages;
};

struct FoundAnswer {
  enum class Kind : uint8_t { none, partly, sure } kind = Kind::none;
  int passage = -1;                // index; -1 for none
  float score = 0;                 // BM25
  float share = 0;                 // share of the question's words that the passage has, 0 to 1
  std::vector<std::string> words;  // these, as they were asked
};

QuestionIndex make_question_index(const Exhibit& exhibit);
// In `lang`, else in its base language, else in the exhibit's first.
FoundAnswer find_answer(const QuestionIndex& index, const Exhibit& exhibit,
                        const std::string& question, const std::string& lang);
// Returns the words of an answer: the passage, after a word of caution if it is not sure, or kind
// words if there is none.
LocalScript words_for(const QuestionIndex& index, const FoundAnswer& found);

}  // namespace wellspring::show
