// SPDX-License-Identifier: Apache-2.0
#include "show/draw/present.h"

#include <algorithm>
#include <utility>

#include "base/clock.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "frame/disparity_code.h"
#include "frame/tiles.h"
#include "image/image.h"
#include "show/draw/pace.h"
#include "show/draw/parts.h"
#include "show/draw/still_pass.h"
#include "show/draw/sway_packet.h"
#include "show/draw/tiles.h"
#include "show/state/delivery.h"
#include "show/state/renderer.h"
#include "show/state/in_view.h"
#include "show/state/visitor_picture.h"
#include "wire/packet.h"

namespace wellspring::show {

namespace {

constexpr double presenting = 0.012;  // seconds of a tick; then it reads what visitors ask for
constexpr double early = 0.0005;      // seconds that a picture may come too early
constexpr double fade_rate = 12;      // pictures a second from one picture at rest to the next
constexpr float most_unknown =
    0.8f;  // share of a warped picture; beyond, the one before is as near to the truth (cache.warp)
// Seconds until a warp that showed too little is tried again, if no new keyframe comes before:
// tried with each tick, it would take the cores from that keyframe.
constexpr double tried_again = 0.1;
constexpr int near_lossless = 95;  // JPEG quality of tiles that have not changed for a moment
// Seconds without a change until then; longer while better pictures are on their way.
constexpr double quiet = 0.5, quiet_in_samples = 4;
constexpr double refine_interval = 0.05;   // seconds between parts of a picture at rest
constexpr double most_part_bytes = 256e3;  // bytes of one packet of parts
constexpr int animated_gain = 5;  // JPEG quality above that in motion while the storyteller moves

// Calls make(encoder), which returns the packet, on another thread: the tick goes on meanwhile, and
// waits before it touches the image again. pixels: as Encoder::pixels.
template <class Make>
void encode(Visitor& visitor, int quality, double pixels, Make make) {
  Encoder* encoder = visitor.shown.encoder.get();
  encoder->quality = quality;
  encoder->pixels = pixels;
  encoder->task.run([encoder, link = visitor.link, make = std::move(make)] {
    const double began = seconds_now(), processor_began = thread_seconds_now();
    std::shared_ptr<Packet> packet = make(*encoder);
    encoder->bytes = packet->size();
    encoder->milliseconds = float(1000 * (seconds_now() - began));
    encoder->processor_seconds = thread_seconds_now() - processor_began;
    // One packet is being sent while the next is made.
    encoder->memory_bytes =
        bytes_of(encoder->image.rgb, encoder->has.image.rgb) + 2 * encoder->bytes;
    if (packet->empty()) encoder->unsent = true;
    else link->send_picture(std::move(packet));
  });
}

// Puts the depth behind the JPEG of a keyframe's packet.
void add_depth(const PacketHeader& header, KeyframeHeader keyframe,
               const std::vector<float>& disparity, Packet& packet) {
  keyframe.color_bytes = uint32_t(packet.size() - keyframe_header_bytes);
  write_packet_header(header, keyframe, packet);
  encode_disparity(disparity, keyframe.width, keyframe.height, keyframe.unit, packet);
}

// Encodes a complete picture. A picture at rest comes anew from its keyframe if it is needed again:
// its image is not kept, but for a browser that takes parts while these are made of it. eighths: of
// the image's size, which is that of the header's. keyframe: its header if it is one; the encoder
// has its disparities.
void encode_complete(double time, Visitor& visitor, const View& view, const PacketHeader& header,
                     bool full_chroma, int eighths, const std::optional<KeyframeHeader>& keyframe) {
  Encoder& encoder = *visitor.shown.encoder;
  encoder.full_chroma = full_chroma;
  const bool keeps = visitor.wants.parts && stands(time, visitor);
  const double pixels = counted_pixels(double(encoder.image.width) * encoder.image.height, eighths);
  auto make = [header, view, full_chroma, eighths, keeps, keyframe, now = time](Encoder& encoder) {
    const size_t header_bytes = keyframe ? keyframe_header_bytes : packet_header_bytes;
    auto packet = std::make_shared<Packet>(header_bytes);
    write_packet_header(header, *packet);
    const Image8& image = encoder.image;
    encode_jpeg(eighths < 8 ? shrink(image, header.width, header.height) : image, header.quality,
                full_chroma, *packet, header_bytes);
    if (keyframe) add_depth(header, *keyframe, std::exchange(encoder.disparity, {}), *packet);
    add_sway(std::exchange(encoder.sway, {}), view, *packet);
    if (keeps) note_complete(image, header.quality, eighths == 8, now, encoder.has);
    else encoder.has = {};
    if ((header.flags & packet_still) && !keeps) encoder.image = Image8{};
    return packet;
  };
  encode(visitor, header.quality, pixels, make);
}

// Encodes a picture that comes beside a keyframe: a layer, or the wide view.
void encode_beside(Visitor& visitor, const PacketHeader& header, const KeyframeHeader& keyframe,
                   std::vector<uint8_t> rgb, std::vector<float> disparity) {
  auto make = [header, keyframe, disparity = std::move(disparity),
               image = Image8{keyframe.width, keyframe.height, std::move(rgb)}](Encoder&) {
    auto packet = std::make_shared<Packet>(keyframe_header_bytes);
    encode_jpeg(image, header.quality, false, *packet, keyframe_header_bytes);
    add_depth(header, keyframe, disparity, *packet);
    return packet;
  };
  encode(visitor, header.quality, 0, std::move(make));
}

void encode_lens(Visitor& visitor, const PacketHeader& header, const LensPicture& lens) {
  auto make = [header, zoom = lens.zoom, image = lens.picture](Encoder&) {
    auto packet = std::make_shared<Packet>(lens_header_bytes);
    write_packet_header(header, zoom, *packet);
    encode_jpeg(image, header.quality, false, *packet, lens_header_bytes);
    return packet;
  };
  encode(visitor, header.quality, 0, std::move(make));
}

void encode_parts(Visitor& visitor, const View& view, const PacketHeader& header,
                  const PartsOrder& order) {
  encode(visitor, header.quality, 0, [header, view, order](Encoder& encoder) {
    auto packet = std::make_shared<Packet>();
    make_parts(encoder.image, order, header, encoder.has, *packet);
    add_sway(std::exchange(encoder.sway, {}), view, *packet);
    if (!encoder.has.pending) encoder.image = Image8{};
    return packet;
  });
}

// Returns the side in whole JPEG blocks.
uint16_t side_of(int side, int eighths) {
  return uint16_t(eighths == 8 ? side : std::max(side * eighths / 64 * 8, std::min(side, 16)));
}

// Notes how much later pictures are dated than the time that their pose was made for: the mouth is
// posed for that moment.
void note_lead(ShowDrawing& drawing, uint64_t posed_us, uint64_t picture_us) {
  if (picture_us >= posed_us)
    drawing.picture_lead +=
        (std::min(1e-6f * float(picture_us - posed_us), 0.25f) - drawing.picture_lead) * 0.1f;
}

// Returns whether the browser has a picture of this view, and takes what is new in it.
bool takes_parts(double time, const Visitor& visitor, const View& view) {
  const Image8& has = visitor.shown.encoder->has.image;
  return visitor.wants.parts && stands(time, visitor) && view == visitor.shown.view &&
         (visitor.shown.has_still || !visitor.wants.local) && !visitor.shown.lost &&
         has.width == view.width && has.height == view.height && !has.rgb.empty();
}

// Returns the JPEG quality of pictures at rest: they are looked at for long, few a second, and yet
// in the way of what comes next.
int quality_at_rest(const Show& show, const Visitor& visitor, const PicturePlan& plan,
                    double pixels, bool fine) {
  const int wanted = visitor.wants.still_quality;
  const int best = fine ? wanted : std::min(wanted, plan.quality + animated_gain);
  const Flow& flow = visitor.shown.flow;
  return quality_within(flow, usable_bytes(flow), pixels, best, fine);
}

PacketHeader next_header(double time, Visitor& visitor, uint32_t seq, bool still) {
  PacketHeader header;
  header.frame = ++visitor.shown.frame_number;
  header.seq = seq;
  header.time_us = microseconds_now();
  header.flags = uint8_t(packet_complete | (still ? packet_still : 0));
  visitor.shown.encoder->frame = header.frame;
  note_sent(visitor.shown.flow, header.frame, time);
  return header;
}

// Returns what a display that reprojects needs to know of a keyframe.
KeyframeHeader keyframe_header(const ExhibitStage& stage, const View& view, uint32_t cuts) {
  return {.cuts = cuts,
          .width = uint16_t(view.width),
          .height = uint16_t(view.height),
          .eye = stage.exhibit.scene.origin + dvec3(view.position),
          .right = view.right,
          .up = view.up,
          .forward = view.forward,
          .tan_half_fov = view.tan_half_fov,
          .middle = view.middle,
          .unit = disparity_unit(view)};
}

// Notes the cost of a warped picture or a keyframe that has been encoded: the search for a seat
// needs it.
void note_cost(Capacity& capacity, Visitor& visitor) {
  Encoder& encoder = *visitor.shown.encoder;
  const double warping = std::exchange(visitor.shown.warp_core_seconds, 0.0);
  if (visitor.wants.local && encoder.pixels > 0)
    capacity.note_sent(encoder.pixels, encoder.processor_seconds);
  if (warping <= 0) return;
  capacity.note_shown(double(visitor.shown.view.width) * visitor.shown.view.height,
                      warping + encoder.processor_seconds);
}

// Notes the last picture, once its encoder has finished.
void note_encoded(ShowTotals& totals, Capacity& capacity, Visitor& visitor) {
  Encoder& encoder = *visitor.shown.encoder;
  if (std::exchange(encoder.unsent, false)) note_unsent(visitor.shown.flow, encoder.frame);
  if (encoder.bytes == 0) return;
  note_cost(capacity, visitor);
  const size_t bytes = std::exchange(encoder.bytes, 0);
  totals.picture_bytes += bytes;
  if (encoder.pixels > 0) {
    smooth(visitor.times.encode, encoder.milliseconds);
    note_encoded(visitor.shown.flow, bytes, encoder.pixels, encoder.quality, encoder.full_chroma);
  } else {
    totals.pictures++;
  }
}

void send_complete(Show& show, Visitor& visitor, const View& view, PacketHeader header) {
  if (visitor.wall.role == WallRole::camera) {
    for (Visitor* tile : cut_into_tiles(visitor, view, header.frame, show.time)) {
      note_encoded(show.totals, *show.visits.capacity, *tile);
      send_complete(show, *tile, tile->shown.view, header);
    }
    return;
  }
  PicturePlan plan = picture_plan(show.settings, visitor);
  const bool still = header.flags & packet_still;
  const bool fine = still && !sees_motion(show, visitor, view);
  const double pixels = counted_pixels(double(view.width) * view.height, plan.eighths);
  if (still) plan.quality = quality_at_rest(show, visitor, plan, pixels, fine);
  header.width = side_of(view.width, plan.eighths);
  header.height = side_of(view.height, plan.eighths);
  header.quality = uint8_t(plan.quality);
  std::optional<KeyframeHeader> keyframe;
  if (visitor.wants.local) {
    keyframe = keyframe_header(show.stage, view, visitor.picture->job.camera_cuts);
    header.flags |= packet_depth;
    visitor.shown.encoder->disparity = visitor.picture->keyframe.disparity;
  }
  encode_complete(show.time, visitor, view, header, fine, plan.eighths, keyframe);
  visitor.shown.lost = false;
  show.totals.pictures++;
}

// Sends parts; must: even if nothing has changed.
void send_parts(Show& show, Visitor& visitor, const View& view, PacketHeader header, bool must) {
  VisitorDelivery& shown = visitor.shown;
  const FlowWishes wishes = flow_wishes(show.settings, visitor);
  PartsOrder order;
  const bool moves = sees_motion(show, visitor, view);
  order.fine_quality =
      visitor.wants.saver ? 0 : std::min(near_lossless, visitor.wants.still_quality);
  order.quality = std::min(picture_plan(show.settings, visitor).quality + animated_gain,
                           visitor.wants.still_quality);
  order.quiet = asks_for_samples(show, visitor) ? quiet_in_samples : quiet;
  order.now = show.time;
  order.bytes = std::min(usable_bytes(shown.flow), most_part_bytes);
  if (!moves)
    order.bytes = std::min(order.bytes, usable_rate(shown.flow, wishes) * refine_interval);
  order.bytes_per_pixel = double(shown.flow.bytes_per_pixel);
  order.must = must;
  header.width = uint16_t(view.width);
  header.height = uint16_t(view.height);
  encode_parts(visitor, view, header, order);
  const double seconds = order.bytes / usable_rate(shown.flow, wishes);
  shown.refine_at = show.time + std::max(seconds, refine_interval);
}

void send(Show& show, Visitor& visitor, const View& view, uint32_t seq, bool still) {
  VisitorDelivery& shown = visitor.shown;
  const PacketHeader header = next_header(show.time, visitor, seq, still);
  note_lead(*show.drawing, visitor.picture->job.time_us, header.time_us);
  if (takes_parts(show.time, visitor, view))
    send_parts(show, visitor, view, header, seq != shown.seq);
  else send_complete(show, visitor, view, header), shown.has_still = still;
  if (shown.sent_at > 0 && show.time > shown.sent_at)
    smooth(shown.measured_fps, float(1 / (show.time - shown.sent_at)));
  shown.sent_at = show.time;
  // If ticks come a little late, pictures keep their rate all the same.
  double period = 1 / picture_rate(show, visitor);
  shown.pictured_at = std::clamp(shown.pictured_at + period, show.time - 0.5 * period, show.time);
  shown.seq = seq;
  shown.view = view;
  visitor.picture->unshown = false;
}

// Sends the tiles of the last picture that the browser lacks or has less fine, or the news that
// nothing is new after an input: while there is no newer picture to show.
void refine(Show& show, Visitor& visitor) {
  VisitorDelivery& shown = visitor.shown;
  const Encoder& encoder = *shown.encoder;
  const bool must = visitor.place.seq != shown.seq;
  if (show.time < shown.refine_at || encoder.task.busy() || encoder.image.rgb.empty()) return;
  if (!must && !encoder.has.pending) return;
  if (!takes_parts(show.time, visitor, visitor.place.last_view)) return;
  const PacketHeader header = next_header(show.time, visitor, visitor.place.seq, true);
  send_parts(show, visitor, shown.view, header, must);
  shown.seq = visitor.place.seq;
}

bool is_later(uint32_t seq, uint32_t than) { return int32_t(seq - than) >= 0; }

// Warps the newest keyframe to `view`, into the encoder's image.
bool warp(ShowDrawing& drawing, ShowTotals& totals, Visitor& visitor, const View& view) {
  const double began = seconds_now(), cores_began = process_seconds_now();
  const VisitorPicture& picture = *visitor.picture;
  float unknown = warp_picture(picture.keyframe, picture.around.keyframe, view, most_unknown,
                               drawing.warp, visitor.shown.encoder->image);
  visitor.shown.warp_core_seconds = process_seconds_now() - cores_began;
  smooth(visitor.times.warp, float(1000 * (seconds_now() - began)));
  if (unknown > most_unknown) {
    totals.unwarpable++;
    return false;
  }
  totals.warped++;
  return true;
}

}  // namespace

void note_deliveries(Show& show, Visitor& visitor) {
  VisitorDelivery& shown = visitor.shown;
  if (!shown.encoder->task.busy()) note_encoded(show.totals, *show.visits.capacity, visitor);
  for (const Delivery& delivery : visitor.link->take_deliveries())
    note_delivery(shown.flow, delivery);
  update(shown.way, shown.flow, flow_wishes(show.settings, visitor), visitor.times.encode,
         show.time);
}

// Sends the surroundings between keyframes; they say nothing new of the visitor's input.
static void send_surroundings(const ExhibitStage& stage, const ShowSettings& settings, double time,
                              Visitor& visitor) {
  const Surroundings& around = visitor.picture->around;
  const View& view = around.keyframe.view;
  if (around.keyframe.empty()) return;
  Image8 image;
  copy_colors(around.keyframe, {0, 0, view.width, view.height}, image);
  PacketHeader header = next_header(time, visitor, visitor.shown.seq, false);
  header.width = uint16_t(view.width), header.height = uint16_t(view.height);
  header.quality = uint8_t(picture_plan(settings, visitor).quality);
  header.flags |= packet_depth | packet_around;
  encode_beside(visitor, header, keyframe_header(stage, view, around.camera_cuts),
                std::move(image.rgb), around.keyframe.disparity);
}

// Returns whether a layer is next: it comes before the keyframe that is without it, and in turns
// with what is new of that keyframe.
static bool takes_layer(const VisitorPicture& picture, const VisitorDelivery& shown) {
  const bool needs_none = !picture.backdrop && shown.has_layer && picture.unshown;
  return needs_none || (picture.layer_unsent && !(picture.unshown && shown.sent_layer));
}

static void send_layer(Show& show, Visitor& visitor) {
  VisitorPicture& picture = *visitor.picture;
  MovingLayer layer;
  if (std::exchange(picture.layer_unsent, false)) layer = std::move(picture.moving.layer);
  visitor.shown.has_layer = !layer.window.empty();
  if (layer.window.empty()) {
    constexpr int side = 8;  // nothing moves any more
    layer = {
        {0, 0, side, side}, std::vector<uint8_t>(3 * side * side), std::vector<float>(side * side)};
  }
  const View view = window_view(picture.keyframe.view, layer.window);
  PacketHeader header = next_header(show.time, visitor, visitor.shown.seq, true);
  header.width = uint16_t(view.width), header.height = uint16_t(view.height);
  header.quality = uint8_t(quality_at_rest(show, visitor, picture_plan(show.settings, visitor),
                                           double(view.width) * view.height, false));
  header.flags |= packet_depth | packet_layer;
  note_lead(*show.drawing, picture.job.time_us, header.time_us);
  encode_beside(visitor, header, keyframe_header(show.stage, view, picture.job.camera_cuts),
                std::move(layer.rgb), std::move(layer.disparity));
}

// A glass that was put down has nothing to show any more.
static bool has_lens_to_show(const Visitor& visitor) {
  return visitor.picture->lens.unsent && visitor.lens.at;
}

// Sends what the glass shows; it takes turns with pictures.
static void send_lens(Show& show, Visitor& visitor) {
  LensPicture& lens = visitor.picture->lens;
  lens.unsent = false;
  PacketHeader header = next_header(show.time, visitor, lens.order.seq, false);
  header.width = uint16_t(lens.picture.width), header.height = uint16_t(lens.picture.height);
  header.quality = uint8_t(quality_at_rest(show, visitor, picture_plan(show.settings, visitor),
                                           double(header.width) * header.height, false));
  header.flags |= packet_lens;
  visitor.shown.sent_lens = true;
  encode_lens(visitor, header, lens);
}

// Sends the newest keyframe as it is, or its news if the page has it: the page shows it from where
// its visitor is by then.
static void present_keyframe(Show& show, Visitor& visitor) {
  VisitorPicture& picture = *visitor.picture;
  picture.fade = {};  // the page passes from one picture to the next
  const bool stays = is_still(picture.job) && !picture.keyframe.empty();
  visitor.shown.sent_layer = stays && takes_layer(picture, visitor.shown);
  if (visitor.shown.sent_layer) return send_layer(show, visitor);
  if (!picture.unshown && std::exchange(picture.around.unsent, false))
    return send_surroundings(show.stage, show.settings, show.time, visitor);
  if (!picture.unshown) return refine(show, visitor);
  if (show.drawing->renderer.posed == visitor.link->id) return;
  const PictureJob& job = picture.job;
  const View& view = job.view;
  copy_colors(picture.keyframe, {0, 0, view.width, view.height}, visitor.shown.encoder->image);
  if (!picture.moving.empty()) lay_over(picture.moving, visitor.shown.encoder->image);
  visitor.shown.encoder->sway =
      picture.moving.empty() ? picture.keyframe.sway : picture.moving.sway;
  const bool stood = is_still(job) && view == visitor.place.last_view;
  visitor.shown.has_layer &= is_still(job);
  send(show, visitor, view, stood ? visitor.place.seq : job.seq, is_still(job));
}

void present(Show& show, Visitor& visitor) {
  VisitorPicture& picture = *visitor.picture;
  VisitorDelivery& shown = visitor.shown;
  const PictureJob& job = picture.job;
  if (job.camera_cuts != visitor.place.camera_cuts || picture.drawn_at < 0) return;
  // The tick does not wait for a picture that is still being encoded: others would wait, too.
  if (!may_take(show.time, visitor) || shown.encoder->task.busy()) return;
  const View view = visitor.place.last_view;
  bool stood = is_still(job) && job.view == view;
  if (has_lens_to_show(visitor) && !picture.at_work && !(picture.unshown && shown.sent_lens)) {
    note_encoded(show.totals, *show.visits.capacity, visitor);
    return send_lens(show, visitor);
  }
  shown.sent_lens = false;
  if (shown.lost && (stood || visitor.wants.local)) picture.unshown = true;
  if (visitor.wants.local) {
    note_encoded(show.totals, *show.visits.capacity, visitor);
    return present_keyframe(show, visitor);
  }
  bool fades = !picture.fade.from.rgb.empty() && show.time - shown.sent_at >= 1 / fade_rate;
  if (!picture.unshown && !fades && view == shown.view) {
    refine(show, visitor);
    return;
  }
  const bool waits_for_keyframe = shown.pictured_at > show.time;
  if (waits_for_keyframe && !picture.unshown) return;
  if (!stood && !waits_for_keyframe &&
      show.time - shown.pictured_at < 1 / picture_rate(show, visitor) - early)
    return;

  Encoder& encoder = *shown.encoder;
  note_encoded(show.totals, *show.visits.capacity, visitor);
  const float newer = fade_share(picture.fade, view, show.time);
  if ((picture.unshown || fades) && job.view == view) {  // drawn for this very view
    copy_colors(picture.keyframe, {0, 0, view.width, view.height}, encoder.image);
    if (newer < 1) mix_fade(picture.fade, newer, encoder.image);
    else picture.fade = {};
    if (!picture.moving.empty()) lay_over(picture.moving, encoder.image);
    send(show, visitor, view, visitor.place.seq, is_still(job) && newer == 1);
    return;
  }
  picture.fade = {};
  // the renderer reads the keyframe, and has soon done so
  if (show.drawing->renderer.posed == visitor.link->id) return;
  merge_moving(picture);
  if (warp(*show.drawing, show.totals, visitor, view)) {
    send(show, visitor, view, visitor.place.seq, false);
  } else if (picture.unshown && is_later(job.seq, shown.seq) &&
             warp(*show.drawing, show.totals, visitor, job.expected)) {
    send(show, visitor, job.expected, job.seq,
         false);  // shows what can be shown of so quick a turn
  } else {
    shown.pictured_at = show.time + tried_again;
    picture.unshown = false;
  }
}

void present_all(Show& show) {
  std::vector<Visitor*> all;
  for (Visitor& visitor : show.visits.visitors)
    if (is_shown(visitor)) all.push_back(&visitor);
  std::ranges::stable_sort(all, {}, [](const Visitor* one) { return one->shown.pictured_at; });
  const double began = seconds_now();
  for (Visitor* visitor : all) {
    present(show, *visitor);
    if (seconds_now() - began > presenting) return;  // the others with the next tick
  }
}

bool has_to_show(const Show& show, const Visitor& visitor) {
  const VisitorPicture& picture = *visitor.picture;
  return is_shown(visitor) &&
         (picture.unshown || picture.layer_unsent || has_lens_to_show(visitor) ||
          !picture.fade.from.rgb.empty() ||
          (visitor.place.last_view != visitor.shown.view && !visitor.wants.local));
}

}  // namespace wellspring::show
