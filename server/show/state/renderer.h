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
// (show/draw/moving.h).
#pragma once
#include <atomic>
#include <cstdint>
#include <memory>
#include <oneapi/tbb/task_arena.h>
#include <optional>
#include <vector>

#include "base/worker.h"
#include "cache/broker.h"
#include "light/dynamic/dynamic_image.h"
#include "light/known/skin_light.h"
#include "picture/compositor.h"
#include "picture/keyframe.h"
#include "picture/moving_picture.h"
#include "show/state/picture_job.h"
#include "show/state/visitor_attention.h"

namespace wellspring::show {

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

// Light on what moves is being found (show/draw/moving.h).
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
