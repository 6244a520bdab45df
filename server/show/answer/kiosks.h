// SPDX-License-Identifier: Apache-2.0
// The kiosks of a running show: each has its stage, its guests, and the storyteller while she is
// there.
#pragma once
#include "show/state/show.h"

namespace wellspring::show {

// Once a tick, before the storyteller behaves. Steps every kiosk with what its cameras and pages
// say; stops stories and tours of who has left; finds the kiosk that the storyteller is with, from
// its first guest until its farewell is over; follows gestures; tells pages and cameras what is
// new to them. Kiosks that no exhibit names live as long as a page or a camera of theirs.
void follow_kiosks(Show& show);

// What a page says at a kiosk's screen, or asks for there, is a touch.
void note_touch(Visitor& visitor, const BrowserMessage& message);

// The kiosk that the storyteller is with; null: none.
Kiosk* her_kiosk(Show& show);

}  // namespace wellspring::show
