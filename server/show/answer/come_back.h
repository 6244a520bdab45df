// SPDX-License-Identifier: Apache-2.0
// A visit goes on after a reload, a lost line, a laptop's sleep or a new start of the server. A
// page keeps a sealed text that tells where the visit is; `hello` brings it back. For a short time
// the visit itself is kept, so that its first picture is as good as its last was.
#pragma once
#include <list>
#include <string>

#include "show/state/show.h"

namespace wellspring::show {

inline constexpr double kept_seconds = 60;  // a visit that was broken off is kept as it is
inline constexpr size_t most_kept = 4;      // more: the one that left first is forgotten
inline constexpr int64_t token_days = 7;    // a sealed text is good for

// Tells the page the text when it is another than the last, at most every two seconds.
void send_token(Show& show, Visitor& visitor);
// The text as it is now.
std::string visit_token(const Show& show, Visitor& visitor);
// Keeps the visit of a visitor who is gone and whose pictures nobody works on; takes the entry out.
void keep_visit(Show& show, std::list<Visitor>::iterator gone);
// Those whose time is over.
void forget_visits(Show& show);
// The visitor, who has just been welcomed, is where the text says, in the same language or not. A
// text that is too old, not ours or another exhibit's changes nothing: false.
bool come_back(Show& show, Visitor& visitor, const std::string& token);

}  // namespace wellspring::show
