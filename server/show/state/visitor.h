// SPDX-License-Identifier: Apache-2.0
// One browser's visit: where it stands, what it has asked for, and the picture being made for it.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "base/worker.h"
#include "cache/broker.h"
#include "cache/cache.h"
#include "frame/tonemap.h"
#include "picture/keyframe.h"
#include "show/state/fade.h"
#include "show/state/reconstruction.h"
#include "show/state/renderer.h"
#include "show/storyteller/sounding.h"
#include "show/visit/flow.h"
#include "show/visit/heading.h"
#include "show/visit/tour.h"
#include "wire/link.h"
#include "wire/messages.h"
#include "world/view.h"

namespace wellspring {

// Milliseconds of the last picture's stages, smoothed: for the status page and the budget.
struct StageTimes {
  float display = 0, light = 0, trace = 0, drawing = 0, tonemap = 0, warp = 0, encode = 0;
  float moving = 0;    // what moves in a picture at rest
  float whole = 0;     // from a picture's order until it can be shown
  float interval = 0;  // from one picture drawn to the next, while the visitor moves
};

inline void smooth(float& value, float sample, float share = 0.1f) {
  value += (sample - value) * share;
}

// The JPEG made while the next tick begins.
struct Encoder {
  Image8 image;
  float milliseconds = 0;
  size_t bytes = 0;
  size_t memory_bytes = 0;  // of it and of what it makes, when it last ended
  Worker task;  // the last member: a picture may be half made
};

struct Visitor {
  std::shared_ptr<Link> link;
  bool welcomed = false, left = false;
  bool kiosk = false;
  std::string lang = "en", name;
  // Sound of the utterance that is being sent.
  bool sound = true;           // wants to hear
  uint32_t utterance = 0;      // 0: none
  uint32_t given_up = 0;       // the utterance that was too much for its connection
  size_t samples_sent = 0;
  Narration narration;         // of the tour
  // Place.
  Viewpoint view;
  vec3 move{0};      // as last asked for: right, up, forward
  vec3 velocity{0};  // what the visitor does: follows `move` smoothly
  uint32_t seq = 0;  // of the last input, camera or viewpoint message
  int viewpoint =
      0;  // index of the named viewpoint last jumped to, while the visitor stays there; else -1
  TourRide tour;
  // Picture.
  int width = 1280, height = 720;
  float fps = 0;  // wanted; 0: the show's
  int best_quality = 82, still_quality = 92;
  bool attention = true;  // CacheSettings::attention
  // The easel's (show/state/renderer.h) while a picture of this visitor is drawn or its samples are traced.
  bool at_work = false;
  std::vector<char> lamps;    // whose light its cache knows: see show/state/lamps.h
  RenderCache cache;
  Compositor compositor;
  Broker broker;              // what is traced after its picture, for the next
  PictureCosts costs;
  // What was drawn last, and for what.
  CacheStats stats;
  size_t cache_bytes = 0, memory_bytes = 0;  // of its cache; of all that is kept for its pictures
  double broker_seconds = 0;  // of all cores, for what was last asked
  Image8 picture;             // until it is shown
  Keyframe keyframe;          // what pictures are warped from until the next
  // Of a quick turn what lies around that, in fewer pixels; empty: nothing.
  Keyframe around;
  double around_at = -1e9;    // show time of its order
  uint32_t around_leaps = 0;  // of the visitor, by then
  bool surrounded = false;    // since the last picture was drawn
  RestState rest;
  Fade fade;                  // to the keyframe
  bool backdrop = false;      // the keyframe is without what moves (show/draw/moving.h)
  MovingPicture moving;       // that, to be laid over it; empty: nothing
  double posed_at = -1e9;     // show time of its order
  PictureOrder order;
  bool unshown = false;       // nothing of it has been sent yet
  double drawn_at = -1e9;     // show time of the order of the last
  // What is shown.
  std::unique_ptr<Encoder> encoder = std::make_unique<Encoder>();
  uint32_t frame_number = 0, shown_seq = 0;
  View last_view;   // of the last tick
  View shown_view;  // of the last picture
  uint32_t leaps = 0;  // to other places, so that nothing seen before helps
  Heading heading;
  double moved_at = 0;       // show time of the last change of view
  double sent_at = -1e9;      // show time of the last picture
  double pictured_at = -1e9;  // when it was due
  Flow flow;
  StageTimes times;
  double state_sent_at = -1e9;
  float measured_fps = 0, drawn_fps = 0;
};

// All memory that pictures of one visitor take, between them; its encoder's as noted there, the
// rest as it is: not while the easel is at work on it. Bounded by the picture's size: at most 64 MB
// (of 10^6 bytes) at 1280x720 while the visitor walks, 64 MiB at rest.
size_t picture_memory(const Visitor& visitor);
// Moves a visitor by `dt`: tour, or walking by its own input, not too near to the `person` who
// stands there.
void move_visitor(Visitor& visitor, const World& world, const Exhibit& exhibit,
                  const TourRoads& roads, const std::optional<dvec3>& person, float dt,
                  TourStep& tour_step);
// There is then nothing left to be seen of where the visitor was.
void go_to_viewpoint(Visitor& visitor, const Exhibit& exhibit, int viewpoint);

}  // namespace wellspring
