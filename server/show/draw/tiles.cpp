// SPDX-License-Identifier: Apache-2.0
#include "show/draw/tiles.h"

#include <algorithm>

#include "picture/keyframe.h"
#include "show/state/delivery.h"
#include "show/wall/wall.h"

namespace wellspring::show {

namespace {

bool may_take(const Visitor& tile, double time) {
  return tile.welcomed && takes_pictures(tile, time) && !tile.shown.encoder->task.busy();
}

}  // namespace

bool tiles_may_take(const Visitor& camera, double time) {
  bool any = false;
  for (const Visitor* tile : camera.wall.tiles) {
    const bool may = may_take(*tile, time);
    if (!may && time - tile->shown.sent_at < most_tile_wait) return false;
    any |= may;
  }
  return any;
}

std::vector<Visitor*> cut_into_tiles(Visitor& camera, const View& view, uint32_t frame,
                                     double time) {
  const Image8& whole = camera.shown.encoder->image;
  std::vector<Visitor*> able;
  for (Visitor* tile : camera.wall.tiles) {
    VisitorDelivery& shown = tile->shown;
    const WallPart& part = tile->wall.part;
    const PictureWindow window =
        tile_window(camera.wall.part, {view.width, view.height}, *part.column, *part.row);
    if (window.empty()) continue;
    shown.lost = !may_take(*tile, time);
    if (shown.lost) continue;
    Image8& image = shown.encoder->image;
    image.width = window.width, image.height = window.height;
    take_window(whole, window, image.rgb);
    shown.view = window_view(view, window);
    shown.frame_number = shown.encoder->frame = frame;
    shown.sent_at = time;
    note_sent(shown.flow, frame, time);
    tile->dynamic = camera.dynamic;  // by it quality is chosen
    able.push_back(tile);
  }
  camera.wall.moments.push_back({frame, time});
  camera.shown.lost = false;
  return able;
}

}  // namespace wellspring::show
