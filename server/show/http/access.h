// SPDX-License-Identifier: Apache-2.0
// Who may do what, decided once for each question: what the house's technician reads, what whoever
// looks after the house does, and what claims to be a kiosk.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "base/layers.h"
#include "show/house/house.h"
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
// visit is, and shows by its `hello` whether it is a kiosk's (show/answer/cameras.h).
UpgradeAnswer admit(const AccessRules& rules, const HttpQuestion& question);

// POST /api/v1/admin/announce: words of the house for all screens, by whoever has the token.

inline constexpr size_t most_announced_bytes = 2000;       // length of the text in one language
inline constexpr double longest_announcement = 24 * 3600;  // seconds

// Takes announcements in.
struct AnnouncementDesk {
  std::function<uint32_t(Announcement)> put;  // tells the announcement's number
};

// 403 where there is no admin token, 401 without it, 400 for a body that is wrong: naming the
// field. Else hands the announcement over and tells its number.
HttpReply answer_announce(const AnnouncementDesk& desk, const Access& access,
                          const HttpQuestion& question);

}  // namespace wellspring::show
