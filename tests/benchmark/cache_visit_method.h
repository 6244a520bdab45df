// SPDX-License-Identifier: Apache-2.0
// Ways to keep a picture up with a moving visitor when the renderer answers only a few samples a
// frame: the show's, the render cache as published, and what other streaming renderers do. Each
// gets the same samples of the same technique; how it uses them is its own. Deterministic.
#pragma once
#include <memory>
#include <span>
#include <string>

#include "cache/cache.h"
#include "light/kept/lamps.h"
#include "light/technique/technique.h"

namespace wellspring::test {

// One displayed frame's circumstances.
struct VisitMoment {
  const World* world = nullptr;
  const Lights* lights = nullptr;               // without maps
  std::shared_ptr<const IlluminationMap> maps;  // the same lights' maps, for methods that use them
  const LightChange* change = nullptr;          // since the frame before, for methods that are told
  const Technique* technique = nullptr;
  TransportSettings transport;
  View view;            // wanted now
  bool changed = true;  // anything in the view moved, or its light changed, since the frame before
  int frame = 0;        // counted from 0
  uint64_t seed = 1;    // this frame's
};

// Holds the picture on the screen. `object` is 0 where `empty` is not.
struct VisitPicture {
  Frame frame;       // color and object are always there
  double empty = 0;  // share of pixels that show nothing at all
  CacheStats stats;  // the cache's alone
};

class VisitMethod {
 public:
  virtual ~VisitMethod() = default;
  // Spends at most `budget` samples on the moment and overwrites `shown` with what is displayed.
  virtual void show(const VisitMoment& moment, int budget, VisitPicture& shown) = 0;
};

struct VisitMethodEntry {
  const char* name;
  const char* summary;
  bool baseline;  // ours is measured against the best of these
  std::unique_ptr<VisitMethod> (*make)();
  bool when_named = false;  // runs only then: it is slow, and needs the network's weights
};

// The one explicit list, in the report's order. A further way is one more line here.
std::span<const VisitMethodEntry> visit_methods();
// nullptr: there is none of that name.
std::unique_ptr<VisitMethod> make_visit_method(const std::string& name);

// The render cache as published: points alone, each picture of the frame's own answers.
std::unique_ptr<VisitMethod> make_published_cache();
// Pictures as show/draw/picture.cpp draws them (cache_visit_drawn.cpp), by default in all as the
// show does. Answers to who walks come through a broker for the next picture, or are there for the
// picture that asked, or the picture waits for them and is shown a frame late.
enum class Answers { next_frame, at_once, waited_for };
struct DrawnWay {
  Answers answers = Answers::next_frame;
  bool uses_maps = true;  // the moment's
  bool steers = true;     // attention tells whose samples come first
  bool denoises = false;  // at rest, by the network; throws std::runtime_error without its weights
};
std::unique_ptr<VisitMethod> make_drawn(const DrawnWay& way);
// The show's own way, each picture through the small network at 1 / scale of its resolution. Throws
// std::runtime_error without its weights.
std::unique_ptr<VisitMethod> make_reconstructed(int scale);
// The whole picture at the resolution the budget allows, bilinear; while nothing changes, samples
// add up in pixels of their own.
std::unique_ptr<VisitMethod> make_resolution_drop();
// A picture of full resolution from one camera, shown when it is complete; then the next, from the
// newest camera. While nothing changes, whole pictures add up.
std::unique_ptr<VisitMethod> make_hold();
// Pixels of the present view in random order, each replacing what is displayed there (Bishop,
// Fuchs, McMillan and Scher Zagier, "Frameless Rendering", SIGGRAPH 1994); nothing is reprojected.
// While nothing changes, a pixel's samples add up.
std::unique_ptr<VisitMethod> make_frameless();

// Returns how many columns and rows of a width x height picture `budget` samples can pay for, one
// each, at about its aspect; at least 1x1.
ivec2 affordable_size(int width, int height, int budget);
// Bilinear colour, nearest object; overwrites the planes of `large` (whose size is set).
void upsample(const Frame& small, Frame& large);

}  // namespace wellspring::test
