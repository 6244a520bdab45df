// SPDX-License-Identifier: Apache-2.0
#include "show/draw/carry_out.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <utility>

#include "show/draw/late_samples.h"
#include "show/draw/moving.h"
#include "show/draw/order_picture.h"
#include "show/draw/pace.h"
#include "show/draw/picture.h"
#include "show/draw/present.h"
#include "show/draw/still_pass.h"

namespace wellspring {

namespace {

// The world as it is now. Nothing may be drawn meanwhile.
void pose_world(Show& show) {
  if (show.figures.empty()) return;
  Figure& figure = show.figures[show.teller];
  show_figure(*show.world, figure, show.storyteller_visible);
  if (show.storyteller_visible && !show.visitors.empty())
    pose_figure(*show.world, figure, teller_of(show)->character, show.pose,
                show.storyteller.placement, show.scratch);
  show.world->commit();
  show.pose_number++;
}

void use_cores(Show& show, std::function<void()> work) {
  show.easel.worker.run([&show, work = std::move(work)] { show.easel.cores.execute(work); });
}

void draw_what_moves(Show& show, Visitor& visitor) {
  Easel& easel = show.easel;
  pose_world(show);
  easel.posed = &visitor;
  easel.posed_at = show.time;
  easel.posed_us = show.time_us;
  visitor.picture.at_work = true;
  use_cores(show, [&show] { draw_moving(show, *show.easel.posed); });
}

// The next of its steps, or all of them.
void go_on_drawing(Show& show) {
  show.easel.until_moving = seconds_to_moving(show);
  use_cores(show, [&show] {
    Easel& easel = show.easel;
    if (easel.surrounds) {
      draw_surroundings(show, easel.order, *easel.drawn);
      easel.step = DrawingStep::done;
    }
    while (easel.step != DrawingStep::done) {
      easel.step = draw_step(show, easel.order, easel.step, *easel.drawn);
      if (in_steps(easel.order)) break;
    }
  });
}

void begin_picture(Show& show, Visitor& visitor, int waiting, Purpose purpose) {
  Easel& easel = show.easel;
  easel.drawn = &visitor;
  easel.order = order_picture(show, visitor, std::max(waiting, 1), purpose);
  easel.surrounds = easel.order.around && !visitor.picture.around.drawn;
  if (!easel.surrounds) pose_world(show);
  visitor.picture.at_work = true;
  easel.given_up = false;
  easel.step = DrawingStep::plan;
  go_on_drawing(show);
}

void use_cores_for_pass(Show& show) {
  StillPass& pass = show.pass;
  show.easel.until_moving = seconds_to_moving(show);
  pass.at_work = true;
  if (pass.step == StillPass::Step::finish) pass.visitor->picture.at_work = true;
  use_cores(show, [&show] { go_on_with_pass(show); });
}

}  // namespace

bool take_finished(Show& show) {
  Easel& easel = show.easel;
  if (!easel.idle()) return false;
  if (!easel.brokers.empty()) finish_samples(show);
  if (show.pass.at_work) take_pass(show);
  if (easel.skin.at_work) finish_skin(show);
  if (Visitor* posed = std::exchange(easel.posed, nullptr)) {
    finish_moving(show, *posed);
    if (posed != easel.drawn) posed->picture.at_work = false;
    return true;
  }
  if (!easel.drawn || easel.step != DrawingStep::done) return true;
  if (std::exchange(easel.surrounds, false)) finish_surroundings(show, easel.order, *easel.drawn);
  else finish_picture(show, easel.order, *easel.drawn);
  easel.drawn->picture.at_work = false;
  easel.drawn = nullptr;
  return true;
}

void carry_out(Show& show, const Decision& decision, int waiting) {
  auto visitor = [&]() -> Visitor& { return *std::next(show.visitors.begin(), decision.visitor); };
  switch (decision.what) {
    case Drawing::nothing: return;
    case Drawing::moving: return draw_what_moves(show, visitor());
    case Drawing::skin:
      order_skin(show);
      return use_cores(show, [&show] { light_skin(show); });
    case Drawing::go_on:
      if (decision.hurry) show.easel.step = DrawingStep::draw;
      return go_on_drawing(show);
    case Drawing::samples:
      order_samples(show);
      return use_cores(show, [&show] { trace_samples(show, show.easel); });
    case Drawing::pass: return use_cores_for_pass(show);
    case Drawing::picture: return begin_picture(show, visitor(), waiting, decision.purpose);
  }
}

void draw_now(Show& show, int waiting) {
  if (waiting > 0) {
    pose_world(show);
    if (wants_skin(show.time, draw_states(show), renderer_state(show)))
      order_skin(show), light_skin(show), finish_skin(show);
  }
  const RendererState renderer = renderer_state(show);
  for (Visitor& visitor : show.visitors) {
    if (!wants_picture(show.time, draw_state(show, visitor), renderer)) continue;
    PictureOrder order = order_picture(show, visitor, waiting);
    draw_picture(show, order, visitor);
    finish_picture(show, order, visitor);
    present(show, visitor);
  }
  if (!order_samples(show)) return;
  trace_samples(show, show.easel);
  finish_samples(show);
}

}  // namespace wellspring
