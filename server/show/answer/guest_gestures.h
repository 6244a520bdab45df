// SPDX-License-Identifier: Apache-2.0
// What guests before a kiosk ask for with a hand, as its page could with a touch. While the page
// shows what it turns the pages of itself (book, topics, partners, slides), gestures are handed to
// it in the kiosk message. Else digits: the story of that number. Swipes to the left, as a page is
// turned: the next sentence, or where nobody is telling the next story that they have not heard. To
// the right: the story again. Down: enough. (The storyteller herself answers a wave,
// avatar/mind/body_language.h.)
#pragma once
#include "show/state/show.h"

namespace wellspring::show {

// Once a tick, after the kiosk's step. A gesture counts once, however long it is told.
void follow_gestures(Show& show, Kiosk& kiosk);

}  // namespace wellspring::show
