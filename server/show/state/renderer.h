// SPDX-License-Identifier: Apache-2.0
// Where pictures are drawn while the show goes on: one thing at a time, as all of them read the
// world and use all cores. Whatever it is at work on belongs to it; the tick looks in
// (show/draw/carry_out.h), takes what is finished, moves the world, which nobody reads then, and
// gives it the next that is decided (show/draw/decide.h; of a quick turn the surroundings first):
//
//   idle --carry_out--> drawing --take_finished--> idle, or, if samples are asked for, --> tracing
//   --> idle
//
// Between the steps of a picture at rest the world may move, and what moves be drawn
// (show/draw/still_pass.h).
#pragma once
#include <atomic>
#include <cstdint>
#include <memory>
#include <oneapi/tbb/task_arena.h>
#include <optional>
#include <string>
#include <vector>

#include "base/worker.h"
#include "cache/broker.h"
#include "denoise/denoise.h"
#include "frame/frame.h"
#include "frame/tonemap.h"
#include "light/dynamic/direct_light.h"
#include "light/dynamic/dynamic_image.h"
#include "light/known/skin_light.h"
#include "picture/compositor.h"
#include "picture/keyframe.h"
#include "picture/still/reconstruct_still.h"
#include "show/state/visitor_attention.h"
#include "world/view.h"

namespace wellspring::show {

// What a picture is to be, decided before it is drawn (show/draw/picture.h).

// What of a visitor's rest, since the view or the light last changed, reconstructions depend on.
struct RestState {
  uint64_t asked = 0;         // samples of the view's sequence (picture/still/reconstruct_still.h)
  double samples = 0;         // a pixel, that are kept
  double passed_samples = 0;  // of these, in the last pass
  double passed_at = -1e9, passed_seconds = 0;  // show time of its end; what it took
  bool reconstructed = false;                   // its picture is the one shown
};

// All that a picture's drawing depends on besides the world and what the visitor's cache remembers.
struct PictureJob {
  double time = 0;  // of the tick that ordered it
  uint64_t time_us = 0, tick = 0;
  View expected;              // what the visitor will see when it is shown
  View view;                  // drawn: that, and some around
  View ahead;                 // in the picture after that, when answers to its requests are shown
  uint32_t seq = 0;           // of the visitor's last input
  uint32_t camera_cuts = 0;   // of the visitor, by then
  bool still = false;         // without motion for a moment
  bool moving = false;        // something that can move may be in it
  bool learns = false;        // its samples are kept for each pixel, for reconstructions
  bool reconstruct = false;   // it becomes a reconstruction instead of being shown
  bool samples_only = false;  // nothing is drawn
  bool settled = false;       // for long: the reference takes over
  bool passing = false;       // drawn for a moment, and some around (picture/compose_drawn.h)
  RestState rest;             // of the visitor, by then
  float scale = 1;            // sides of its view, in pixels, over those of the visitor's picture
  bool attention = true;
  std::shared_ptr<const std::vector<float>> weights;  // of objects; null: all are 1
  bool note_seen = false;                             // for the next of these
  bool keep = false;                                  // as a keyframe, for others to be made of
  uint64_t seed = 0;
  std::optional<View>
      around;  // of a quick turn: what else may be asked for; drawn before, in fewer pixels
  int samples = 0;
  DynamicLights dynamic;  // as they are then
};

// It is drawn in steps, between which the world may move and what moves be drawn.
inline bool in_steps(const PictureJob& job) { return job.still && job.keep; }

// Learned reconstruction of pictures at rest as values: the one that is under way, and what of a
// visitor's rest it depends on. What is done with them: show/draw/still_pass.h.

struct Visitor;

struct StillPass {
  enum class Step : uint8_t { compute, finish, done };
  Visitor* visitor = nullptr;  // whose picture it is; null: none is under way
  PictureJob job;
  bool backdrop = false;  // it is without what moves (show/draw/still_pass.h)
  Step step = Step::compute;
  bool at_work = false;  // the renderer is at it
  std::atomic<bool> given_up{false};
  double seconds = 0;  // of computing, so far
  Frame frame;         // drawn; then as it is shown
  StillReconstruction work;
  Image8 picture;
  Keyframe keyframe;                   // when it is finished the visitor's old one
  std::unique_ptr<Denoiser> denoiser;  // null: there is none
  std::string problem;                 // why
};
size_t memory_bytes(const StillPass& pass);

// Samples a pixel, on average, beyond which more would be kept no more.
inline constexpr double most_rest_samples = 0.98 * most_still_samples;
inline bool has_all_samples(const RestState& rest) { return rest.samples >= most_rest_samples; }

// What it took: milliseconds, and counts.
struct PictureCosts {
  float display = 0, light = 0, trace = 0, drawing = 0, tonemap = 0;
  size_t samples = 0;
  uint64_t asked = 0;        // RestState::asked, after it
  double kept_samples = 0;   // RestState::samples, likewise
  bool late = false;         // its samples are still to be traced
  bool given_up = false;     // there is no picture
  double guide_seconds = 0;  // for what a reconstruction begins with
  bool backdrop = false;     // of what does not move: the rest is to be laid over it
  double seconds = 0;        // from its job on, without others' in between
  double core_seconds = 0;   // of the process, for all but its samples (process_seconds_now())
};

// A picture at rest is drawn in steps, so that what moves in it need not wait for all of them.
enum class DrawingStep : uint8_t { plan, trace, draw, guide, done };

struct Visitor;

// What drawing a picture takes, whoever it is for.
struct DrawingWork {
  std::shared_ptr<CacheWork> cache = make_cache_work();  // of all visitors' caches
  std::shared_ptr<CompositorWork> compositor = std::make_shared<CompositorWork>();  // likewise
  Frame frame;
  std::vector<float> depth;                 // of what is drawn for a moment
  Image8 picture;                           // when it is finished the visitor's old one
  Keyframe keyframe, around;                // likewise
  std::shared_ptr<const SeenPicture> seen;  // of it, for attention; null: not wanted
  std::vector<Request> requests, ahead;
  std::vector<Sample> samples;
  View pass;          // whose pixels all are asked for, where whole passes are filtered
  size_t traced = 0;  // of the requests
  int guided = 0;     // visibility passes done of a reconstruction's guides
  uint64_t pose = 0;  // of the world, when they were made
  DynamicImage dynamic;
  LightPlanes backdrop_light;  // what of it falls on what stands still
  MovingLight moving_light;
  MovingPicture moving;  // when it is finished the visitor's old one
};
size_t memory_bytes(const DrawingWork& work);

// Light on what moves is being found (show/draw/still_pass.h).
struct SkinJob {
  bool at_work = false;
  double time = -1e9;    // show time
  double lit_at = -1e9;  // show time when there were samples
  double interval = 0;   // seconds until it is due again
  uint64_t turn = 0;     // how many there were
  SkinUpdate update;
  std::vector<View> views;  // of those who see it
  int cycles = 1;           // of smoothing
  size_t traced = 0;        // samples
};

struct Renderer {
  DrawingWork work;
  SkinJob skin;
  size_t work_bytes = 0;  // of it, when last finished
  double served = 0;      // least VisitorPicture::served of those who wanted the last picture begun
  double work_seconds = 0;   // what the last thing in hand took
  Visitor* drawn = nullptr;  // the visitor whose picture is being drawn or has just been
  DrawingStep step = DrawingStep::done;  // of that, to be done next
  double until_moving = 1;   // seconds from the step's beginning, until what moves is due
  Visitor* posed = nullptr;  // for whom what moves is being drawn, between two such steps
  double posed_at = 0;       // show time of its job
  uint64_t posed_us = 0;
  DynamicLights posed_lights;  // of that visitor then
  bool posed_layer = false;    // for a page that lays over by itself what moves
  double posed_seconds = 0;    // that it took
  bool surrounds = false;      // only `job.around` of it
  PictureJob job;              // for it
  // By the tick: nobody needs that picture any more (is_outdated), so what is not drawn of it yet
  // is left out.
  std::atomic<bool> given_up{false};
  std::vector<Broker*> brokers;  // that what is being traced was asked by; empty: it is not tracing
  double seconds = 0;            // for that
  size_t traced = 0;             // samples
  double traced_seconds = 0;     // that it took
  // Cores leave this work for the tick's as soon as they have finished a piece.
  oneapi::tbb::task_arena cores{oneapi::tbb::task_arena::automatic, 1,
                                oneapi::tbb::task_arena::priority::low};
  Worker worker;  // the last member: it is waited for before the others end

  bool idle() const { return !worker.busy(); }
};

}  // namespace wellspring::show
