// SPDX-License-Identifier: Apache-2.0
// Tells the store which pieces of very large pictures a visitor sees and goes towards, and shows
// them when they have come.
#pragma once
#include "show/state/show.h"

namespace wellspring::show {

// Asks for the pieces that the visitor's picture, which was just drawn, would have liked to show.
void want_pieces(const ExhibitStage& stage, VisitorPicture& picture);
// Returns whether pieces have come that the visitor's last picture did not show.
bool has_new_pieces(const VisitorPicture& picture);
// Begins anew what is kept of a view at rest, if pieces have come; before it is drawn again.
void follow_pieces(VisitorPicture& picture);

}  // namespace wellspring::show
