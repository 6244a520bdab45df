// SPDX-License-Identifier: Apache-2.0
// Adds to the day's sums of a show (Show::sums), in memory. By what, and the key after the
// exhibit's id:
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

inline constexpr double dwell_distance = 3;   // metres
inline constexpr double dwell_at_most = 600;  // seconds without a move: nobody is taken to be there

void count(Show& show, const char* what, const std::string& thing = "", double by = 1);

// When the page has said hello. `goes_on`: it was there before, and its tour goes on.
void count_visit(Show& show, Visitor& visitor, bool goes_on);
// Every tick, after the visitor was moved: where, and what became of the tour. `finished`: it has
// just ended by itself.
void count_place(Show& show, Visitor& visitor, bool finished, double seconds);
// When the visitor has gone for good.
void count_leaving(Show& show, Visitor& visitor);

}  // namespace wellspring::show
