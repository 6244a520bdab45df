// SPDX-License-Identifier: Apache-2.0
// Decides what a visitor is sent, and when: the picture that was drawn last, warped to where the
// visitor is now (picture/warp_picture.h), at the rate of the display whatever drawing takes. The
// picture says the last input that the view it shows has followed. After a camera cut, or if a warp
// would show too much that was never drawn, nothing is sent until a picture of the new place is
// there.
#pragma once
#include "show/state/show.h"

namespace wellspring::show {

// Notes how earlier pictures and the line did. Call it before acknowledgements are read.
void note_deliveries(Show& show, Visitor& visitor);
// Sends a picture if one is due and there is something new to show: the place, the storyteller or
// the light.
void present(Show& show, Visitor& visitor);
// Presents to all visitors, those first whose picture is due for longest; works for some
// milliseconds, and leaves the other visitors to the next tick.
void present_all(Show& show);
// Returns whether there is something that the visitor has not been shown, and would be if a picture
// were due.
bool has_to_show(const Show& show, const Visitor& visitor);

}  // namespace wellspring::show
