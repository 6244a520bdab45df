// SPDX-License-Identifier: Apache-2.0
#include "show/draw/still_pass.h"

#include <algorithm>

#include "base/clock.h"
#include "base/log.h"
#include "frame/tonemap.h"
#include "show/draw/moving.h"
#include "show/draw/make_picture_job.h"

namespace wellspring::show {
namespace {

constexpr double slice = 0.02, least_step = 0.004;  // seconds

}  // namespace

void begin_pass(Show& show, const PictureJob& job, Visitor& visitor) {
  VisitorPicture& picture = visitor.picture;
  StillPass& pass = show.pass;
  pass.visitor = &visitor;
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

void go_on_with_pass(Show& show) {
  StillPass& pass = show.pass;
  double began = seconds_now();
  if (pass.step == StillPass::Step::compute) {
    double seconds = std::clamp(show.renderer.until_moving, least_step, slice);
    if (!pass.denoiser->advance(seconds, &pass.given_up)) pass.step = StillPass::Step::finish;
  } else if (pass.step == StillPass::Step::finish) {
    finish_reconstruction(pass.visitor->picture.compositor.samples(), *pass.denoiser, pass.work,
                          pass.frame);
    tonemap(pass.frame, Tonemap{show.exhibit.exposure}, pass.picture);
    make_keyframe(pass.job.view, pass.picture, pass.frame.depth, pass.keyframe);
    pass.step = StillPass::Step::done;
  }
  pass.seconds += seconds_now() - began;
}

void take_pass(Show& show) {
  StillPass& pass = show.pass;
  Visitor& visitor = *pass.visitor;
  pass.at_work = false;
  if (pass.step != StillPass::Step::compute) visitor.picture.at_work = false;
  if (pass.given_up) {
    pass.visitor = nullptr;
    show.totals.given_up++;
    return;
  }
  if (pass.step != StillPass::Step::done) return;
  if (visitor.picture.keyframe.view == pass.keyframe.view)
    begin_fade(visitor.picture.keyframe, show.time, visitor.picture.fade);
  std::swap(pass.keyframe, visitor.picture.keyframe);
  visitor.picture.job = pass.job;
  visitor.picture.costs.backdrop = pass.backdrop;
  finish_backdrop(visitor.picture);
  RestState& rest = visitor.picture.rest;
  rest.reconstructed = true;
  rest.passed_at = show.time;
  rest.passed_seconds = pass.seconds;
  log::debug("visitor {}: reconstruction took {:.0f} ms", visitor.link->id, 1000 * pass.seconds);
  show.totals.reconstructed++;
  show.totals.reconstruction_ms = float(1000 * pass.seconds);
  pass.visitor = nullptr;
}

void watch_pass(Show& show) {
  StillPass& pass = show.pass;
  if (!pass.visitor) return;
  if (is_outdated(show, pass.job, *pass.visitor)) pass.given_up = true;
  if (pass.given_up && !pass.at_work) {
    pass.visitor = nullptr;
    show.totals.given_up++;
  }
}

}  // namespace wellspring::show
