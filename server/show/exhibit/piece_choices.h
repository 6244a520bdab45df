// SPDX-License-Identifier: Apache-2.0
// Says what is seen at the places of pieces: which layers of very large pictures, of which years.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "show/exhibit/exhibit.h"
#include "world/world.h"

namespace wellspring::wire {
struct LensOrder;   // wire/messages.h
struct PieceOrder;  // wire/messages.h
}  // namespace wellspring::wire

namespace wellspring::show {

// Holds what is shown of a piece; layers are numbers of ExhibitPiece::layers.
struct PieceChoice {
  int layer = 0, over = 0;
  Blend by = Blend::none;
  float share = 0.5f;
  bool operator==(const PieceChoice&) const = default;
};
using PieceChoices = std::vector<PieceChoice>;  // for each piece; empty: each as it is at first

// Holds what is shown, and in which language words on pictures are: one of
// Exhibit::piece_languages, or empty for the exhibit's first.
struct ShownPieces {
  PieceChoices choices;
  std::string language;
  bool operator==(const ShownPieces&) const = default;
};

struct VisitorPieces {
  PieceChoices wish;
  ShownPieces shown;  // in the pictures that are drawn from now on
};

// Returns the language in which a visitor sees words on pictures.
std::string piece_language(const Exhibit& exhibit, const std::string& language);
// Returns the picture of a layer in a language.
const std::shared_ptr<const LargePicture>& picture_in(const PieceLayer& layer,
                                                      const std::string& language);

// Changes a choice as ordered. Returns what is wrong with the order; empty: nothing.
std::string choose_piece(const Exhibit& exhibit, const PieceOrder& order, PieceChoices& choices);
// Changes a choice to what a glass shows. Returns what is wrong with the order; empty: nothing.
std::string look_through(const Exhibit& exhibit, const LensOrder& order, PieceChoices& choices);
// Puts what is shown into the world, while nothing reads it.
void show_pieces(const Exhibit& exhibit, const ShownPieces& all, World& world);

}  // namespace wellspring::show
