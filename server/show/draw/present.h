// SPDX-License-Identifier: Apache-2.0
// What a visitor is sent, and when: the picture that was drawn last, warped to where the visitor is
// now (picture/warp_picture.h), at the rate of the display whatever drawing takes. It says the last
// input that the view it shows has followed. After a camera cut, or where a warp would show too
// much that was never drawn, nothing is sent until a picture of the new place is there.
#pragma once
#include "show/state/show.h"

namespace wellspring::show {

// What is known of the pictures before and of the line; before acknowledgements are read.
void note_deliveries(Show& show, Visitor& visitor);
// Sends a picture if one is due and there is something new to show: the place, the storyteller or
// the light.
void present(Show& show, Visitor& visitor);
// All visitors, those first whose picture is due for longest; some milliseconds of them, and the
// others with the next tick.
void present_all(Show& show);
// There is something that the visitor has not been shown, and would be if a picture were due.
bool has_to_show(const Show& show, const Visitor& visitor);

}  // namespace wellspring::show
