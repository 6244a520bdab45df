// SPDX-License-Identifier: Apache-2.0
// Words of the house, posted.
#include "fuzz/fuzz.h"
#include "show/http/access.h"

namespace wellspring::fuzz {

void fuzz_announcement(Bytes bytes) {
  HttpQuestion question;
  question.method = "POST";
  question.authorization = "Bearer a token of many letters";
  question.body = text_of(bytes);
  bool put = false;
  const AnnouncementDesk desk{[&](Announcement) {
    put = true;
    return 1u;
  }};
  AccessRules rules;
  rules.admin_token = "a token of many letters";
  require((answer_announce(desk, access_of(rules, question), question).status == 200) == put,
          "what is announced is handed over");
}

}  // namespace wellspring::fuzz
