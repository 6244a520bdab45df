// SPDX-License-Identifier: Apache-2.0
// Holds what is kept of one visitor for drawing its pictures (show/draw): light, the picture that
// was drawn last, and what is laid over it. It belongs to the renderer (show/state/renderer.h)
// while `at_work`, but for what the tick asks: when the picture was drawn, for what, and whether it
// was sent.
#pragma once
#include <cstddef>
#include <memory>
#include <vector>

#include "cache/broker.h"
#include "cache/cache.h"
#include "frame/tonemap.h"
#include "light/virtual/dynamic_image.h"
#include "picture/compositor.h"
#include "picture/keyframe.h"
#include "show/state/renderer.h"
#include "show/exhibit/pieces/piece_choices.h"
#include "store/seen_pieces.h"
#include "wire/messages.h"

namespace wellspring::show {

// Fades from one picture at rest to the next, better one of the same view: a cut would be seen as a
// flicker.

struct Fade {
  Image8 from;  // picture that was shown before; empty: nothing fades
  View view;
  double began = 0;  // show time
};

// Begins to fade, at `time`, from what the keyframe shows to what is shown from then on.
void begin_fade(const Keyframe& shown, double time, Fade& fade);
// Returns the share of the newer picture, 0 to 1; 1 if the view is another one.
float fade_share(const Fade& fade, const View& view, double time);
// Mixes the picture that was shown before into one of the same size, in display codes.
void mix_fade(const Fade& fade, float share, Image8& image);

// Holds a keyframe that shows in fewer pixels what lies around the main one, while somebody moves.
struct Surroundings {
  Keyframe keyframe;         // empty: nothing
  bool unsent = false;       // the page that shows keyframes has not got it yet
  uint32_t camera_cuts = 0;  // the visitor's camera cuts by then
  bool drawn = false;        // drawn since the last picture was: the two take turns
};

// Holds the pieces of very large pictures that pictures of one kind show.
struct PieceWatch {
  std::unique_ptr<PieceClient> client;  // null: none so far
  std::vector<PieceMotion> motions;
  uint64_t arrivals = 0;  // number of pieces that had come by the last picture
};

// Holds what the visitor's glass shows (show/lens).
struct LensPicture {
  std::unique_ptr<Compositor> compositor;  // null: there was none yet
  PieceWatch pieces;
  LensOrder order;  // order that the last picture shows
  float zoom = 1;   // zoom of the last picture
  View seen;        // view through which the visitor looked then
  ShownPieces shown;
  LampLevels lamps;
  double drawn_at = -1e9;  // show time
  float took = 0;          // seconds of the last picture
  float seconds = 0;       // seconds that a picture takes, smoothed
  Image8 picture;
  bool unsent = false;
};

// Requests that are traced elsewhere are on their way for longer than those that are traced here.
inline constexpr BrokerSettings late_requests{64, 1 << 14, 1 << 16, 1 << 16},
    away_requests{64, 1 << 17, 1 << 17, 1 << 17};

struct VisitorPicture {
  bool at_work = false;  // a picture of this visitor is drawn or its samples are traced
  // These hold the light that has been found.
  LampLevels lamps;            // lamps whose light the cache has: see show/state/lamps.h
  std::optional<double> hour;  // hour of the day that pictures are drawn for
  RenderCache cache;
  Compositor compositor;
  Broker broker{
      late_requests};          // samples that are traced after the visitor's picture, for the next
  Broker away{away_requests};  // samples of its picture at rest that workers trace
  uint64_t away_asked = 0;     // number asked for, of the view's sequence of these
  View away_view;              // view that asked
  const Technique* away_by = nullptr;  // technique of these
  double broker_seconds = 0;           // seconds of all cores, for what was last asked
  // Seconds of the renderer's time that this visitor has had, on a clock that it shares with the
  // others who want pictures (Renderer::served): a visitor who wanted none for a while begins where
  // the others are.
  double served = 0;
  RestState rest;
  // The picture that was drawn last, and its job:
  PictureJob job;
  PictureCosts costs;
  CacheStats stats;
  double drawn_at = -1e9;  // show time of its job
  float drawn_fps = 0;
  Keyframe keyframe;  // keyframe from which pictures are warped until the next
  float relief = 0;   // uncovered_a_metre() of the keyframe
  Surroundings around;
  Fade fade;                  // passes to the keyframe
  bool fades_next = false;    // the next keyframe of the same view has better light: it fades in
  bool backdrop = false;      // the keyframe is without moving things (show/draw/still_pass.h)
  MovingPicture moving;       // moving things, to be laid over the keyframe; empty: none
  bool layer_unsent = false;  // the layer of `moving` has not been sent
  double posed_at = -1e9;     // show time of the job of `moving`
  double swayed_at = -1e9;    // show time of the grass that a page was last sent, which it moves
  BackdropSurfaces surfaces;  // surfaces of the keyframe, while lights that move shine on it
  SettledBounce settled;      // light of those lights that stay as they are
  PieceWatch pieces;
  ShownPieces shown_pieces;  // choice of which it shows pieces
  LensPicture lens;
  bool unshown = false;  // nothing of the newest picture has been sent yet
  // bytes of its cache; bytes of all that is kept for its pictures
  size_t cache_bytes = 0, memory_bytes = 0;
};

// Returns the same memory as it is now. Not while the renderer is at work on it.
size_t memory_bytes(const VisitorPicture& picture);

}  // namespace wellspring::show
