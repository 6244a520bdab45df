// SPDX-License-Identifier: Apache-2.0
// Adds to the day's sums of a show (Show::sums), in memory. These are the sums, and the key after
// the exhibit's id:
//
//   visits                        (the exhibit alone)  pages of visitors that have said hello
//   languages                     tag of the exhibit's that was said there, or "other"
//   dwell_seconds                 viewpoint: the nearest within dwell_distance; "-": none is
//   stories_begun, stories_heard  story; the latter: to the end
//   tours_begun, tours_finished, tours_abandoned   tour
//   kiosk_visits                  kiosk ("-": it has no name): its guests were greeted
#pragma once
#include <string>

#include "show/state/show.h"

namespace wellspring::show {

inline constexpr double dwell_distance = 3;  // metres
// seconds without a move, after which nobody is taken to be there
inline constexpr double dwell_at_most = 600;

void count(Show& show, const char* what, const std::string& thing = "", double by = 1);

// Counts a visit when its page has said hello. `goes_on`: it was there before, and its tour goes
// on.
void count_visit(Show& show, Visitor& visitor, bool goes_on);
// Counts where the visitor is, and what became of the tour. Call it every tick, after the visitor
// was moved. `finished`: the tour has just ended by itself.
void count_place(Show& show, Visitor& visitor, bool finished, double seconds);
// Counts what a visitor leaves unfinished, when the visitor has gone for good.
void count_leaving(Show& show, Visitor& visitor);

}  // namespace wellspring::show
