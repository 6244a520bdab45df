// SPDX-License-Identifier: Apache-2.0
// Holds one browser's visit, in parts; each folder of the show works on one of them.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/clock.h"
#include "base/worker.h"
#include "frame/tonemap.h"
#include "image/image.h"
#include "picture/sway_image.h"
#include "show/kiosk/kiosk.h"
#include "show/state/capacity.h"
#include "show/state/cast.h"
#include "show/exhibit/pieces/piece_choices.h"
#include "show/state/switches.h"
#include "show/state/visitor_attention.h"
#include "show/visit/flow.h"
#include "show/visit/place.h"
#include "show/wall/wall.h"
#include "wire/link.h"
#include "wire/messages.h"
#include "world/view.h"

namespace wellspring::show {

// Holds what a browser that takes parts has on its screen while its visitor stands
// (show/draw/parts.h).

struct BrowserPicture {
  Image8 image;                  // picture before it was encoded; empty: the next one is complete
  std::vector<uint8_t> quality;  // JPEG quality of each tile; 0: the tile is not there in full size
  std::vector<double> changed_at;  // seconds when the content of each tile last changed
  size_t next = 0, next_fine = 0;  // tiles at which the next parts begin
  bool pending = false;  // whether some tiles could be finer, or are not quite what was drawn last
};

// Holds what a visitor has ordered and what is not carried out yet (show/answer/orders.h).

struct WaitingOrder {
  BrowserMessage message;
  bool late = false;  // it waits since an earlier tick
};

struct VisitorOrders {
  std::vector<WaitingOrder> waiting;                                 // oldest first
  std::array<RateBound, std::variant_size_v<BrowserMessage>> spent;  // one for each kind of message
};

// Holds milliseconds of the last picture's stages, smoothed: for the status page and the budget.
struct StageTimes {
  float display = 0, light = 0, trace = 0, drawing = 0, tonemap = 0, warp = 0, encode = 0;
  float moving = 0;    // drawing moving things over a picture at rest
  float whole = 0;     // from a picture's order until it can be shown
  float interval = 0;  // from one picture drawn to the next, while the visitor moves
};

inline void smooth(float& value, float sample, float share = 0.1f) {
  value += (sample - value) * share;
}

// Makes the JPEG while the next tick begins.
struct Encoder {
  Image8 image;
  std::vector<float> disparity;  // a keyframe's, until it is encoded
  SwayImage sway;                // likewise, or that of new parts; empty: nothing sways
  BrowserPicture has;            // screen of a browser that takes parts
  uint32_t frame = 0;            // number of the last picture
  bool unsent = false;           // nothing had changed: no picture was sent
  // pixels of the last picture, as they count for bytes; 0: parts, which say nothing of others
  double pixels = 0;
  int quality = 0;
  bool full_chroma = false;
  float milliseconds = 0;
  double processor_seconds = 0;
  size_t bytes = 0;
  size_t memory_bytes = 0;  // bytes of all this and of what it makes, when it last ended
  Worker task;              // the last member: a picture may be half made
};

// Holds what the visitor was sent, and how well line and browser take it (show/draw/present.h).
struct VisitorDelivery {
  std::unique_ptr<Encoder> encoder = std::make_unique<Encoder>();
  uint32_t frame_number = 0;     // number of the last picture; 0: none yet
  uint32_t seq = 0;              // input that it showed
  View view;                     // view that it showed
  double sent_at = -1e9;         // show time when it was sent
  double pictured_at = -1e9;     // show time when it was due
  double warp_core_seconds = 0;  // core-seconds for warping the last; 0: it was drawn for its view
  bool lost = false;             // the browser lacks what it was sent
  // its keyframe shows a picture at rest, and parts of such pictures fit it
  bool has_still = false;
  bool has_layer = false;   // moving things were laid over the keyframe (packet_layer)
  bool sent_layer = false;  // a layer was the last to be sent
  bool sent_lens = false;   // a picture of the glass was the last to be sent
  double refine_at = -1e9;  // show time when more of a picture at rest may be sent
  Flow flow;
  GiveWay way;
  float measured_fps = 0;
};

// Holds a group's visit (show/answer/groups.h).
struct VisitorGroup {
  std::string leads, follows;  // code of the group; empty: none
  bool away = false;           // the visitor has walked off by themselves
  vec2 look{0};                // yaw and pitch from where the leader looks
  double looked_at = -1e9;     // show time of the last turn
};

// Holds whether anybody is there (show/answer/idle.h). Times are in seconds.
struct VisitorPresence {
  Hello hello;         // message by which the visit began, or went on
  double quiet = 0;    // since the visitor did anything
  double hidden = -1;  // since the page was hidden; below 0: it is seen
  bool asked = false;  // the visitor was asked whether they are there
};

// Holds what the visitor's page asks for.
struct PictureWishes {
  int width = 1280, height = 720;
  float fps = 0;                              // 0: the show's
  double bandwidth = 0;                       // bytes a second for pictures; 0: no limit
  bool saver = false;                         // nothing is sent that can be done without
  bool parts = false;                         // it takes pictures at rest in parts, packet.h
  bool local = false;                         // it takes keyframes with depth, packet.h
  int best_quality = 82, still_quality = 92;  // JPEG quality in motion and at rest
  bool attention = true;                      // CacheSettings::attention
  // Weight for attention (attention/task.h): 0 what catches the eye, 1 what the visitor looks
  // at.
  float task_weight = 0.5f;
};

// Says how the visitor's view shows lawns, and where the visitor has walked.
struct VisitorLawns {
  bool seen = false;          // some may be in view
  bool sways = false;         // likewise, and blades or their light move
  std::optional<vec3> ankle;  // its place at the last step (show/state/visitor_world.h)
};

struct VisitorPicture;  // show/state/visitor_picture.h

struct Visitor {
  Visitor();
  ~Visitor();

  std::shared_ptr<Link> link;
  std::unique_ptr<Seat> seat;  // share of the machine's capacity; null: not counted
  VisitorPresence presence;
  bool welcomed = false, left = false;
  double came_at = 0;  // show time
  bool kiosk = false;
  std::string lang = "en";
  std::string name;  // name of a kiosk, as its page says it; may be empty
  std::string id;    // id of the visit, over all its links; empty: none yet
  std::string
      told;  // last record of the visit that its page was sent to keep (show/answer/come_back.h)
  double told_at = -1e9;        // show time when it was sent
  KioskTouch screen;            // a kiosk's screen; touched: since the last step of the kiosk
  int64_t loaded_night = 0;     // HouseState::night when a kiosk's page was loaded
  double state_sent_at = -1e9;  // show time of the last state message
  VisitorSound hearing;         // show/answer/sound.h
  std::unique_ptr<Teller> own_teller;  // since the visitor called it; null: the house's
  VisitorLamps lamps;
  VisitorPieces pieces;
  double lens_at = -1e9;    // show time of the last order of the glass
  LensOrder lens;           // its last order; without `at` the visitor holds no glass (show/lens)
  DynamicLights dynamic;    // lights that move or change, as they are now
  std::vector<Play> plays;  // the visitor's own, for each animation; empty: none was touched
  VisitorGroup group;
  VisitorWall wall;
  VisitorOrders orders;
  VisitorPlace place;  // show/visit
  VisitorLawns lawns;
  WindowEye window;  // eye before a kiosk's screen
  HeldObject held;   // shown on a kiosk's page; Kiosk::held
  PictureWishes wants;
  VisitorAttention looks;                   // show/draw/steer.h
  std::unique_ptr<VisitorPicture> picture;  // show/draw; never null
  VisitorDelivery shown;                    // show/draw/present.h
  StageTimes times;
  int counted_tour = -1;  // tour that is counted as begun; -1: none (show/count)
  View posed;             // view that the page was sent (pose_message())
  double posed_at = -1e9;
};

// Returns whether pictures are drawn for the visitor: it has said hello, its page is not hidden,
// and it is no tile of a wall, which gets parts of the wall's.
inline bool is_shown(const Visitor& visitor) {
  return visitor.welcomed && visitor.presence.hidden < 0 && visitor.wall.role != WallRole::tile;
}
// Returns whether it is a part of a wall, and nobody's visit.
inline bool is_of_wall(const Visitor& visitor) {
  return visitor.wall.role == WallRole::tile || visitor.wall.role == WallRole::camera;
}

// Returns all memory, in bytes, that pictures of one visitor take between them; its encoder's as
// noted there, the rest as it is: not while the renderer is at work on it. It is bounded by the
// picture's size: at most 64 MB (of 10^6 bytes) at 1280x720 while the visitor walks, 64 MiB at
// rest.
size_t picture_memory(const Visitor& visitor);

}  // namespace wellspring::show
