// SPDX-License-Identifier: Apache-2.0
// Says what is seen at the places of pieces: which layers of very large pictures, of which years.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "show/exhibit/exhibit.h"
#include "show/exhibit/pieces/piece_choice.h"
#include "world/world.h"

namespace wellspring::wire {
struct LensOrder;   // wire/messages.h
struct PieceOrder;  // wire/messages.h
}  // namespace wellspring::wire

namespace wellspring::show {

using PieceChoices = std::vector<PieceChoice>;  // for each piece; empty: each as it is at first
PieceChoice choice_of(const PieceChoices& choices, size_t piece);

// Holds what is shown, and in which language words on pictures are: one of
// Exhibit::piece_languages, or empty for the exhibit's first.
struct ShownPieces {
  PieceChoices choices;
  std::string language;
  bool operator==(const ShownPieces&) const = default;
};

struct VisitorPieces {
  PieceChoices wish;
  PieceChoices before;    // a story's mark lets what is seen glide from these to the wish
  double told_at = -1e9;  // seconds of the show; when it came
  ShownPieces shown;      // in the pictures that are drawn from now on
  uint64_t arrivals = 0;  // LitVolumes::arrivals() of these
};

// Returns the language in which a visitor sees words on pictures.
std::string piece_language(const Exhibit& exhibit, const std::string& language);
// Returns the picture of a layer in a language.
const std::shared_ptr<const LargePicture>& picture_in(const PieceLayer& layer,
                                                      const std::string& language);

// Changes a choice as ordered. Returns what is wrong with the order; empty: nothing.
std::string choose_piece(const Exhibit& exhibit, const PieceOrder& order, PieceChoices& choices);
// Changes a choice as a story's mark says. Returns what is wrong with the mark; empty: nothing.
std::string choose_told(const Exhibit& exhibit, const std::string& id, const PieceMark& mark,
                        PieceChoices& choices);
// Returns what is seen on the way from one choice to another, of which `share` (0 to 1) is done.
PieceChoices glide(const PieceChoices& from, const PieceChoices& to, float share);
// Changes a choice to what a glass shows. Returns what is wrong with the order; empty: nothing.
std::string look_through(const Exhibit& exhibit, const LensOrder& order, PieceChoices& choices);
// Returns whether a volume is seen otherwise by one choice than by the other.
bool changes_volume(const Exhibit& exhibit, const PieceChoices& before, const PieceChoices& now);
// Puts the pictures that are shown into the world, while nothing reads it.
void show_pieces(const Exhibit& exhibit, const ShownPieces& all, World& world);

}  // namespace wellspring::show
