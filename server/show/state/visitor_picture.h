// SPDX-License-Identifier: Apache-2.0
// What is kept of one visitor for drawing its pictures (show/draw): the light that is known, the
// picture that was drawn last, and what is laid over it. The renderer's (show/state/renderer.h)
// while `at_work`, but for what the tick asks: when it was drawn, for what, and whether it was
// sent.
#pragma once
#include <cstddef>
#include <vector>

#include "cache/broker.h"
#include "cache/cache.h"
#include "frame/tonemap.h"
#include "light/dynamic/backdrop_surfaces.h"
#include "light/dynamic/dynamic_image.h"
#include "picture/compositor.h"
#include "picture/keyframe.h"
#include "show/state/renderer.h"

namespace wellspring::show {

// From one picture at rest to the next, better one of the same view the eye is led gradually: a cut
// would be seen as a flicker.

struct Fade {
  Image8 from;  // what was shown; empty: nothing fades
  View view;
  double began = 0;  // show time
};

// What the keyframe shows passes into what is shown from `time` on.
void begin_fade(const Keyframe& shown, double time, Fade& fade);
// How much of the newer picture is shown: 0 to 1; 1 of another view.
float fade_share(const Fade& fade, const View& view, double time);
// Mixes what was shown into a picture of its size, in display codes.
void mix_fade(const Fade& fade, float share, Image8& image);

// As the visitor's page asks for it.
struct PictureWishes {
  int width = 1280, height = 720;
  float fps = 0;                              // 0: the show's
  double bandwidth = 0;                       // bytes a second for pictures; 0: no limit
  bool saver = false;                         // nothing is sent that can be done without
  bool parts = false;                         // of pictures at rest, packet.h
  bool local = false;                         // keyframes with depth, packet.h
  int best_quality = 82, still_quality = 92;  // of JPEGs, in motion and at rest
  bool attention = true;                      // CacheSettings::attention
  // Of attention (attention/task.h): 0 what catches the eye, 1 what the visitor looks at.
  float task_weight = 0.5f;
};

// It shows in fewer pixels what lies around the keyframe, while somebody moves.
struct Surroundings {
  Keyframe keyframe;         // empty: nothing
  bool unsent = false;       // the page that shows keyframes has not got it yet
  uint32_t camera_cuts = 0;  // of the visitor, by then
  bool drawn = false;        // since the last picture was: they take turns
};

struct VisitorPicture {
  bool at_work = false;  // a picture of this visitor is drawn or its samples are traced
  // The light that is known.
  LampLevels lamps;            // whose light the cache knows: see show/state/lamps.h
  std::optional<double> hour;  // of the day, that is seen by
  RenderCache cache;
  Compositor compositor;
  Broker broker;              // what is traced after its picture, for the next
  double broker_seconds = 0;  // of all cores, for what was last asked
  // The renderer's time that it has had, in seconds, on a clock that it shares with the others who
  // want pictures (Renderer::served): whoever wanted none for a while begins where these are.
  double served = 0;
  RestState rest;
  // What was drawn last, and for what.
  PictureJob job;
  PictureCosts costs;
  CacheStats stats;
  double drawn_at = -1e9;  // show time of its job
  float drawn_fps = 0;
  Image8 image;       // until it is shown
  Keyframe keyframe;  // what pictures are warped from until the next
  float relief = 0;   // of it: uncovered_a_metre()
  Surroundings around;
  Fade fade;                  // to the keyframe
  bool fades_next = false;    // the next keyframe of the same view has better light: it fades in
  bool backdrop = false;      // the keyframe is without what moves (show/draw/still_pass.h)
  MovingPicture moving;       // that, to be laid over it; empty: nothing
  bool layer_unsent = false;  // its layer has not been sent
  double posed_at = -1e9;     // show time of its job
  BackdropSurfaces surfaces;  // of the keyframe, while lights that move shine on it
  SettledBounce settled;      // of those of them that stay as they are
  bool unshown = false;       // nothing of it has been sent yet
  size_t cache_bytes = 0, memory_bytes = 0;  // of its cache; of all that is kept for its pictures
};

// The same memory as it is now: not while the renderer is at work on it.
size_t memory_bytes(const VisitorPicture& picture);

}  // namespace wellspring::show
