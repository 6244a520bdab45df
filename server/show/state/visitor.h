// SPDX-License-Identifier: Apache-2.0
// One browser's visit, in parts, each of which is what one room of the show works on.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "avatar/mind/storyteller.h"
#include "base/clock.h"
#include "base/worker.h"
#include "frame/jpeg.h"
#include "frame/tonemap.h"
#include "show/kiosk/kiosk.h"
#include "show/moving/exhibit_scene.h"
#include "show/state/capacity.h"
#include "show/state/switches.h"
#include "show/state/visitor_attention.h"
#include "show/state/visitor_picture.h"
#include "show/storyteller/held_prop.h"
#include "show/storyteller/voice.h"
#include "show/visit/flow.h"
#include "show/visit/place.h"
#include "wire/link.h"
#include "wire/messages.h"
#include "world/view.h"

namespace wellspring::show {

// A storyteller as those see her who share her: who of the exhibit's it is, how she is, what she
// says. The house has one, for kiosks and for visitors who only look on. A visitor who calls her,
// hides her or asks for a story gets one of their own, so that nobody takes her from anybody. Of
// all of them there is one figure in the world, which is posed before each picture as its visitor's
// own teller is.

struct Teller {
  uint64_t number = 0;  // Link::id of the visitor who called her first; 0: the house's
  size_t index = 0;     // of Exhibit::storytellers
  Storyteller storyteller;
  StorytellerState mind;
  Pose pose;
  Voice voice;
  Sounding sounding;
  HeldProp held;
  bool visible = true, humanlike = true;
  double agent_sent_at = -1e9;  // show time of the last agent message
  Mood agent_mood = Mood::idle;
};

// What a browser that takes parts has on its screen, while its visitor stands
// (show/draw/parts.h).

struct BrowserPicture {
  Image8 image;                    // before it was encoded; empty: the next one is complete
  std::vector<uint8_t> quality;    // JPEG's, of each tile; 0: it is not there in full size
  std::vector<double> changed_at;  // seconds, of each tile: when its content last did
  size_t next = 0, next_fine = 0;  // tiles at which the next parts begin
  bool pending = false;  // some tiles could be finer, or are not quite what was drawn last
};

// What a visitor has ordered and what is not carried out yet (show/answer/orders.h).

struct WaitingOrder {
  BrowserMessage message;
  bool late = false;  // since an earlier tick
};

struct VisitorOrders {
  std::vector<WaitingOrder> waiting;                                 // oldest first
  std::array<RateBound, std::variant_size_v<BrowserMessage>> spent;  // of each kind
};

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
  std::vector<float> disparity;  // of a keyframe, until it is encoded
  BrowserPicture has;            // of a browser that takes parts
  uint32_t frame = 0;            // of the last picture
  bool unsent = false;           // nothing had changed: it was none
  double pixels = 0;  // of it, as they count for bytes; 0: of parts, which tell nothing of others
  int quality = 0;
  bool full_chroma = false;
  float milliseconds = 0;
  double processor_seconds = 0;
  size_t bytes = 0;
  size_t memory_bytes = 0;  // of all this and of what it makes, when it last ended
  Worker task;              // the last member: a picture may be half made
};

// What the visitor was sent, and how it goes down (show/draw/present.h).
struct VisitorDelivery {
  std::unique_ptr<Encoder> encoder = std::make_unique<Encoder>();
  uint32_t frame_number = 0;     // of the last picture; 0: none yet
  uint32_t seq = 0;              // that it showed
  View view;                     // that it showed
  double sent_at = -1e9;         // show time of it
  double pictured_at = -1e9;     // when it was due
  double warp_core_seconds = 0;  // for the last; 0: it was drawn for its view
  bool lost = false;             // the browser has not what it was sent
  bool has_still = false;        // its keyframe is of a picture at rest, and parts of such fit it
  bool has_layer = false;        // what moves was laid over it (packet_layer)
  bool sent_layer = false;       // that was the last to be sent
  double refine_at = -1e9;       // when more of a picture at rest may be sent
  Flow flow;
  GiveWay way;
  float measured_fps = 0;
};

// A group's visit (show/answer/groups.h).
struct VisitorGroup {
  std::string leads, follows;  // the group's code; empty: no group
  bool away = false;           // has walked off by themselves
  vec2 look{0};                // yaw and pitch from where the leader looks
  double looked_at = -1e9;     // show time of the last turn
};

// Whether anybody is there (show/answer/idle.h). In seconds.
struct VisitorPresence {
  Hello hello;         // by which the visit began, or went on
  double quiet = 0;    // since anything was done
  double hidden = -1;  // that the page has been so; below 0: it is seen
  bool asked = false;  // whether somebody is still there
};

struct Visitor {
  std::shared_ptr<Link> link;
  std::unique_ptr<Seat> seat;  // of the machine's capacity; null: nobody counts
  VisitorPresence presence;
  bool welcomed = false, left = false;
  double came_at = 0;  // show time
  bool kiosk = false;
  std::string lang = "en";
  std::string name;             // of a kiosk, as its page says it; may be empty
  std::string id;               // of the visit, over all its links; empty: not told yet
  std::string told;             // of the visit, that its page keeps (show/answer/come_back.h)
  double told_at = -1e9;        // show time of that
  KioskTouch screen;            // of a kiosk's; touched: since the last step of the kiosk
  int64_t loaded_night = 0;     // of a kiosk's: HouseState::night when its page was loaded
  double state_sent_at = -1e9;  // show time of the last state message
  VisitorSound hearing;         // show/answer/sound.h
  std::unique_ptr<Teller> own_teller;  // since they called her; null: the house's
  VisitorLamps lamps;
  DynamicLights dynamic;    // lights that move or change, as they are now
  std::vector<Play> plays;  // of each animation, their own; empty: they have touched none
  VisitorGroup group;
  VisitorOrders orders;
  VisitorPlace place;  // show/visit
  WindowEye window;    // of a kiosk's page
  PictureWishes wants;
  VisitorAttention looks;  // show/draw/steer.h
  VisitorPicture picture;  // show/draw
  VisitorDelivery shown;   // show/draw/present.h
  StageTimes times;
  int counted_tour = -1;  // show/count
  View posed;             // was told to the page (pose_message())
  double posed_at = -1e9;
};

// Gets pictures: has said hello, and its page is not hidden.
inline bool is_shown(const Visitor& visitor) {
  return visitor.welcomed && visitor.presence.hidden < 0;
}

// All memory that pictures of one visitor take, between them; its encoder's as noted there, the
// rest as it is: not while the renderer is at work on it. Bounded by the picture's size: at most 64
// MB (of 10^6 bytes) at 1280x720 while the visitor walks, 64 MiB at rest.
size_t picture_memory(const Visitor& visitor);

}  // namespace wellspring::show
