// SPDX-License-Identifier: Apache-2.0
// Pages that nobody looks at make room for others. Who has done nothing for long, and is told
// nothing meanwhile, is asked whether they are still there; who does not answer, or whose page has
// been hidden for a while, is sent to rest: the visit leaves the show, and goes on where it was as
// soon as somebody comes back and there is a seat (show/answer/come_back.h). While a page is
// hidden, it gets no pictures. Kiosks are never asked, nor are leaders of a group that follows.
#pragma once
#include "show/state/arrivals.h"
#include "show/state/show.h"

namespace wellspring::show {

// After a message was carried out.
void note_presence(Visitor& visitor, const BrowserMessage& message);
// Once a tick, `dt` seconds after the last: asks, and sends to rest those whose pictures nobody
// works on. Their links are in show.visits.resting from then on, each with the hello by which it
// comes back as its first text.
void watch_presence(Show& show, double dt);

// Tells pages of the house's day and its announcements. Kiosks of a closed house:
// show/answer/orders.h.

// Once a tick, before visitors are read.
void follow_house(Show& show, Arrivals& arrivals);

// To a page that has just been welcomed: how the house is, and what is announced at the moment.
void tell_house(const ShowHouse& house, double time, Visitor& visitor);

}  // namespace wellspring::show
