// SPDX-License-Identifier: Apache-2.0
#include "show/draw/still_pass.h"

#include <algorithm>

#include "base/clock.h"
#include "base/log.h"
#include "base/rng.h"
#include "frame/tonemap.h"
#include "light/kept/skin/skin_light.h"
#include "picture/compositor.h"
#include "show/draw/make_picture_job.h"
#include "show/draw/pace.h"
#include "show/state/renderer.h"
#include "show/state/in_view.h"
#include "show/state/visitor_picture.h"
#include "show/state/visitor_world.h"

namespace wellspring::show {
namespace {

constexpr double slice = 0.02, least_step = 0.004;  // seconds
constexpr double sway_interval = 0.45;  // seconds between pictures of grass that a page moves

}  // namespace

void begin_pass(ShowDrawing& drawing, const PictureJob& job, Visitor& visitor) {
  VisitorPicture& picture = *visitor.picture;
  StillPass& pass = drawing.pass;
  pass.visitor = visitor.link->id;
  pass.job = job;
  pass.backdrop = picture.costs.backdrop;
  pass.step = StillPass::Step::compute;
  pass.given_up = false;
  pass.seconds = picture.costs.guide_seconds;
  log::debug(
      "visitor {}: reconstruction begins at {:.2f} samples a pixel, drawn and guided in "
      "{:.0f} ms",
      visitor.link->id, picture.rest.samples, 1000 * pass.seconds);
  picture.rest.passed_samples = picture.rest.samples;
}

void go_on_with_pass(ShowDrawing& drawing, const ExhibitStage& stage, Visitor& visitor) {
  StillPass& pass = drawing.pass;
  double began = seconds_now();
  if (pass.step == StillPass::Step::compute) {
    double seconds = std::clamp(drawing.renderer.until_moving, least_step, slice);
    if (!pass.denoiser->advance(seconds, &pass.given_up)) pass.step = StillPass::Step::finish;
  } else if (pass.step == StillPass::Step::finish) {
    Compositor& compositor = visitor.picture->compositor;
    if (compositor.samples().count.size() != pass.frame.color.size()) {
      pass.given_up = true;  // its samples were forgotten meanwhile, as the visitor sees others
    } else {
      finish_reconstruction(compositor.samples(), *pass.denoiser, pass.work, pass.frame);
      compositor.lay_over_still(pass.job.view, pass.frame, pass.backdrop && pass.job.sways);
      tonemap(pass.frame, Tonemap{stage.exhibit.exposure}, pass.picture);
      make_keyframe(pass.job.view, pass.picture, pass.frame.depth, pass.keyframe);
      pass.step = StillPass::Step::done;
    }
  }
  pass.seconds += seconds_now() - began;
}

void take_pass(Show& show) {
  StillPass& pass = show.drawing->pass;
  Visitor& visitor = visitor_of(show.visits, pass.visitor);
  pass.at_work = false;
  if (pass.step != StillPass::Step::compute) visitor.picture->at_work = false;
  if (pass.given_up) {
    pass.visitor = 0;
    show.totals.given_up++;
    return;
  }
  if (pass.step != StillPass::Step::done) return;
  if (visitor.picture->keyframe.view == pass.keyframe.view)
    begin_fade(visitor.picture->keyframe, show.time, visitor.picture->fade);
  std::swap(pass.keyframe, visitor.picture->keyframe);
  visitor.picture->job = pass.job;
  visitor.picture->costs.backdrop = pass.backdrop;
  finish_backdrop(*visitor.picture);
  RestState& rest = visitor.picture->rest;
  rest.reconstructed = true;
  rest.passed_at = show.time;
  rest.passed_seconds = pass.seconds;
  log::debug("visitor {}: reconstruction took {:.0f} ms", visitor.link->id, 1000 * pass.seconds);
  show.totals.reconstructed++;
  show.totals.reconstruction_ms = float(1000 * pass.seconds);
  pass.visitor = 0;
}

void watch_pass(Show& show) {
  StillPass& pass = show.drawing->pass;
  if (pass.visitor == 0) return;
  if (is_outdated(show, pass.job, visitor_of(show.visits, pass.visitor))) pass.given_up = true;
  if (pass.given_up && !pass.at_work) {
    pass.visitor = 0;
    show.totals.given_up++;
  }
}

namespace {

// cycles of smoothing; the latter after a while without light
constexpr int cycles = 2, first_cycles = 6;
constexpr double a_while = 1.5;  // seconds
constexpr int sight_rays = 64;  // rays that find how large moving things are in a visitor's picture

}  // namespace

bool may_be_laid_over(const PictureWindow& window, const View& view) {
  return 3 * size_t(window.width) * size_t(window.height) <=
         size_t(view.width) * size_t(view.height);
}

void begin_skin_light(Show& show, const Visitor& visitor) {
  SkinJob& job = show.drawing->renderer.skin;
  job.update = {};
  job.views.clear();
  float pixels = 0;
  bool alike = true;  // all visitors see the same moving things
  for (const Visitor& one : show.visits.visitors) {
    const View& view = one.place.last_view;
    if (!one.welcomed || !sees_moving(show.cast, show.visits, one, view)) continue;
    alike &= see_the_same(show.cast, show.visits, one, visitor);
    if (!see_the_same(show.cast, show.visits, one, visitor)) continue;
    const float seen =
        see_skin(*show.stage.world, show.stage.skin, view, sight_rays, job.turn).pixels;
    if (seen > 0) job.views.push_back(view);
    pixels = std::max(pixels, seen);
  }
  job.update.views = job.views;
  const SkinPace pace =
      plan_skin(pixels, double(show.drawing->samples_per_second), show.stage.skin.samples);
  job.update.samples = pace.samples;
  job.interval = alike ? pace.interval : least_interval;  // others may be nearer
  job.update.seed = mix64(show.ticks);
  job.update.transport = show.settings.transport;
  job.update.transport.clamp = show.settings.moving_clamp;
  job.cycles = show.time - job.lit_at > a_while ? first_cycles : cycles;
  job.time = show.time;
  if (pace.samples > 0) job.lit_at = show.time;
  job.turn++;
  job.at_work = true;
}

void compute_skin_light(ExhibitStage& stage, ShowDrawing& drawing) {
  SkinJob& job = drawing.renderer.skin;
  job.traced = 0;
  if (job.update.samples <= 0) return;
  job.traced = size_t(update_skin(*stage.world, stage.lights, job.update, stage.skin));
  smooth_skin(*stage.world, stage.skin, job.cycles);
}

void finish_skin_light(ShowDrawing& drawing, ShowTotals& totals) {
  drawing.renderer.skin.at_work = false;
  totals.samples += drawing.renderer.skin.traced;
}

namespace {

// Finds the light of moving lights on still surfaces in the visitor's picture, and on moving
// things.
void light_picture(ShowDrawing& drawing, ExhibitStage& stage, VisitorPicture& picture) {
  Renderer& renderer = drawing.renderer;
  DynamicImage& image = renderer.work.dynamic;
  const DynamicLights& from = renderer.posed_lights;
  const SplatSettings settings = dynamic_splat_settings();
  image.from = from, image.settings = settings;  // for grass (picture/grass_light.h)
  const View& view = picture.keyframe.view;
  BackdropSurfaces& surfaces = picture.surfaces;
  SettledBounce& settled = picture.settled;
  if (surfaces.view != view) {
    find_backdrop_surfaces(*stage.visibility, view, surfaces);
    picture.compositor.lay_over_backdrop(picture.keyframe, surfaces);
    settled = {};
  }
  see_surfaces(*stage.visibility, dynamic_light_view(view), image.surfaces, RasterShows::moving);
  DynamicLights others = from;
  take_settled(settled, others);
  if (wants_pass(settled))
    add_pass(*stage.world, stage.lights, surfaces.surfaces, settings, settled, image.bounce);
  begin_bounce(*stage.world, stage.lights, others, surfaces.surfaces, settings, {}, image.bounce);
  light_surfaces(*stage.world, stage.lights, from, surfaces.surfaces, settings, image.bounce,
                 renderer.work.backdrop_light);
  add_settled(settled, renderer.work.backdrop_light);
  if (!settled.lights.empty())
    begin_bounce(*stage.world, stage.lights, from, surfaces.surfaces, settings, {}, image.bounce);
  light_surfaces(*stage.world, stage.lights, from, image.surfaces, settings, image.bounce,
                 image.light);
}

}  // namespace

void draw_moving(ShowDrawing& drawing, ExhibitStage& stage, Visitor& visitor) {
  Renderer& renderer = drawing.renderer;
  double began = seconds_now();
  VisitorPicture& picture = *visitor.picture;
  const bool dynamic = !renderer.posed_lights.empty();
  if (dynamic) light_picture(drawing, stage, picture);
  const BackdropLight relit{picture.surfaces, renderer.work.backdrop_light};
  picture.compositor.set_dynamic(dynamic ? &renderer.work.dynamic : nullptr);
  picture.compositor.draw_moving(*stage.world, picture.keyframe, dynamic ? &relit : nullptr,
                                 *stage.visibility, Tonemap{stage.exhibit.exposure},
                                 renderer.posed_layer, renderer.work.moving_light,
                                 renderer.work.moving);
  renderer.posed_seconds = seconds_now() - began;
}

void finish_moving(ShowDrawing& drawing, ShowTotals& totals, Visitor& visitor) {
  VisitorPicture& picture = *visitor.picture;
  Renderer& renderer = drawing.renderer;
  const bool is_first = picture.posed_at < 0;
  picture.posed_at = renderer.posed_at;
  MovingPicture& moving = renderer.work.moving;
  // Otherwise the whole picture is drawn anew.
  const bool layer = renderer.posed_layer;
  const bool relit = !renderer.posed_lights.empty() || picture.job.sways;
  const PictureWindow& moves = layer ? moving.layer.window : moving.window;
  picture.backdrop &= relit || may_be_laid_over(moves, moving.view);
  if (!picture.backdrop) return;
  // An empty layer says that nothing moves any more.
  picture.layer_unsent = layer && (!moves.empty() || visitor.shown.has_layer);
  float& smoothed = visitor.times.moving;
  float milliseconds = float(1000 * renderer.posed_seconds);
  smoothed = smoothed > 0 ? smoothed + (milliseconds - smoothed) * 0.1f : milliseconds;
  std::swap(moving, picture.moving);
  picture.job.time_us = renderer.posed_us;
  // A page that has the still part of the picture need not get it again, and moves grass itself.
  const bool grass_is_due = picture.posed_at >= picture.swayed_at + sway_interval;
  if (!layer || !renderer.posed_lights.empty() || is_first || (relit && grass_is_due))
    picture.unshown = true, picture.swayed_at = picture.posed_at;
  totals.posed++;
}

void finish_backdrop(VisitorPicture& picture) {
  picture.backdrop = picture.costs.backdrop;
  picture.unshown = !picture.backdrop;
  picture.posed_at = -1e9;
  if (picture.backdrop && picture.moving.view == picture.keyframe.view) return;
  picture.moving = {};
  picture.layer_unsent = false;
}

void merge_moving(VisitorPicture& picture) {
  if (picture.moving.empty()) return;
  lay_over(picture.moving, picture.keyframe);
  picture.moving = {};
  picture.backdrop = false;
}

}  // namespace wellspring::show
