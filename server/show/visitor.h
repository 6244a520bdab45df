// SPDX-License-Identifier: Apache-2.0
// One browser's visit: where it stands, what it has asked for, and the picture being made for it.
#pragma once
#include <memory>
#include <oneapi/tbb/task_group.h>
#include <string>
#include <vector>

#include "cache/broker.h"
#include "cache/cache.h"
#include "frame/tonemap.h"
#include "show/display_path.h"
#include "show/flow.h"
#include "show/sound.h"
#include "show/tour.h"
#include "wire/link.h"
#include "wire/messages.h"
#include "world/view.h"

namespace wellspring {

// Milliseconds of the last picture's stages, smoothed: for the status page and the budget.
struct StageTimes {
  float display = 0, light = 0, trace = 0, look = 0, drawing = 0, tonemap = 0, encode = 0;
};

// The JPEG made on another core while the next tick begins.
struct Encoder {
  ~Encoder() { task.wait(); }  // a picture may be half made
  oneapi::tbb::task_group task;
  Image8 image;
  std::vector<uint8_t> jpeg;
  float milliseconds = 0;
  size_t bytes = 0;
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
  int viewpoint = 0;  // index of the named viewpoint last jumped to, while the visitor stays there; else -1
  TourRide tour;
  // Picture.
  int width = 1280, height = 720;
  float fps = 0;  // wanted; 0: the show's
  int best_quality = 82, still_quality = 92;
  RenderCache cache;
  std::unique_ptr<Encoder> encoder = std::make_unique<Encoder>();
  Frame frame;
  Image8 shown;  // drawn for the eye at once, while the picture before is encoded
  Broker broker;             // what is traced after its picture, for the next
  double broker_seconds = 0;  // of all cores, for what it was last asked
  std::vector<Request> requests, ahead;
  std::vector<Sample> samples;
  std::vector<Ray> looks;
  std::vector<Seen> seen;
  uint32_t frame_number = 0;
  View last_view;
  struct PastView {
    double time = 0;
    View view;
  };
  std::vector<PastView> past;  // of the last pictures: where the visitor is heading
  double moved_at = 0;       // show time of the last change of view
  double pictured_at = -1e9;  // show time of the last picture
  Flow flow;
  StageTimes times;
  int budget = 0;        // samples of the last tick
  DisplayPlan display;   // of the last picture
  double state_sent_at = -1e9;
  float measured_fps = 0;
};


// Moves a visitor by `dt`: tour, or walking by its own input, not too near to the `person` who stands there.
void move_visitor(Visitor& visitor, const World& world, const Exhibit& exhibit, const TourRoads& roads,
                  const std::optional<dvec3>& person, float dt, TourStep& tour_step);
void go_to_viewpoint(Visitor& visitor, const Exhibit& exhibit, int viewpoint);

}  // namespace wellspring
