// SPDX-License-Identifier: Apache-2.0
// Who may do what, decided once for each question: what the house's technician reads, what whoever
// looks after the house does, and what claims to be a kiosk.
#pragma once
#include <string>
#include <vector>

#include "base/layers.h"
#include "wire/http.h"
#include "wire/tokens.h"

namespace wellspring::show {

struct AccessRules {
  std::string admin_token;          // empty: there is none
  std::vector<Token> kiosk_tokens;  // empty: there are none
  bool open_status = false;         // everybody may read how the server is
};

struct Access {
  bool status = false;  // may read how the server is, and its sums: from the machine that serves,
                        // with the admin token, or where that is open to everybody
  bool admin = false;   // may speak for the house: with the admin token alone
  bool has_token = false;  // the server has an admin token
};

Access access_of(const AccessRules& rules, const HttpQuestion& question);

// 401, with what is needed, for whoever lacks some of it.
HttpReply refuse_access(const Access& access);

// A camera is let in from the machine that serves, or with a kiosk's token (401 without); every
// visit is, and shows by its `hello` whether it is a kiosk's (show/answer/trust.h).
UpgradeAnswer admit(const AccessRules& rules, const HttpQuestion& question);

}  // namespace wellspring::show
