// SPDX-License-Identifier: Apache-2.0
#include "show/answer/walls.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/log.h"
#include "show/answer/commands.h"
#include "show/state/delivery.h"
#include "show/state/make_show.h"

namespace wellspring::show {

namespace {

// Wide pictures have the pixels of so many visitors' at most.
constexpr double most_pictures = 4;
// Makes the number of a camera's link from that of its first tile: links are counted from 1.
constexpr uint64_t of_a_camera = uint64_t(1) << 63;

Visitor& make_camera(Show& show, const Visitor& tile) {
  const WallPart& part = tile.wall.part;
  log::info("wall '{}' begins", part.name);
  Visitor& camera = begin_visit(
      show, std::make_shared<Link>(of_a_camera | tile.link->id, LinkKind::visit, "wall"));
  camera.wall.role = WallRole::camera;
  camera.wall.part.name = part.name;
  camera.hearing.wanted = false;
  Hello hello;
  hello.exhibit = show.stage.exhibit.id;
  hello.lang = tile.lang;
  handle(show, camera, hello);
  const int start = find_viewpoint(show.stage.exhibit, part.viewpoint);
  if (start >= 0)
    go_to_viewpoint(camera.place, camera.hearing.narration.voice, show.stage.exhibit, start);
  return camera;
}

// Returns whether a tile must be sent a picture although nothing has changed, and can take it.
bool needs_picture(const Visitor& tile, double time) {
  return tile.shown.lost && takes_pictures(tile, time);
}

void set_size(Visitor& camera, const ShowSettings& settings) {
  const Visitor& tile = *camera.wall.tiles.back();
  camera.wall.part = tile.wall.part;
  const WallSize size = tile_size(tile.wall.part, {tile.wants.width, tile.wants.height},
                                  most_pictures * settings.max_pixels);
  const WallSize whole = wall_size(tile.wall.part, size);
  camera.wants.width = whole.width;
  camera.wants.height = whole.height;
}

void show_moments(Visitor& camera, double time) {
  auto& moments = camera.wall.moments;
  while (!moments.empty()) {
    const VisitorWall::Moment& first = moments.front();
    const auto lacks = [&](const Visitor* tile) {
      return std::ranges::any_of(tile->shown.flow.in_flight,
                                 [&](const Flow::Sent& sent) { return sent.frame == first.frame; });
    };
    const bool waits = std::ranges::any_of(camera.wall.tiles, lacks);
    if (waits && time - first.sent_at < most_tile_wait) return;
    const std::string message = nlohmann::json{{"type", "show"}, {"frame", first.frame}}.dump();
    for (Visitor* tile : camera.wall.tiles) tile->link->send_text(message);
    moments.pop_front();
  }
}

}  // namespace

void follow_walls(Show& show) {
  std::list<Visitor>& all = show.visits.visitors;
  std::vector<std::pair<Visitor*, size_t>> before;  // cameras, and how many tiles they had
  for (Visitor& visitor : all)
    if (visitor.wall.role == WallRole::camera) {
      before.emplace_back(&visitor, visitor.wall.tiles.size());
      visitor.wall.tiles.clear();
    }
  for (Visitor& visitor : all) {
    if (visitor.wall.role != WallRole::tile || !visitor.welcomed) continue;
    Visitor* camera = camera_of(show.visits, visitor);
    if (!camera) camera = &make_camera(show, visitor);
    camera->wall.tiles.push_back(&visitor);
    camera->shown.lost |= needs_picture(visitor, show.time);
  }
  // Nobody holds the keys any more that a tile's page has had down.
  for (const auto& [camera, tiles] : before)
    if (camera->wall.tiles.size() < tiles) camera->place.move = vec3(0);
  for (Visitor& camera : all) {
    if (camera.wall.role != WallRole::camera || camera.left) continue;
    camera.left = camera.wall.tiles.empty();
    if (camera.left) continue;
    set_size(camera, show.settings);
    show_moments(camera, show.time);
    for (Link::Out out; camera.link->take_out(out);) continue;  // nobody reads its words
  }
}

}  // namespace wellspring::show
