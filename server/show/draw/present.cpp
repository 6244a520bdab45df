// SPDX-License-Identifier: Apache-2.0
#include "show/draw/present.h"

#include <algorithm>
#include <oneapi/tbb/info.h>
#include <utility>

#include "base/clock.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "frame/jpeg.h"
#include "show/draw/moving.h"
#include "show/draw/pace.h"
#include "show/state/animations.h"
#include "show/state/in_view.h"
#include "wire/packet.h"

namespace wellspring {

namespace {

constexpr double presenting = 0.012;  // seconds of a tick: then it reads what visitors ask for
constexpr double on_time = 0.0005;    // seconds that a picture may come too early
constexpr double fade_rate = 12;      // pictures a second from one picture at rest to the next
constexpr float most_unknown =
    0.8f;  // of a warped picture: beyond, the one before is as near to the truth (cache.warp)
// Seconds until a warp that showed too little is tried again, where no new keyframe comes before:
// tried with each tick, it would take the cores from that keyframe.
constexpr double tried_again = 0.1;
constexpr int animated_gain = 5;  // JPEG quality above the moving one while the storyteller moves

// On another thread: the tick goes on meanwhile, and waits before it touches the image again.
// The image of one that stands comes anew from its keyframe, should there be another: it is not
// kept.
void encode_and_publish(Visitor& visitor, const PacketHeader& header, bool full_chroma) {
  Encoder* encoder = visitor.shown.encoder.get();
  encoder->task.run([encoder, link = visitor.link, header, full_chroma] {
    double began = seconds_now(), processor_began = thread_seconds_now();
    auto packet = std::make_shared<Packet>(packet_header_bytes);
    write_packet_header(header, *packet);
    encode_jpeg(encoder->image, header.quality, full_chroma, *packet, packet_header_bytes);
    if (header.flags & packet_still) encoder->image = Image8{};
    encoder->bytes = packet->size();
    encoder->milliseconds = float(1000 * (seconds_now() - began));
    encoder->processor_seconds = thread_seconds_now() - processor_began;
    link->send_picture(std::move(packet));
  });
}

// How much later than the pose was made for its pictures are dated: the mouth is posed for that
// moment.
void note_lead(Show& show, uint64_t posed_us, uint64_t picture_us) {
  if (picture_us >= posed_us)
    show.picture_lead +=
        (std::min(1e-6f * float(picture_us - posed_us), 0.25f) - show.picture_lead) * 0.1f;
}

void send(Show& show, Visitor& visitor, const View& view, uint32_t seq, bool still) {
  VisitorDelivery& shown = visitor.shown;
  PacketHeader header;
  header.frame = ++shown.frame_number;
  header.seq = seq;
  header.time_us = microseconds_now();
  note_lead(show, visitor.picture.job.time_us, header.time_us);
  header.width = uint16_t(view.width);
  header.height = uint16_t(view.height);
  int quality = suggest_quality(shown.flow, visitor.wants.best_quality);
  bool fine = still && !sees_motion(show, visitor,
                                    view);  // pictures that are looked at for long, few a second
  const int still_quality = visitor.wants.still_quality;
  if (still) quality = fine ? still_quality : std::min(still_quality, quality + animated_gain);
  header.quality = uint8_t(quality);
  header.flags = uint8_t(packet_complete | (still ? packet_still : 0));
  note_sent(shown.flow, header.frame, show.time);
  encode_and_publish(visitor, header, fine);
  if (shown.sent_at > 0 && show.time > shown.sent_at)
    smooth(shown.measured_fps, float(1 / (show.time - shown.sent_at)));
  shown.sent_at = show.time;
  // Where ticks come a little late, pictures keep their rate all the same.
  double period = 1 / picture_rate(show, visitor);
  shown.pictured_at = std::clamp(shown.pictured_at + period, show.time - 0.5 * period, show.time);
  shown.seq = seq;
  shown.view = view;
  visitor.picture.unshown = false;
  show.totals.pictures++;
}

// Of a picture that was warped and has been encoded, for who asks whether there is a seat.
void note_cost(Show& show, Visitor& visitor) {
  Encoder& encoder = *visitor.shown.encoder;
  const double warping = std::exchange(visitor.shown.warp_seconds, 0.0);
  if (warping <= 0) return;
  show.capacity->note_shown(
      double(visitor.shown.view.width) * visitor.shown.view.height,
      warping * oneapi::tbb::info::default_concurrency() + encoder.processor_seconds);
}

bool is_later(uint32_t seq, uint32_t than) { return int32_t(seq - than) >= 0; }

// The encoder's image becomes the newest keyframe seen from `view`.
bool warp(Show& show, Visitor& visitor, const View& view) {
  double began = seconds_now();
  const VisitorPicture& picture = visitor.picture;
  float unknown = warp_picture(picture.keyframe, picture.around.keyframe, view, most_unknown,
                               show.warp, visitor.shown.encoder->image);
  visitor.shown.warp_seconds = seconds_now() - began;
  smooth(visitor.times.warp, float(1000 * visitor.shown.warp_seconds));
  if (unknown > most_unknown) {
    show.totals.unwarpable++;
    return false;
  }
  show.totals.warped++;
  return true;
}

}  // namespace

void present(Show& show, Visitor& visitor) {
  VisitorPicture& picture = visitor.picture;
  VisitorDelivery& shown = visitor.shown;
  const PictureJob& job = picture.job;
  if (job.camera_cuts != visitor.place.camera_cuts || picture.drawn_at < 0) return;
  // The tick does not wait for a picture that is still being encoded: others would wait, too.
  if (!may_take(show, visitor) || shown.encoder->task.busy()) return;
  const View view = visitor.place.last_view;
  bool stood = job.still && job.view == view;
  bool fades = !picture.fade.from.rgb.empty() && show.time - shown.sent_at >= 1 / fade_rate;
  if (!picture.unshown && !fades && (!job.keep || view == shown.view)) return;
  const bool waits_for_keyframe = shown.pictured_at > show.time;
  if (waits_for_keyframe && !picture.unshown) return;
  if (!stood && !waits_for_keyframe &&
      show.time - shown.pictured_at < 1 / picture_rate(show, visitor) - on_time)
    return;

  Encoder& encoder = *shown.encoder;
  // One packet is being sent when the next is made.
  if (encoder.bytes > 0) encoder.memory_bytes = bytes_of(encoder.image.rgb) + 2 * encoder.bytes;
  if (shown.frame_number > 0 && encoder.bytes > 0) {
    show.totals.picture_bytes += std::exchange(encoder.bytes, 0);
    smooth(visitor.times.encode, encoder.milliseconds);
    note_cost(show, visitor);
  }
  const float newer = fade_share(picture.fade, view, show.time);
  if ((picture.unshown || fades) && job.view == view) {  // drawn for this very view
    if (job.keep) copy_colors(picture.keyframe, {0, 0, view.width, view.height}, encoder.image);
    else std::swap(encoder.image, picture.image);
    if (newer < 1) mix_fade(picture.fade, newer, encoder.image);
    else picture.fade = {};
    if (!picture.moving.empty()) lay_over(picture.moving, encoder.image);
    send(show, visitor, view, visitor.place.seq, job.still && newer == 1);
    return;
  }
  picture.fade = {};
  if (show.renderer.posed == &visitor) return;  // reads the keyframe, and has soon done so
  merge_moving(picture);
  if (warp(show, visitor, view)) {
    send(show, visitor, view, visitor.place.seq, false);
  } else if (picture.unshown && is_later(job.seq, shown.seq) && warp(show, visitor, job.expected)) {
    send(show, visitor, job.expected, job.seq,
         false);  // so quick a turn: what can be shown of it
  } else {
    shown.pictured_at = show.time + tried_again;
    picture.unshown = false;
  }
}

void present_all(Show& show) {
  std::vector<Visitor*> all;
  for (Visitor& visitor : show.visitors)
    if (is_shown(visitor)) all.push_back(&visitor);
  std::ranges::stable_sort(all, {}, [](const Visitor* one) { return one->shown.pictured_at; });
  const double began = seconds_now();
  for (Visitor* visitor : all) {
    present(show, *visitor);
    if (seconds_now() - began > presenting) return;  // the others with the next tick
  }
}

bool has_to_show(const Show& show, const Visitor& visitor) {
  const VisitorPicture& picture = visitor.picture;
  return is_shown(visitor) && (picture.unshown || !picture.fade.from.rgb.empty() ||
                               visitor.place.last_view != visitor.shown.view);
}

}  // namespace wellspring
