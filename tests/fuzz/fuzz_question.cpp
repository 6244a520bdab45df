// SPDX-License-Identifier: Apache-2.0
// A visitor's question in words.
#include "fuzz/fuzz.h"
#include "show/questions/question_index.h"
#include "unit/show/tiny_exhibit.h"

namespace wellspring::fuzz {

void fuzz_question(Bytes bytes) {
  static const Exhibit exhibit = make_tiny_exhibit();
  static const QuestionIndex index = make_question_index(exhibit);
  for (const char* lang : {"en", "de", "sk", "xx"})
    words_for(index, find_answer(index, exhibit, text_of(bytes), lang));
}

}  // namespace wellspring::fuzz
