// SPDX-License-Identifier: Apache-2.0
// What is asked for over HTTP.
#include <nlohmann/json.hpp>

#include "fuzz/fuzz.h"
#include "show/http/answer.h"
#include "show/status/status.h"
#include "stream/target.h"
#include "unit/show/tiny_exhibit.h"

namespace wellspring::fuzz {
namespace {

struct House {
  Exhibit tiny = make_tiny_exhibit(), other = make_tiny_exhibit();
  ReportBoard board;
  std::map<std::string, PageFile> pages;
  AnswerSources sources;
  House() {
    tiny.files["hall.jpg"] = {"hall.jpg", "image/jpeg", 1000, 0, "\"1\""};
    other.id = "other";
    for (const char* page : {"/", "/front.html", "/missing.html", "/opening.html", exhibit_page})
      pages[page] = {"text/html", page, make_etag(page)};
    sources.exhibits = {{&tiny, &board, nullptr, nullptr, "https://museum.example"},
                        {&other, &board, nullptr, nullptr}};
    sources.failed = {{"broken", {"exhibit.json: line 1"}}};
    sources.pages = &pages;
    sources.sums = [](const HttpQuestion& question) {
      return answer_sums(
          [](int64_t from, int64_t to) {
            return Sums{{{from, "visits", "tiny"}, 1}, {{to, "visits", "tiny"}, 1}};
          },
          question);
    };
  }
};

void check(const HttpReply& reply) {
  require(reply.status >= 200 && reply.status < 600, "a reply has a status");
  const bool later = reply.content_type == "image/jpeg";  // made by who draws stills
  require(later || reply.file || !reply.body.empty(), "a reply says something");
  if (reply.content_type.starts_with("application/json"))
    require(nlohmann::json::accept(reply.body), "JSON is JSON");
}

}  // namespace

// The target, and the header Accept.
void fuzz_http_answer(Bytes bytes) {
  static const House house;
  HttpQuestion question;
  question.method = "GET";
  question.local = true;
  if (read_target(text_of(take_until(bytes, '\n')), question) != 200) return;
  question.accept = text_of(bytes);
  check(answer(house.sources, question));
  check(answer_while_loading(house.pages, question));
}

}  // namespace wellspring::fuzz
