// SPDX-License-Identifier: Apache-2.0
// POST /api/v1/admin/announce: words of the house for all screens, by whoever has the token.
#pragma once
#include <functional>
#include <string>

#include "show/house/announcement.h"
#include "show/http/access.h"
#include "wire/http.h"

namespace wellspring::show {

inline constexpr size_t most_announced_bytes = 2000;       // of the text in one language
inline constexpr double longest_announcement = 24 * 3600;  // seconds

// Where announcements are handed in.
struct AnnouncementDesk {
  std::function<uint32_t(Announcement)> put;  // tells the announcement's number
};

// 403 where there is no admin token, 401 without it, 400 for a body that is wrong: naming the
// field. Else hands the announcement over and tells its number.
HttpReply answer_announce(const AnnouncementDesk& desk, const Access& access,
                          const HttpQuestion& question);

}  // namespace wellspring::show
