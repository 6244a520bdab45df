// SPDX-License-Identifier: Apache-2.0
#include "show/draw/pieces.h"

#include "show/state/lamps.h"
#include "show/state/visitor_picture.h"
#include "world/large_texture.h"

namespace wellspring::show {

void want_pieces(const ExhibitStage& stage, VisitorPicture& picture) {
  std::vector<Wish> wishes = take_wishes(stage.exhibit.scene, picture.piece_motions);
  if (wishes.empty() && !picture.pieces) return;
  if (!picture.pieces) picture.pieces = std::make_unique<PieceClient>(shared_store());
  picture.pieces->want(std::move(wishes));
}

bool has_new_pieces(const VisitorPicture& picture) {
  return picture.pieces && picture.pieces->arrivals() != picture.pieces_shown;
}

void follow_pieces(VisitorPicture& picture) {
  if (!has_new_pieces(picture)) return;
  picture.pieces_shown = picture.pieces->arrivals();
  picture.compositor.forget_means();
  picture.broker.forget();
  look_anew(picture);
}

}  // namespace wellspring::show
