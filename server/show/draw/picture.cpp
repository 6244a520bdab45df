// SPDX-License-Identifier: Apache-2.0
#include "show/draw/picture.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "base/clock.h"
#include "base/memory.h"
#include "picture/compose_drawn.h"
#include "picture/still/reconstruct_still.h"
#include "show/draw/decide.h"
#include "show/draw/late_samples.h"
#include "show/lens/pieces.h"
#include "show/draw/steer.h"
#include "show/draw/still_pass.h"
#include "show/state/renderer.h"
#include "show/state/lamps.h"
#include "show/state/visitor_picture.h"

namespace wellspring::show {

namespace {

// Share of a new measurement in the times that decide resolution: they follow a change of load
// within some three keyframes.
constexpr float soon = 0.3f;

// Converts times measured in one resolution to those expected in another.
void carry_times(double factor, StageTimes& times) {
  for (float* one : {&times.drawing, &times.light, &times.whole, &times.interval})
    *one *= float(factor);
}

// Returns whether pictures are as the render cache was published: points alone.
bool shows_points(const ShowSettings& settings) { return settings.display == Display::points; }

// Returns whether moving things are drawn by themselves: if they are little of the picture, as what
// they cover is kept.
bool draws_backdrop(const ExhibitStage& stage, const ShowSettings& settings,
                    const PictureJob& job) {
  if (!is_still(job) || !job.sees_moving || shows_points(settings)) return false;
  if (!stage.visibility->rasterises(job.view)) return false;
  if (!job.dynamic.empty() || job.sways) return true;
  PictureWindow window = moving_window(*stage.world, job.view);
  return !window.empty() && may_be_laid_over(window, job.view);
}

// Adds the light of lights that move or change to a picture of `view`; to one at rest it is added
// later.
void light_dynamically(ShowDrawing& drawing, ExhibitStage& stage, const PictureJob& job,
                       const View& view, Visitor& visitor) {
  DynamicImage& image = drawing.renderer.work.dynamic;
  const bool any = !job.dynamic.empty() && !is_still(job);
  if (any)
    compute_dynamic_light(*stage.world, stage.lights, *stage.visibility, view, job.dynamic,
                          dynamic_splat_settings(), image);
  visitor.picture->compositor.set_dynamic(any ? &image : nullptr);
}

DrawingStep plan_picture(Show& show, const PictureJob& job, const Technique& technique,
                         Visitor& visitor) {
  DrawingWork& work = show.drawing->renderer.work;
  PictureCosts& costs = visitor.picture->costs = {};
  costs.asked = job.rest.asked, costs.kept_samples = job.rest.samples;
  double began = seconds_now();
  const double cores_began = process_seconds_now();
  plan_samples(show, job, technique, work, visitor);
  double planned = seconds_now();
  costs.core_seconds = process_seconds_now() - cores_began;
  costs.display = float(1000 * (planned - began));
  bool more = false;
  if (begin_samples(show, job, technique, work, visitor) && !show.drawing->renderer.given_up) {
    more = trace_slice(show, job, technique, work);
  }
  costs.trace = float(1000 * (seconds_now() - planned));
  return more ? DrawingStep::trace : DrawingStep::draw;
}

DrawingStep trace_more(Show& show, const PictureJob& job, const Technique& technique,
                       Visitor& visitor) {
  double began = seconds_now();
  bool more = trace_slice(show, job, technique, show.drawing->renderer.work);
  visitor.picture->costs.trace += float(1000 * (seconds_now() - began));
  return more ? DrawingStep::trace : DrawingStep::draw;
}

// Paints the points as the render cache was published. Nothing is shown if no point is near.
void paint_points(RenderCache& cache, const View& view, Frame& frame) {
  fit_frame(view.width, view.height, frame);
  std::fill(frame.color.begin(), frame.color.end(), vec3(0));
  std::fill(frame.depth.begin(), frame.depth.end(), std::numeric_limits<float>::infinity());
  std::fill(frame.object.begin(), frame.object.end(), 0);
  cache.reconstruct(view, frame);
}

DrawingStep paint_picture(Show& show, const PictureJob& job, const Technique& technique,
                          Visitor& visitor) {
  RenderCache& cache = visitor.picture->cache;
  Compositor& compositor = visitor.picture->compositor;
  DrawingWork& work = show.drawing->renderer.work;
  PictureCosts& costs = visitor.picture->costs;
  double began = seconds_now();
  const double cores_began = process_seconds_now();
  remember_traced(show, job, technique, work, visitor);
  if (job.kind == PictureKind::samples) {
    cache.end_frame();
    return DrawingStep::done;
  }
  const Tonemap curve{show.stage.exhibit.exposure};
  costs.backdrop = draws_backdrop(show.stage, show.settings, job);
  light_dynamically(*show.drawing, show.stage, job, job.view, visitor);
  const bool points = shows_points(show.settings), passing = !is_still(job) && !points;
  if (points) paint_points(cache, job.view, work.frame);
  else if (passing)
    compositor.draw(cache, job.view, *show.stage.visibility, curve, work.picture, &work.depth);
  else
    compositor.draw_still(cache, job.view, *show.stage.visibility, work.frame,
                          costs.backdrop ? StillShows::backdrop : StillShows::all);
  want_pieces(show.stage, visitor.pieces.shown, visitor.picture->pieces);
  if (job.kind == PictureKind::reconstruction) {
    std::swap(work.frame, show.drawing->pass.frame);
    work.guided = 0;
    costs.guide_seconds = seconds_now() - began;
    return DrawingStep::guide;
  }
  double painted = seconds_now();
  if (!passing && !points)
    compositor.lay_over_still(job.view, work.frame, costs.backdrop && job.sways);
  if (!passing) tonemap(work.frame, curve, work.picture);
  work.seen = job.note_seen ? note_seen(job, work.picture, cache) : nullptr;
  make_keyframe(job.view, work.picture, passing ? work.depth : work.frame.depth, work.keyframe);
  if (passing && visitor.wants.local) work.keyframe.sway = compositor.find_sway(work.keyframe);
  double finished = seconds_now();

  costs.core_seconds += process_seconds_now() - cores_began;
  costs.drawing = points ? 0 : compositor.drawing_ms();
  costs.display += float(1000 * (painted - began)) - costs.drawing;
  costs.tonemap = float(1000 * (finished - painted));
  if (!is_still(job))
    costs.light = std::exchange(costs.display, 0.0f) + std::exchange(costs.tonemap, 0.0f);
  return DrawingStep::done;
}

// Does one visibility pass of a reconstruction's guides; the last step encodes the network's input.
DrawingStep find_guides(ShowDrawing& drawing, ExhibitStage& stage, const PictureJob& job,
                        VisitorPicture& picture) {
  DrawingWork& work = drawing.renderer.work;
  StillPass& pass = drawing.pass;
  double began = seconds_now();
  bool all = work.guided == guide_places;
  if (!all)
    add_still_guides(*stage.world, stage.lights, *stage.visibility, job.view,
                     picture.costs.backdrop ? RasterShows::still : RasterShows::all, work.guided++,
                     pass.work.guides, pass.work.followed);
  else begin_reconstruction(picture.compositor.samples(), pass.frame, *pass.denoiser, pass.work);
  picture.costs.guide_seconds += seconds_now() - began;
  return all ? DrawingStep::done : DrawingStep::guide;
}

}  // namespace

DrawingStep draw_step(Show& show, const PictureJob& job, DrawingStep step, Visitor& visitor) {
  double began = seconds_now();
  const Technique& technique = job.settled ? *show.stage.still_technique : *show.stage.technique;
  if (step == DrawingStep::plan) {
    step = plan_picture(show, job, technique, visitor);
  } else if (show.drawing->renderer.given_up) {
    if (step != DrawingStep::guide)
      remember_traced(show, job, technique, show.drawing->renderer.work, visitor);
    visitor.picture->costs.given_up = true;
    step = DrawingStep::done;
  } else if (step == DrawingStep::trace) {
    step = trace_more(show, job, technique, visitor);
  } else if (step == DrawingStep::draw) {
    step = paint_picture(show, job, technique, visitor);
  } else {
    step = find_guides(*show.drawing, show.stage, job, *visitor.picture);
  }
  visitor.picture->costs.seconds += seconds_now() - began;
  return step;
}

// Frees memory that came with somebody else's larger picture.
static void fit_memory(VisitorPicture& picture) {
  auto fit = [](auto& v) {
    if (v.capacity() > v.size() + v.size() / 4) v.shrink_to_fit();
  };
  for (Keyframe* keyframe : {&picture.keyframe, &picture.around.keyframe})
    fit(keyframe->color), fit(keyframe->disparity), fit(keyframe->farthest), fit(keyframe->nearest);
}

void finish_picture(Show& show, const PictureJob& job, Visitor& visitor) {
  VisitorPicture& picture = *visitor.picture;
  const PictureCosts& costs = picture.costs;
  StageTimes& times = visitor.times;
  const auto seen = std::exchange(show.drawing->renderer.work.seen, nullptr);
  if (costs.samples > 0 && costs.trace > 0)
    smooth(show.drawing->samples_per_second, float(costs.samples) / (0.001f * costs.trace));
  show.totals.samples += costs.samples;
  // A visitor whose view has changed meanwhile begins anew.
  if (visitor.place.moved_at <= job.time)
    picture.rest.asked = costs.asked, picture.rest.samples = costs.kept_samples;
  if (costs.given_up) {
    picture.around.drawn = false;
    show.totals.given_up++;
    return;
  }
  if (!costs.late) smooth(times.trace, costs.trace);
  if (job.kind == PictureKind::samples || job.kind == PictureKind::reconstruction) {
    picture.drawn_at = job.time;
    picture.job.settled = job.settled;
    if (job.kind == PictureKind::reconstruction) begin_pass(*show.drawing, job, visitor);
    show.drawing->renderer.work_bytes =
        memory_bytes(show.drawing->renderer.work) + memory_bytes(show.drawing->pass);
    return;
  }
  if (job.scale != picture.job.scale)
    carry_times(keyframe_cost(job.scale) / keyframe_cost(picture.job.scale), times);
  const bool still = is_still(job);
  const float share = still ? 0.1f : soon;
  if (!still) {
    smooth(times.light, costs.light, share);
  } else {
    smooth(times.display, costs.display);
    smooth(times.tonemap, costs.tonemap);
  }
  smooth(times.drawing, costs.drawing, share);
  if (!still) smooth(times.whole, float(1000 * costs.seconds), share);
  double interval = job.time - picture.drawn_at;
  if (interval > 0 && interval < 1) {
    smooth(picture.drawn_fps, float(1 / interval));
    if (!still) smooth(times.interval, float(1000 * interval), share);
  }
  if (!still)
    show.visits.capacity->note_drawn(double(visitor.wants.width) * visitor.wants.height,
                                     costs.core_seconds / keyframe_cost(job.scale));
  picture.drawn_at = job.time;
  picture.broker_seconds =
      costs.late ? double(job.samples) / std::max(double(show.drawing->samples_per_second), 1.0)
                 : 0;
  picture.stats = picture.cache.stats();
  picture.cache_bytes = picture.cache.memory_bytes() + picture.compositor.memory_bytes();
  if (seen) visitor.looks.seen = seen, visitor.looks.seen_at = job.time;
  if (std::exchange(picture.fades_next, false) && !picture.keyframe.empty() &&
      picture.keyframe.view == show.drawing->renderer.work.keyframe.view)
    begin_fade(picture.keyframe, show.time, picture.fade);
  std::swap(show.drawing->renderer.work.keyframe, picture.keyframe);
  picture.around.drawn = false;
  picture.relief = visitor.wants.local ? uncovered_a_metre(picture.keyframe) : 0;
  if (!still || job.dynamic.empty()) picture.surfaces = {}, picture.settled = {};
  // At rest, samples of its pixels take that memory.
  if (still || job.camera_cuts != picture.around.camera_cuts) picture.around = {};
  fit_memory(picture);
  picture.memory_bytes = picture_memory(visitor);
  show.drawing->renderer.work_bytes =
      memory_bytes(show.drawing->renderer.work) + memory_bytes(show.drawing->pass);
  picture.job = job;
  finish_backdrop(picture);
  show.totals.drawn++;
}

void draw_surroundings(Show& show, const PictureJob& job, Visitor& visitor) {
  VisitorPicture& picture = *visitor.picture;
  DrawingWork& work = show.drawing->renderer.work;
  follow_lamps(show.stage, visitor);
  take_answers(show.stage, show.cast, picture);
  light_dynamically(*show.drawing, show.stage, job, *job.around, visitor);
  picture.compositor.draw(picture.cache, *job.around, *show.stage.visibility,
                          Tonemap{show.stage.exhibit.exposure}, work.picture, &work.depth);
  make_keyframe(*job.around, work.picture, work.depth, work.around);
}

void finish_surroundings(ShowDrawing& drawing, ShowTotals& totals, const PictureJob& job,
                         Visitor& visitor) {
  VisitorPicture& picture = *visitor.picture;
  Surroundings& around = picture.around;
  std::swap(drawing.renderer.work.around, around.keyframe);
  around.unsent = visitor.wants.local;
  around.camera_cuts = job.camera_cuts;
  around.drawn = true;
  fit_memory(picture);
  picture.memory_bytes = picture_memory(visitor);
  totals.surroundings++;
}

}  // namespace wellspring::show
