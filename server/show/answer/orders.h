// SPDX-License-Identifier: Apache-2.0
// Reads what browsers order and carries it out once a tick. Bounds, with what is drawn at once
// (show/draw/decide.h), how long one visitor may make others wait:
//
// - of the orders of one kind that are not carried out yet, the newest wins: an older one is left
//   out, or what the newer one says anew of it. Two lamps are two kinds, and so are two animations;
// - of each kind so many a second are carried out; further ones wait, and the newest of them is
//   carried out when it is due. So the last order always wins.
//
// Orders keep their order as far as they are carried out in one tick. Inputs are all carried out as
// they come: their turns add up.
#pragma once
#include <cstddef>
#include <span>

#include "show/state/show.h"

namespace wellspring::show {

// How many orders of a kind are carried out: a second, and at once after a pause.
struct OrderBound {
  const char* type;  // type of the message
  double rate, burst;
};
// Kinds that are not listed cost no more than reading them.
std::span<const OrderBound> order_bounds();

// More that wait are forgotten, the oldest first.
inline constexpr size_t most_waiting_orders = 32;

// Carries out what is due of what the visitor has ordered; what is wrong is answered.
void follow_orders(Show& show, Visitor& visitor);

// The kiosks of a running show: each has its stage, its guests, and the storyteller while she is
// there.

// Once a tick, before the storyteller behaves. Steps every kiosk with what its cameras and pages
// say; stops stories and tours of who has left; finds the kiosk that the storyteller is with, from
// its first guest until its farewell is over; follows gestures; tells pages and cameras what is
// new to them. Kiosks that no exhibit names live as long as a page or a camera of theirs.
void follow_kiosks(Show& show);

// Notes that a guest touched the screen, if the page of a kiosk says or asks for that.
void note_touch(Visitor& visitor, const BrowserMessage& message);

// The kiosk that the storyteller is with; null: none.
Kiosk* her_kiosk(ShowKiosks& kiosks);

// Guests before a kiosk ask with a hand for what they could ask its page with a touch. While the
// page shows something whose pages it turns itself (book, topics, partners, slides), gestures are
// handed to it in the kiosk message. Else a digit asks for the story of that number, and a swipe to
// the left, as a page is turned, for the next sentence, or, while nobody tells, for the next story
// that they have not heard. A swipe to the right asks for the story again, one down for an end.
// (The storyteller herself answers a wave, avatar/mind/body_language.h.)

// Once a tick, after the kiosk's step. A gesture counts once, however long it is told.
void follow_gestures(Show& show, Kiosk& kiosk);

}  // namespace wellspring::show
