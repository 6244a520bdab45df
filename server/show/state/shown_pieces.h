// SPDX-License-Identifier: Apache-2.0
// Says what a visitor sees at the places of pieces: which layers of very large pictures, of which
// years. A wish is noted at once; pictures follow from the next one on. The world shows one
// visitor's choice at a time, as it does with lamps (show/state/lamps.h).
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "show/exhibit/exhibit.h"

namespace wellspring::wire {
struct LensOrder;   // wire/messages.h
struct PieceOrder;  // wire/messages.h
}  // namespace wellspring::wire

namespace wellspring::show {

struct Show;
struct ShowVisits;
struct ExhibitStage;
struct Visitor;
struct VisitorPicture;

// Holds what is shown of a piece; layers are numbers of ExhibitPiece::layers.
struct PieceChoice {
  int layer = 0, over = 0;
  Blend by = Blend::none;
  float share = 0.5f;
  bool operator==(const PieceChoice&) const = default;
};
using PieceChoices = std::vector<PieceChoice>;  // for each piece; empty: each as it is at first

struct VisitorPieces {
  PieceChoices wish, shown;  // shown: in the pictures that are drawn from now on
};

// Returns the wish that counts: the leader's, if there is one.
const PieceChoices& pieces_of(const ShowVisits& visits, const Visitor& visitor);
// Returns what is wrong with the order; empty: it is carried out.
std::string choose_piece(Show& show, Visitor& visitor, const PieceOrder& order);
// Changes a choice to what a glass shows. Returns what is wrong with the order; empty: nothing.
std::string look_through(const Exhibit& exhibit, const LensOrder& order, PieceChoices& choices);
// Makes the visitor's pictures follow the wish from the next one on, if it has changed. Call it
// while none is drawn for that visitor.
void follow_wish(const ShowVisits& visits, Visitor& visitor);
// Puts the choice into the world. Only while the renderer is idle.
void show_pieces(ExhibitStage& stage, const PieceChoices& choices);

}  // namespace wellspring::show
