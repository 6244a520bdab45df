// SPDX-License-Identifier: Apache-2.0
#include "show/exhibit/exhibit_questions.h"

namespace wellspring::show {

void read_questions(Exhibit& exhibit, Fields& root) {
  root.objects("questions", false, [&](Fields fields) {
    AnsweredQuestion one;
    one.question = fields.local_texts("question", true);
    one.answer = fields.local_text("answer", true);
    fields.finish();
    if (!one.question.empty() && !one.answer.empty()) exhibit.questions.push_back(std::move(one));
  });
  if (exhibit.questions.size() > most_questions)
    root.problem("questions", "are more than " + std::to_string(most_questions));
}

}  // namespace wellspring::show
