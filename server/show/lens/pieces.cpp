// SPDX-License-Identifier: Apache-2.0
#include "show/lens/pieces.h"

#include "show/state/lamps.h"
#include "world/large_texture.h"

namespace wellspring::show {

namespace {

// Adds the same pieces of the years before and after the one shown, as far as they lie alike.
void add_neighbours(const ExhibitPiece& piece, const PieceChoice& choice,
                    const std::string& language, std::vector<Wish>& wishes) {
  const PieceLayer& shown = piece.layers[size_t(choice.layer)];
  if (!shown.year) return;
  const PieceLayer *before = nullptr, *after = nullptr;
  for (const PieceLayer& layer : piece.layers) {
    if (layer.shown.placing != shown.shown.placing) continue;
    const auto size = [](const PieceLayer& one) {
      const PyramidLevel& finest = one.shown.picture->pyramid->levels().front();
      return std::pair(finest.width, finest.height);
    };
    if (size(layer) != size(shown)) continue;
    if (layer.year < shown.year && (!before || before->year < layer.year)) before = &layer;
    if (layer.year > shown.year && (!after || after->year > layer.year)) after = &layer;
  }
  const size_t count = wishes.size();
  for (size_t i = 0; i < count; i++) {
    const PieceKey key = wishes[i].key;
    if (key.source() != picture_in(shown, language)->source || wishes[i].urgency != Urgency::shown)
      continue;
    for (const PieceLayer* layer : {before, after})
      if (layer)
        wishes.push_back(
            {{picture_in(*layer, language)->source, key.level(), key.column(), key.row()},
             Urgency::wished});
  }
}

}  // namespace

void want_pieces(const ExhibitStage& stage, const ShownPieces& shown, PieceWatch& watch) {
  std::vector<Wish> wishes = take_wishes(*stage.world, watch.motions);
  if (wishes.empty() && !watch.client) return;
  const std::vector<ExhibitPiece>& pieces = stage.exhibit.pieces;
  for (size_t i = 0; i < pieces.size(); i++)
    if (pieces[i].picture)
      add_neighbours(pieces[i], choice_of(shown.choices, i), shown.language, wishes);
  if (!watch.client) watch.client = std::make_unique<PieceClient>(shared_store());
  watch.client->want(std::move(wishes));
}

bool has_new_pieces(const PieceWatch& watch) {
  return watch.client && watch.client->arrivals() != watch.arrivals;
}

bool is_wanted_at_once(const VisitorPicture& picture, const View& now) {
  if (picture.pieces.motions.empty()) return false;
  return !is_still(picture.job) || picture.job.view != now || has_new_pieces(picture.pieces);
}

void follow_pieces(const ShownPieces& shown, VisitorPicture& picture) {
  if (!has_new_pieces(picture.pieces) && picture.shown_pieces == shown) return;
  picture.shown_pieces = shown;
  if (picture.pieces.client) picture.pieces.arrivals = picture.pieces.client->arrivals();
  picture.compositor.forget_means();
  picture.broker.forget();
  look_anew(picture);
}

}  // namespace wellspring::show
