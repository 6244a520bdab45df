// SPDX-License-Identifier: Apache-2.0
#include "show/lens/lens.h"

#include <algorithm>
#include <cmath>

#include "base/clock.h"
#include "show/exhibit/pieces/exhibit_volumes.h"
#include "show/lens/pieces.h"
#include "show/state/in_view.h"
#include "show/state/lamps.h"
#include "show/state/visitor_picture.h"
#include "show/state/visitor_world.h"
#include "world/large_texture.h"

namespace wellspring::show {
namespace {

constexpr int least_side = 32, most_side = 1536;
constexpr float most_zoom = 64, zoom_of_others = 4;
constexpr double pause = 0.3;                // seconds without an order: the glass stands
constexpr double least_interval = 1 / 30.0;  // seconds from one picture to the next
constexpr double moving_interval = 0.2;      // while something moves in the visitor's picture
constexpr double most_share = 0.5;  // share of the renderer's time for all glasses together

ShownPieces choices_of(const Show& show, const Visitor& visitor) {
  ShownPieces shown = visitor.pieces.shown;
  const LensOrder& order = visitor.lens;
  look_through(show.stage.exhibit, order, shown.choices);
  if (order.depth > 0)
    cut_ahead(show.stage.exhibit, order, lens_ray(visitor.place.last_view, order), shown.choices);
  return shown;
}

}  // namespace

Ray lens_ray(const View& view, const LensOrder& order) {
  const vec2 at = order.at.value_or(vec2(0.5f)) * vec2(float(view.width), float(view.height));
  return view_ray(view, at.x, at.y);
}

View lens_view(const View& view, const LensOrder& order, float zoom, float sides) {
  const float pixel = 2 * view.tan_half_fov / float(view.height);
  const vec2 at = order.at.value_or(vec2(0.5f));
  View lens = view;
  lens.middle.x += (at.x - 0.5f) * float(view.width) * pixel;
  lens.middle.y += (0.5f - at.y) * float(view.height) * pixel;
  const float side = sides * order.radius * float(view.height);
  lens.tan_half_fov = 0.5f * side * pixel / zoom;
  lens.width = lens.height = std::clamp(int(std::lround(side)), least_side, most_side);
  return lens;
}

float zoom_of(const World& world, const View& view, const LensOrder& order) {
  if (order.zoom > 0) return std::clamp(order.zoom, 1.0f, most_zoom);
  const float x = order.at->x * float(view.width), y = order.at->y * float(view.height);
  const Ray ray = lens_ray(view, order);
  const Hit hit = world.intersect(ray);
  if (!hit.valid()) return zoom_of_others;
  const PlacedMesh& placed = world.placed(hit.instance);
  if (!placed.picture) return zoom_of_others;
  const TextureRef& reference = placed.material->base_color_texture;
  const Texture& texture = world.scene().textures[size_t(reference.texture)];
  const PixelToTexture to_texture(
      make_pictured_triangle(placed, hit.triangle, reference, view.position), view);
  const PyramidLevel& finest = placed.picture->base.picture->pyramid->levels().front();
  const PictureFootprint f = placed_footprint(to_texture.at(double(x), double(y), 1, texture),
                                              placed.picture->base.placing);
  const double texels = length(f.across * dvec2(double(finest.width), double(finest.height)));
  return std::clamp(float(texels), 1.0f, most_zoom);
}

bool moves_lens(double time, const Visitor& visitor) {
  return visitor.lens.at && time - visitor.lens_at < pause;
}

bool lens_is_due(const Show& show, const Visitor& visitor) {
  const VisitorPicture& picture = *visitor.picture;
  const LensPicture& lens = picture.lens;
  if (!visitor.lens.at || picture.at_work || picture.drawn_at < 0) return false;
  const auto holders = std::ranges::count_if(
      show.visits.visitors, [](const Visitor& one) { return one.lens.at.has_value(); });
  const double since = show.time - lens.drawn_at;
  if (since < std::max(least_interval, double(lens.seconds) * double(holders) / most_share))
    return false;
  const View& view = visitor.place.last_view;
  if (since >= moving_interval && sees_moving(show.cast, show.visits, visitor, view)) return true;
  return lens.order != visitor.lens || lens.seen != view || has_new_pieces(lens.pieces) ||
         lens.lamps != visitor.lamps.lit || lens.shown != choices_of(show, visitor);
}

void begin_lens(Show& show, Visitor& visitor) {
  LensPicture& lens = visitor.picture->lens;
  begin_world_of(show, visitor);
  lens.order = visitor.lens;
  lens.seen = visitor.place.last_view;
  lens.shown = choices_of(show, visitor);
  lens.lamps = visitor.lamps.lit;
  lens.drawn_at = show.time;
  if (lens.pieces.client) lens.pieces.arrivals = lens.pieces.client->arrivals();
  show_pieces_of(show.stage, lens.shown);
}

void draw_lens(Show& show, Visitor& visitor) {
  const double began = seconds_now();
  ExhibitStage& stage = show.stage;
  VisitorPicture& picture = *visitor.picture;
  LensPicture& lens = picture.lens;
  DrawingWork& work = show.drawing->renderer.work;
  if (!lens.compositor) lens.compositor = std::make_unique<Compositor>(work.compositor);
  follow_lamps(stage, visitor);
  lens.zoom = zoom_of(*stage.world, lens.seen, lens.order);
  const View view = lens_view(lens.seen, lens.order, lens.zoom);
  const DynamicLights lights = dynamic_lights_in(view, show.drawing->renderer.posed_lights);
  if (!lights.empty())
    compute_dynamic_light(*stage.world, stage.lights, *stage.visibility, view, lights,
                          dynamic_splat_settings(), work.dynamic);
  lens.compositor->set_skin(&stage.skin, &stage.lights);
  lens.compositor->set_maps(stage.lights.maps);
  lens.compositor->set_laid(laid_things(*stage.world, &stage.lights, stage.lights.maps,
                                        stage.exhibit.exposure, stage.lawns.shown()));
  lens.compositor->set_dynamic(lights.empty() ? nullptr : &work.dynamic);
  auto draw = [&](RenderCache& cache) {
    lens.compositor->draw(cache, view, *stage.visibility, Tonemap{stage.exhibit.exposure},
                          lens.picture);
  };
  if (stage.lights.maps) {
    // Maps light what is seen: to find the visitor's points in this view would cost more than all
    // the rest.
    RenderCache none;
    none.resize(view.width, view.height);
    draw(none);
  } else {
    auto projection = picture.cache.put_aside();
    draw(picture.cache);
    picture.cache.put_back(std::move(projection));
  }
  want_pieces(stage, lens.shown, lens.pieces);
  lens.took = float(seconds_now() - began);
}

void finish_lens(Show& show, Visitor& visitor) {
  LensPicture& lens = visitor.picture->lens;
  lens.unsent = true;
  smooth(lens.seconds, lens.took, 0.3f);
  visitor.picture->memory_bytes = picture_memory(visitor);
  show.totals.lenses++;
}

}  // namespace wellspring::show
