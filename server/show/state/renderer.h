// SPDX-License-Identifier: Apache-2.0
// Draws pictures while the show goes on: one thing at a time, as all of them read the world and use
// all cores. Whatever the renderer is at work on belongs to it; the tick looks in
// (show/draw/carry_out.h), takes what is finished, moves the world, which nobody reads then, and
// gives the renderer the next thing that is decided (show/draw/decide.h; in a quick turn the
// surroundings first):
//
//   idle --carry_out--> drawing --take_finished--> idle, or, if samples are asked for, --> tracing
//   --> idle
//
// Between the steps of a picture at rest the world may move, and moving things may be drawn
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
#include "light/virtual/direct_light.h"
#include "light/virtual/dynamic_image.h"
#include "light/kept/skin/skin_light.h"
#include "picture/compositor.h"
#include "picture/keyframe.h"
#include "picture/still/reconstruct_still.h"
#include "picture/warp_picture.h"
#include "show/exhibit/pieces/piece_choices.h"
#include "show/state/visitor_attention.h"
#include "world/view.h"

namespace wellspring::workers {
class Crew;  // workers/crew.h
}

namespace wellspring::show {

// Holds what a picture is to be, decided before it is drawn (show/draw/picture.h).

// Holds the state of a visitor's rest, since the view or the light last changed, as far as
// reconstructions depend on it.
struct RestState {
  // samples asked for so far, of the view's sequence (picture/still/reconstruct_still.h)
  uint64_t asked = 0;
  double samples = 0;         // kept samples a pixel
  double passed_samples = 0;  // kept samples a pixel in the last pass
  // show time when the last pass ended; seconds that it took
  double passed_at = -1e9, passed_seconds = 0;
  bool reconstructed = false;  // whether the last pass's picture is the one shown
};

// Says what a picture is drawn for, and so what its stages do. A moving picture is shown for a
// moment only: maps alone light what is plain, samples may come after it, and it is tone-mapped as
// it is drawn. The others are drawn in steps, between which the world may move and moving things
// may be drawn.
enum class PictureKind : uint8_t {
  moving,
  still,           // shown while its visitor stands
  reconstruction,  // drawn with guides, not shown: a reconstruction begins with it
  samples,         // not drawn: only samples, as the reconstruction that is shown stays
};

// Holds all that a picture's drawing depends on besides the world and the samples that the
// visitor's cache remembers.
struct PictureJob {
  double time = 0;  // show time of the tick that ordered it
  uint64_t time_us = 0, tick = 0;
  View expected;     // expected view of the visitor when the picture is shown
  View view;         // view to be drawn: the expected one, and some around
  View ahead;        // view in the picture after that, when answers to its requests are shown
  uint32_t seq = 0;  // number of the visitor's last input
  uint32_t camera_cuts = 0;  // the visitor's camera cuts by then
  PictureKind kind = PictureKind::moving;
  bool sees_moving = false;  // something that can move may be in it
  bool sways = false;        // a lawn that moves may be in it
  bool learns = false;       // its samples are kept for each pixel, for reconstructions
  bool settled = false;      // the visitor has rested for long: the reference takes over
  RestState rest;            // the visitor's rest by then
  float scale = 1;           // sides of its view, in pixels, over those of the visitor's picture
  bool attention = true;
  std::shared_ptr<const std::vector<float>> weights;  // weights of objects; null: all are 1
  bool note_seen = false;                             // the picture is noted for the next weights
  uint64_t seed = 0;
  // wide view for a quick turn; drawn before the picture, in fewer pixels
  std::optional<View> around;
  int samples = 0;
  int away = 0;           // number of further samples that workers may trace
  DynamicLights dynamic;  // lights that move or change, as they are at that time
  ShownPieces pieces;     // seen by the visitor
};

// Returns whether it is drawn in steps for a visitor who stands.
inline bool is_still(const PictureJob& job) { return job.kind != PictureKind::moving; }

// Holds the learned reconstruction of a picture at rest that is under way. show/draw/still_pass.h
// works on it.
struct StillPass {
  enum class Step : uint8_t { compute, finish, done };
  uint64_t visitor = 0;  // Link::id of the visitor whose picture it is; 0: none is under way
  PictureJob job;
  bool backdrop = false;  // the picture is without moving things (show/draw/still_pass.h)
  Step step = Step::compute;
  bool at_work = false;  // the renderer works on it
  std::atomic<bool> given_up{false};
  double seconds = 0;  // seconds of computing so far
  Frame frame;         // the drawn picture; then the reconstructed one
  StillReconstruction work;
  Image8 picture;
  Keyframe keyframe;                   // when it is finished: the visitor's old one
  std::unique_ptr<Denoiser> denoiser;  // null: there is none
  std::string problem;                 // reason why there is none
};
size_t memory_bytes(const StillPass& pass);

// Samples a pixel, on average, beyond which no more are kept.
inline constexpr double most_rest_samples = 0.98 * most_still_samples;
inline bool has_all_samples(const RestState& rest) { return rest.samples >= most_rest_samples; }

// Holds what a picture took: milliseconds, and counts.
struct PictureCosts {
  float display = 0, light = 0, trace = 0, drawing = 0, tonemap = 0;
  size_t samples = 0;
  uint64_t asked = 0;        // RestState::asked, after the picture
  double kept_samples = 0;   // RestState::samples, likewise
  bool late = false;         // its samples are still to be traced
  bool given_up = false;     // the picture was given up: there is none
  double guide_seconds = 0;  // seconds for drawing and guides, with which a reconstruction begins
  bool backdrop = false;     // the picture is without moving things, which are to be laid over it
  double seconds = 0;        // seconds from its job on, without other jobs in between
  double core_seconds = 0;   // core-seconds of the process, but for samples (process_seconds_now())
};

// A picture at rest is drawn in steps, so that moving things in it need not wait for all of them.
enum class DrawingStep : uint8_t { plan, trace, draw, guide, done };

// Holds what drawing a picture needs, whoever it is for.
struct DrawingWork {
  std::shared_ptr<CacheWork> cache = make_cache_work();  // shared by all visitors' caches
  std::shared_ptr<CompositorWork> compositor = std::make_shared<CompositorWork>();  // likewise
  Frame frame;
  std::vector<float> depth;   // depth of pictures that are shown for a moment only
  Image8 picture;             // when it is finished: the visitor's old one
  Keyframe keyframe, around;  // likewise
  // the picture made small, for attention; null: not wanted
  std::shared_ptr<const SeenPicture> seen;
  std::vector<Request> requests, ahead, away;
  std::vector<Sample> samples;
  View pass;          // view whose pixels are all asked for, if whole passes are filtered
  size_t traced = 0;  // number of requests traced so far
  int guided = 0;     // number of visibility passes done for a reconstruction's guides
  uint64_t pose = 0;  // Show::pose_number when the tracing of samples began
  DynamicImage dynamic;
  LightPlanes backdrop_light;  // dynamic light on surfaces that stand still
  MovingLight moving_light;
  MovingPicture moving;  // when it is finished: the visitor's old one
};
size_t memory_bytes(const DrawingWork& work);

// Holds the job of finding the light on moving things (show/draw/still_pass.h).
struct SkinJob {
  bool at_work = false;
  double time = -1e9;    // show time
  double lit_at = -1e9;  // show time of the last job that had samples
  double interval = 0;   // seconds until it is due again
  uint64_t turn = 0;     // number of jobs so far
  SkinUpdate update;
  std::vector<View> views;  // views of visitors who see moving things
  int cycles = 1;           // cycles of smoothing
  size_t traced = 0;        // number of samples traced
};

struct Renderer {
  DrawingWork work;
  SkinJob skin;
  size_t work_bytes = 0;  // bytes of `work`, when last finished
  double served = 0;      // least VisitorPicture::served of those who wanted the last picture begun
  double work_seconds = 0;  // seconds that the last piece of work took
  // Link::id of the visitor whose picture is being drawn or has just been; 0: nobody's
  uint64_t drawn = 0;
  DrawingStep step = DrawingStep::done;  // next step of that picture
  double until_moving = 1;  // seconds from the step's beginning until moving things are due
  uint64_t posed = 0;   // Link::id of the visitor for whom moving things are drawn between steps
  double posed_at = 0;  // show time of that job
  uint64_t posed_us = 0;
  DynamicLights posed_lights;  // dynamic lights of that visitor then
  bool posed_layer = false;    // for a page that lays moving things over by itself
  double posed_seconds = 0;    // seconds that drawing them took
  uint64_t lensed = 0;         // Link::id of the visitor whose glass is drawn; 0: nobody's
  bool surrounds = false;      // only `job.around` is drawn
  PictureJob job;              // job of the picture of `drawn`
  // The tick sets it when nobody needs that picture any more (is_outdated); what is not drawn of
  // the picture yet is then left out.
  std::atomic<bool> given_up{false};
  std::vector<uint64_t> asking;  // Link::id of those whose samples are traced; empty: nobody's
  double seconds = 0;            // seconds allowed for that
  size_t traced = 0;             // number of samples traced
  double traced_seconds = 0;     // seconds that it took
  // Cores leave this work for the tick's as soon as they have finished a piece.
  oneapi::tbb::task_arena cores{oneapi::tbb::task_arena::automatic, 1,
                                oneapi::tbb::task_arena::priority::low};
  Worker worker;  // the last member: it is waited for before the others end

  bool idle() const { return !worker.busy(); }
};

// Holds the workers of a show (show/workers/send.h).
struct ShowCrew {
  ShowCrew();
  ~ShowCrew();
  std::unique_ptr<Crew> crew;  // null: there are none
  // maps whose number is `light`
  std::shared_ptr<const IlluminationMap> maps;
  uint64_t light = 0;
};

// Holds what draws the pictures of a show, and how fast it was measured to be.
struct ShowDrawing {
  double drew_at = 0;                 // show time when anything was last drawn, traced or lit
  bool others_draw = false;           // others than this show's visitors need the cores
  float picture_lead = 0.02f;         // seconds from a tick to the times of its pictures, smoothed
  float samples_per_second = 200000;  // measured, of all cores
  WarpScratch warp;  // shared by all visitors, whose pictures are warped one after the other
  StillPass pass;
  ShowCrew workers;
  AttentionAnalysis analysis;  // show/draw/steer.h
  Renderer renderer;           // the last member: it reads the others while it is at work
};

}  // namespace wellspring::show
