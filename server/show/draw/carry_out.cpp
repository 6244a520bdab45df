// SPDX-License-Identifier: Apache-2.0
#include "show/draw/carry_out.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <utility>

#include "base/clock.h"
#include "show/draw/late_samples.h"
#include "show/draw/make_picture_job.h"
#include "show/draw/pace.h"
#include "show/draw/picture.h"
#include "show/draw/present.h"
#include "show/draw/still_pass.h"
#include "show/lens/lens.h"
#include "show/state/renderer.h"
#include "show/state/visitor_picture.h"
#include "show/state/visitor_world.h"

namespace wellspring::show {

namespace {

void use_cores(ShowDrawing& drawing, std::function<void()> work) {
  drawing.renderer.worker.run([&drawing, work = std::move(work)] {
    const double began = seconds_now();
    drawing.renderer.cores.execute(work);
    drawing.renderer.work_seconds = seconds_now() - began;
  });
}

// Whoever has had the renderer's time comes later with the next picture, given up or not.
void charge(ShowVisits& visits, ShowDrawing& drawing, double time, double seconds) {
  Renderer& renderer = drawing.renderer;
  const uint64_t id = drawing.pass.at_work ? drawing.pass.visitor
                      : renderer.posed     ? renderer.posed
                      : renderer.lensed    ? renderer.lensed
                                           : renderer.drawn;
  if (id == 0) return;
  Visitor& visitor = visitor_of(visits, id);
  visitor.picture->served += seconds * charge_weight(visits, time, visitor);
}

void draw_what_moves(Show& show, Visitor& visitor) {
  Renderer& renderer = show.drawing->renderer;
  begin_world_of(show, visitor);
  renderer.posed = visitor.link->id;
  renderer.posed_at = show.time;
  renderer.posed_us = show.time_us;
  renderer.posed_lights = visitor.dynamic;
  renderer.posed_layer = visitor.wants.local;
  visitor.picture->at_work = true;
  use_cores(*show.drawing, [&show, &visitor] { draw_moving(*show.drawing, show.stage, visitor); });
}

// The next of its steps, or all of them.
void go_on_drawing(Show& show) {
  Visitor& visitor = visitor_of(show.visits, show.drawing->renderer.drawn);
  go_on_in_world_of(show, visitor);
  show.drawing->renderer.until_moving = seconds_to_moving(show);
  use_cores(*show.drawing, [&show, &visitor] {
    Renderer& renderer = show.drawing->renderer;
    if (renderer.surrounds) {
      draw_surroundings(show, renderer.job, visitor);
      renderer.step = DrawingStep::done;
    }
    while (renderer.step != DrawingStep::done) {
      renderer.step = draw_step(show, renderer.job, renderer.step, visitor);
      if (is_still(renderer.job)) break;
    }
  });
}

void begin_picture(Show& show, Visitor& visitor, int waiting, const Decision& decision) {
  Renderer& renderer = show.drawing->renderer;
  renderer.drawn = visitor.link->id;
  renderer.served = decision.served;
  visitor.picture->served = std::max(visitor.picture->served, renderer.served);
  renderer.job = make_picture_job(show, visitor, std::max(waiting, 1), decision.kind);
  renderer.surrounds = renderer.job.around && !visitor.picture->around.drawn;
  begin_world_of(show, visitor);
  visitor.picture->at_work = true;
  renderer.given_up = false;
  renderer.step = DrawingStep::plan;
  go_on_drawing(show);
}

void draw_glass(Show& show, Visitor& visitor) {
  begin_lens(show, visitor);
  show.drawing->renderer.lensed = visitor.link->id;
  show.drawing->renderer.posed_lights = visitor.dynamic;
  visitor.picture->at_work = true;
  use_cores(*show.drawing, [&show, &visitor] { draw_lens(show, visitor); });
}

void use_cores_for_pass(Show& show) {
  StillPass& pass = show.drawing->pass;
  show.drawing->renderer.until_moving = seconds_to_moving(show);
  pass.at_work = true;
  Visitor& visitor = visitor_of(show.visits, pass.visitor);
  if (pass.step == StillPass::Step::finish) {
    visitor.picture->at_work = true;
    go_on_in_world_of(show, visitor);
  }
  use_cores(*show.drawing,
            [&show, &visitor] { go_on_with_pass(*show.drawing, show.stage, visitor); });
}

}  // namespace

bool take_finished(Show& show) {
  Renderer& renderer = show.drawing->renderer;
  if (!renderer.idle()) return false;
  const double seconds = std::exchange(renderer.work_seconds, 0);
  if (!renderer.asking.empty()) finish_samples(show);
  else if (!renderer.skin.at_work) charge(show.visits, *show.drawing, show.time, seconds);
  if (show.drawing->pass.at_work) take_pass(show);
  if (renderer.skin.at_work) finish_skin_light(*show.drawing, show.totals);
  if (const uint64_t posed = std::exchange(renderer.posed, 0); posed != 0) {
    Visitor& visitor = visitor_of(show.visits, posed);
    finish_moving(*show.drawing, show.totals, visitor);
    if (posed != renderer.drawn) visitor.picture->at_work = false;
    return true;
  }
  if (const uint64_t lensed = std::exchange(renderer.lensed, 0); lensed != 0) {
    Visitor& visitor = visitor_of(show.visits, lensed);
    finish_lens(show, visitor);
    visitor.picture->at_work = false;
    return true;
  }
  if (renderer.drawn == 0 || renderer.step != DrawingStep::done) return true;
  Visitor& drawn = visitor_of(show.visits, std::exchange(renderer.drawn, 0));
  if (std::exchange(renderer.surrounds, false))
    finish_surroundings(*show.drawing, show.totals, renderer.job, drawn);
  else finish_picture(show, renderer.job, drawn);
  drawn.picture->at_work = false;
  return true;
}

void carry_out(Show& show, const Decision& decision, int waiting) {
  auto visitor = [&]() -> Visitor& {
    return *std::next(show.visits.visitors.begin(), decision.visitor);
  };
  switch (decision.what) {
    case Drawing::nothing: return;
    case Drawing::moving: return draw_what_moves(show, visitor());
    case Drawing::skin:
      go_on_in_world_of(show, visitor());
      begin_skin_light(show, visitor());
      return use_cores(*show.drawing, [&show] { compute_skin_light(show.stage, *show.drawing); });
    case Drawing::go_on:
      if (decision.hurry) show.drawing->renderer.step = DrawingStep::draw;
      return go_on_drawing(show);
    case Drawing::lens: return draw_glass(show, visitor());
    case Drawing::samples:
      return use_cores(*show.drawing, [&show, brokers = request_samples(show)] {
        trace_samples(show.stage, show.cast, brokers, show.drawing->renderer);
      });
    case Drawing::pass: return use_cores_for_pass(show);
    case Drawing::picture: return begin_picture(show, visitor(), waiting, decision);
  }
}

}  // namespace wellspring::show
