// SPDX-License-Identifier: Apache-2.0
// Tells the store which pieces of very large pictures a visitor sees and goes towards, and shows
// them when they have come.
#pragma once
#include "show/state/show.h"
#include "show/state/visitor_picture.h"

namespace wellspring::show {

// Asks for the pieces that a picture, which was just drawn, would have liked to show, and last of
// all for the same pieces of a map's neighbouring years.
void want_pieces(const ExhibitStage& stage, const ShownPieces& shown, PieceWatch& watch);
// Returns whether pieces have come that the last picture did not show.
bool has_new_pieces(const PieceWatch& watch);
// Returns whether a picture at rest is to be there at once, and samples make it better later: the
// first one of a view with a very large picture, and those that show pieces which have just come.
bool is_wanted_at_once(const VisitorPicture& picture, const View& now);
// Begins anew what is kept of a view at rest, if pieces have come or others are shown; before it is
// drawn again.
void follow_pieces(const ShownPieces& shown, VisitorPicture& picture);

}  // namespace wellspring::show
