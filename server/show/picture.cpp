// SPDX-License-Identifier: Apache-2.0
#include "show/picture.h"

#include <algorithm>

#include "base/clock.h"
#include "base/rng.h"
#include "cache/compose_drawn.h"
#include "cache/predict.h"
#include "cache/trace_waiting.h"
#include "frame/jpeg.h"
#include "show/display_path.h"
#include "show/in_view.h"
#include "wire/packet.h"

namespace wellspring {

namespace {

constexpr double still_after = 0.25;   // seconds without motion until a picture counts as a still
constexpr double settled_after = 2;    // seconds without motion until the reference takes over
constexpr size_t least_measured = 1000;  // looks that tell how long one takes
constexpr double slack = 0.0015;       // seconds kept free of every period
constexpr double least_share = 0.2;    // of a period that goes to samples, even if the rate suffers
constexpr double still_rate = 20;      // pictures a second while only the storyteller moves
constexpr double settling_rate = 12;   // while nothing moves: more time for samples
constexpr double resting_rate = 4;     // when nothing in the picture changes any more
constexpr float nearly_all = 0.999f;   // converged
constexpr float forgotten = 0.998f;    // of what drawing took, a picture without it
constexpr float few_guessed = 0.01f;   // of the pixels, and the points alone show a picture at rest
constexpr double motion_seconds = 0.1;     // in which a visitor's motion is measured
constexpr float fastest = 25;              // metres a second; more is a jump
constexpr double predicted_pictures = 2;
constexpr float predicted_share = 0.3f;    // of the samples, at most
constexpr float barely_covered = 0.1f;  // of the pixels by points
constexpr float more_asked = 1.2f;      // than there is time for, by what was measured: none is idle
constexpr int animated_gain = 5;       // JPEG quality above the moving one while the storyteller moves

float milliseconds_since(double began) { return float(1000 * (seconds_now() - began)); }
void smooth(float& value, float sample) { value += (sample - value) * 0.1f; }

bool stands(const Show& show, const Visitor& visitor) {
  return visitor.frame_number > 0 && show.time - visitor.moved_at > still_after &&
         visitor.velocity == vec3(0) && visitor.move == vec3(0);
}

bool rests(const Show& show, const Visitor& visitor) {
  return stands(show, visitor) && !sees_figure(show, visitor.last_view) &&
         visitor.cache.stats().converged >= nearly_all;
}

// Seconds of a picture's period that are left for samples and looks.
double seconds_to_trace(const Show& show, const Visitor& visitor, int busy) {
  double period = 1 / picture_rate(show, visitor);
  double display = 0.001 * double(visitor.times.display + visitor.times.tonemap);
  return std::max((period - slack) / std::max(busy, 1) - display, least_share * period);
}

// Who walks is shown answers of the picture before, and the sooner. A place never seen yet, or a still
// camera's picture, waits for its own.
bool may_be_late(const Show& show, const Visitor& visitor, const Technique& technique, int samples) {
  return show.settings.late_samples && !technique.begin_pass &&
         samples <= BrokerSettings{}.most_waiting && visitor.cache.covered() > barely_covered;
}

DisplayCosts display_costs(const Show& show, const Visitor& visitor) {
  const StageTimes& times = visitor.times;
  auto seconds = [](float milliseconds) { return 0.001 * double(milliseconds); };
  return {show.samples_per_second, show.looks_per_second, seconds(times.drawing),
          seconds(times.display + times.tonemap),
          seconds(times.light)};
}

// Where the motion of the last moments leads by the time that answers asked for now are shown, and the
// picture after that. Inputs come in steps of their own, so that two pictures alone would not tell.
View view_ahead(const Show& show, Visitor& visitor, const View& view) {
  auto& past = visitor.past;
  auto too_old = [&](const auto& one) {
    return show.time - one.time > motion_seconds || one.view.width != view.width || one.view.height != view.height;
  };
  past.erase(past.begin(), std::find_if_not(past.begin(), past.end(), too_old));
  View ahead = view;
  if (!past.empty() && show.time > past.front().time) {
    double passed = show.time - past.front().time;
    if (length(view.position - past.front().view.position) > fastest * float(passed)) past.clear();  // a jump
    else ahead = extrapolate(past.front().view, view, float(predicted_pictures / (passed * picture_rate(show, visitor))));
  }
  past.push_back({show.time, view});
  return ahead;
}

// On another core: the tick goes on meanwhile, and waits before it touches the image again.
void encode_and_publish(Visitor& visitor, const PacketHeader& header, bool full_chroma) {
  Encoder* encoder = visitor.encoder.get();
  std::shared_ptr<Link> link = visitor.link;
  encoder->task.run([encoder, link, header, full_chroma] {
    double began = seconds_now();
    encode_jpeg(encoder->image, header.quality, full_chroma, encoder->jpeg);
    auto packet = std::make_shared<Packet>(packet_header_bytes + encoder->jpeg.size());
    write_packet_header(header, *packet);
    std::copy(encoder->jpeg.begin(), encoder->jpeg.end(), packet->begin() + packet_header_bytes);
    encoder->bytes = packet->size();
    encoder->milliseconds = milliseconds_since(began);
    link->send_picture(std::move(packet));
  });
}

}  // namespace

double picture_rate(const Show& show, const Visitor& visitor) {
  double rate = visitor.fps > 0 ? double(visitor.fps) : double(show.settings.fps);
  if (stands(show, visitor))
    rate = std::min(rate, sees_figure(show, visitor.last_view) ? still_rate
                          : rests(show, visitor)               ? resting_rate
                                                               : settling_rate);
  return std::clamp(rate, 1.0, 120.0);
}

bool wants_picture(const Show& show, const Visitor& visitor) {
  if (show.time - visitor.pictured_at < 1 / picture_rate(show, visitor) - 0.0005) return false;
  return !visitor.link->picture_pending() && may_send(visitor.flow, show.time);
}

// How much later than the tick's beginning its pictures are dated: the mouth is posed for that moment.
static void note_lead(Show& show, uint64_t picture_us) {
  if (picture_us >= show.time_us)
    show.picture_lead += (std::min(1e-6f * float(picture_us - show.time_us), 0.25f) - show.picture_lead) * 0.1f;
}

void make_picture(Show& show, Visitor& visitor, int busy) {
  RenderCache& cache = visitor.cache;
  const Viewpoint& at = visitor.view;
  View view = make_view(show.exhibit.scene, at.position, at.yaw, at.pitch, at.fov, visitor.width,
                        visitor.height);
  if (view != visitor.last_view) visitor.moved_at = show.time;
  bool still = show.time - visitor.moved_at > still_after;
  visitor.last_view = view;
  uint32_t seq = visitor.seq;
  double began = seconds_now();

  uint64_t seed = mix64(show.ticks * 0x9e3779b9u + visitor.link->id);
  double seconds = seconds_to_trace(show, visitor, busy);
  DisplayPlan display = plan_display(seconds, size_t(view.width) * size_t(view.height),
                                     display_costs(show, visitor),
                                     visitor.display, still, show.settings.draw);
  visitor.budget = display.samples;
  visitor.display = display;
  // Who moves is shown shapes and reflectances as they are, in light of half their resolution.
  bool coarse = display.drawn && !still && show.sight && show.sight->can_see(view);
  View lit = coarse ? light_view(view) : view;
  cache.resize(view.width, view.height);
  cache.move_points(*show.world);
  land(visitor.broker.collect(), *show.world, show.pose_number, cache);
  cache.project(lit);
  cache.attend();
  bool settled = show.time - visitor.moved_at > settled_after;
  const Technique& technique = settled ? *show.still_technique : *show.technique;
  int most_asked = int(more_asked * float(display.samples));
  bool late = !still && may_be_late(show, visitor, technique, most_asked);
  int asked = late ? most_asked : display.samples;
  View ahead = view_ahead(show, visitor, lit);
  visitor.ahead.clear();
  if (ahead != lit && !technique.begin_pass)
    cache.predict(ahead, int(predicted_share * float(asked)), seed, visitor.ahead);
  cache.plan(lit, asked - int(visitor.ahead.size()), seed, visitor.requests);
  visitor.requests.insert(visitor.requests.end(), visitor.ahead.begin(), visitor.ahead.end());
  double planned = seconds_now();
  TransportSettings transport = show.settings.transport;
  if (!settled) transport.clamp = show.settings.moving_clamp;
  if (late) {
    visitor.broker.ask(lit, {&technique, transport}, visitor.requests);
    visitor.broker_seconds = double(display.samples) / std::max(double(show.samples_per_second), 1.0);
    visitor.samples.clear();
  } else {
    visitor.samples.resize(visitor.requests.size());
    if (technique.begin_pass)
      technique.begin_pass(*show.world, transport, lit, visitor.link->id, uint32_t(show.ticks),
                           show.lights);
    trace(technique, *show.world, show.lights, transport, visitor.requests, visitor.samples);
  }
  double traced = seconds_now();
  if (!late) cache.remember(lit, visitor.requests, visitor.samples);
  bool guessed = cache.stats().filled > few_guessed || !still || sees_figure(show, view);
  bool drawn = coarse || (display.drawn && guessed);
  visitor.looks.clear();
  if (coarse)
    cache.draw(view, *show.sight, Tonemap{show.exhibit.exposure}, visitor.shown);
  else
    cache.survey(view, drawn ? show.sight.get() : nullptr, display.looks, visitor.frame, visitor.looks);
  visitor.seen.resize(visitor.looks.size());
  double surveyed = seconds_now();
  see(*show.world, show.lights, visitor.looks, visitor.seen);
  double looked = seconds_now();
  if (!coarse) cache.reconstruct(view, visitor.seen, visitor.frame);
  double reconstructed = seconds_now();

  Encoder& encoder = *visitor.encoder;
  encoder.task.wait();
  if (visitor.frame_number > 0) {
    show.totals.picture_bytes += encoder.bytes;
    smooth(visitor.times.encode, encoder.milliseconds);
  }
  if (coarse) {
    std::swap(visitor.shown, encoder.image);
  } else {
    double waited = seconds_now();
    tonemap(visitor.frame, Tonemap{show.exhibit.exposure}, encoder.image);
    smooth(visitor.times.tonemap, milliseconds_since(waited));
  }

  PacketHeader header;
  header.frame = ++visitor.frame_number;
  header.seq = seq;
  header.time_us = microseconds_now();
  note_lead(show, header.time_us);
  header.width = uint16_t(view.width);
  header.height = uint16_t(view.height);
  int quality = suggest_quality(visitor.flow, visitor.best_quality);
  bool fine = still && !sees_figure(show, view);  // pictures that are looked at for long, few a second
  if (still) quality = fine ? visitor.still_quality : std::min(visitor.still_quality, quality + animated_gain);
  header.quality = uint8_t(quality);
  header.flags = uint8_t(packet_complete | (still ? packet_still : 0));
  note_sent(visitor.flow, header.frame, show.time);
  encode_and_publish(visitor, header, fine);

  if (!visitor.samples.empty() && traced > planned) {
    float rate = float(double(visitor.samples.size()) / (traced - planned));
    show.samples_per_second += (rate - show.samples_per_second) * 0.1f;
  }
  if (visitor.looks.size() >= least_measured && looked > surveyed) {
    float rate = float(double(visitor.looks.size()) / (looked - surveyed));
    show.looks_per_second += (rate - show.looks_per_second) * 0.1f;
  }
  smooth(coarse ? visitor.times.light : visitor.times.display,
         float(1000 * ((planned - began) + (surveyed - traced) + (reconstructed - looked))) -
             (drawn ? cache.stats().drawing_ms : 0.0f));
  if (drawn) smooth(visitor.times.drawing, cache.stats().drawing_ms);
  else visitor.times.drawing *= forgotten;  // a moment's load is no verdict
  smooth(visitor.times.look, float(1000 * (looked - surveyed)));
  if (!late) smooth(visitor.times.trace, float(1000 * (traced - planned)));
  if (visitor.pictured_at > 0 && show.time > visitor.pictured_at)
    smooth(visitor.measured_fps, float(1 / (show.time - visitor.pictured_at)));
  visitor.pictured_at = show.time;
  show.totals.pictures++;
  show.totals.samples += visitor.samples.size();
}

void trace_for_next(Show& show) {
  std::vector<Broker*> brokers;
  double seconds = 0;
  for (Visitor& visitor : show.visitors) {
    if (visitor.broker_seconds <= 0) continue;
    brokers.push_back(&visitor.broker);
    seconds += std::exchange(visitor.broker_seconds, 0.0);
  }
  if (brokers.empty()) return;
  std::mutex guard;
  double began = seconds_now();
  size_t traced = trace_waiting(brokers, *show.world, show.lights, show.pose_number, began + seconds, guard);
  double took = seconds_now() - began;
  show.totals.samples += traced;
  if (traced == 0) return;
  show.samples_per_second += (float(double(traced) / took) - show.samples_per_second) * 0.1f;
  for (Visitor& visitor : show.visitors)
    if (std::find(brokers.begin(), brokers.end(), &visitor.broker) != brokers.end())
      smooth(visitor.times.trace, float(1000 * took / double(brokers.size())));
}

}  // namespace wellspring
