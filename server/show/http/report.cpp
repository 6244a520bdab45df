// SPDX-License-Identifier: Apache-2.0
#include "show/http/report.h"

#include <algorithm>
#include <thread>

#include "show/answer/cameras.h"
#include "show/state/delivery.h"
#include "show/state/renderer.h"
#include "show/state/show.h"
#include "show/state/visitor_picture.h"
#include "workers/crew.h"

namespace wellspring::show {

static CameraReport report_camera(const Eye& eye, double now) {
  CameraReport report{eye.kiosk,
                      eye.number,
                      eye.seen.name,
                      camera_states[size_t(eye.seen.camera)],
                      now - eye.camera_since,
                      eye.seen.parts};
  if (eye.seen.calibration && eye.seen.camera == CameraState::good) report.state = "calibrating";
  if (is_silent(eye, now))
    report.state = "silent", report.since = now - std::max(eye.received, eye.camera_since);
  if (is_lost(eye)) report.state = "disconnected", report.since = now - eye.gone;
  return report;
}

ShowReport make_report(const Show& show) {
  ShowReport report;
  report.ready = true;
  report.time = show.time;
  report.cores = int(std::thread::hardware_concurrency());
  report.all_visitors = size_t(show.visits.capacity->standing().seats);
  report.exhibit_problems = show.stage.problems.size();
  report.ticks = show.ticks;
  report.drawing_bytes = show.drawing->renderer.work_bytes + memory_bytes(show.drawing->warp);
  report.bad_samples = show.stage.lights.bad_samples ? show.stage.lights.bad_samples->load() : 0;
  report.samples_per_second = show.drawing->samples_per_second;
  report.denoiser_problem = show.drawing->pass.problem;
  if (const IlluminationMap* maps = show.stage.lights.maps.get()) {
    report.display = "maps";
    report.map_error = maps->error;
    report.map_texels = maps->nodes.light.size();
  }
  report.light_problem = show.stage.light_problem;
  if (show.stage.baker) report.bake = show.stage.baker->status();
  for (const Kiosk& kiosk : show.kiosks.all) {
    report.kiosks.push_back({kiosk.settings.name, kiosk.stage.now, kiosk.audience.guests.size(),
                             show.kiosks.her_kiosk == kiosk.settings.name});
    KioskReport& one = report.kiosks.back();
    one.screens = int(std::ranges::count_if(show.visits.visitors, [&](const Visitor& visitor) {
      return visitor.welcomed && kiosk_of(show, visitor) == &kiosk;
    }));
    one.cameras = int(std::ranges::count_if(
        show.kiosks.eyes, [&](const Eye& eye) { return eye.kiosk == one.name && !is_lost(eye); }));
    report.audience = std::max(report.audience, kiosk.audience.state);
  }
  report.open = show.house.state.open;
  report.quiet = show.house.state.quiet;
  report.connected_cameras = int(connected_cameras(show.kiosks));
  for (const Eye& eye : show.kiosks.eyes) report.cameras.push_back(report_camera(eye, show.time));
  report.mood = show.cast.teller.mind.mood;
  report.totals = show.totals;
  if (const Crew* crew = show.drawing->workers.crew.get()) report.workers = crew->report();
  if (show.cast.speech.counts) {
    Speaker::Counts counts = show.cast.speech.counts();
    report.voice_running = counts.process_id != 0;
    report.voice_restarts = counts.starts > 0 ? counts.starts - 1 : 0;
    report.voice_lines = counts.kept;
    report.voice_waiting = counts.waiting;
    report.voice_failed = counts.failed;
  }
  for (const Visitor& visitor : show.visits.visitors) {
    const CacheStats& stats = visitor.picture->stats;
    VisitorReport one;
    one.id = visitor.link->id;
    one.width = visitor.wants.width;
    one.height = visitor.wants.height;
    one.budget = visitor.picture->job.samples;
    one.drawing_ms = visitor.times.drawing;
    one.lens_ms = 1000 * visitor.picture->lens.seconds;
    const PicturePlan plan = picture_plan(show.settings, visitor);
    one.quality = plan.quality;
    one.eighths = plan.eighths;
    one.limit = limit(visitor.shown.way);
    one.line_ms = 1000 * visitor.shown.flow.line_trip;
    one.line_rate = visitor.shown.flow.line_rate;
    one.fps = visitor.shown.measured_fps;
    one.round_trip_ms = 1000 * visitor.shown.flow.round_trip;
    one.display_ms = visitor.times.display;
    one.trace_ms = visitor.times.trace;
    one.tonemap_ms = visitor.times.tonemap;
    one.encode_ms = visitor.times.encode;
    one.decode_ms = visitor.shown.flow.decode_ms;
    one.drawn_fps = visitor.picture->drawn_fps;
    one.warp_ms = visitor.times.warp;
    one.moving_ms = visitor.times.moving;
    one.whole_ms = visitor.times.whole;
    one.fresh = stats.fresh;
    one.empty = stats.empty;
    one.converged = stats.converged;
    one.mean_age = stats.mean_age;
    one.cache_bytes = visitor.picture->cache_bytes;
    one.memory_bytes = visitor.picture->memory_bytes;
    one.dropped = visitor.link->pictures_dropped();
    one.sounds_dropped = visitor.link->sounds_dropped();
    one.texts_dropped = visitor.link->texts_dropped();
    one.walks = show.time - visitor.place.moved_at < 1;
    one.interval_ms = visitor.times.interval;
    one.kiosk = visitor.kiosk;
    one.name = visitor.name;
    report.visitors.push_back(one);
  }
  return report;
}

}  // namespace wellspring::show
