// SPDX-License-Identifier: Apache-2.0
// Holds a painting as it is painted: a tree of items, brushes and materials. `read_painting` makes
// it of a file; nothing changes it later, so all threads may paint at once. Lengths are shares of
// the picture's width unless a name says otherwise, y goes down, colours are sRGB from 0 to 1.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "base/vec.h"

namespace wellspring::store {

struct GeoDrawing;  // store/painting/geo_drawing.h

struct PaintColor {
  float red = 0, green = 0, blue = 0, alpha = 0;
};

// Holds an axis-aligned box; an empty one has its low corner above the high one.
struct PaintBox {
  dvec2 low{1e300}, high{-1e300};
  bool empty() const { return !(low.x <= high.x && low.y <= high.y); }
  void add(dvec2 point) { low = glm::min(low, point), high = glm::max(high, point); }
  void add(const PaintBox& box) {
    if (!box.empty()) low = glm::min(low, box.low), high = glm::max(high, box.high);
  }
  bool touches(const PaintBox& box) const {
    return low.x <= box.high.x && box.low.x <= high.x && low.y <= box.high.y && box.low.y <= high.y;
  }
};

// Maps (x, y) to x * across + y * down + at.
struct PaintPlacement {
  dvec2 across{1, 0}, down{0, 1}, at{0, 0};
  dvec2 apply(dvec2 p) const { return p.x * across + p.y * down + at; }
  dvec2 turn(dvec2 v) const { return v.x * across + v.y * down; }
  // Returns the placement that first does `inner`, then this.
  PaintPlacement over(const PaintPlacement& inner) const {
    return {turn(inner.across), turn(inner.down), apply(inner.at)};
  }
  // Returns how much lengths grow, as the root of the area.
  double scale() const { return std::sqrt(std::abs(across.x * down.y - across.y * down.x)); }
  PaintBox apply(const PaintBox& box) const;
  // Returns the placement backwards; the scale must not be 0.
  PaintPlacement inverse() const;
};

// Holds a path of lines and cubic curves: `steps` are of 'M', 'L', 'C' and 'Z', which take 1, 1, 3
// and 0 of the points.
struct PaintPath {
  std::vector<char> steps;
  std::vector<dvec2> points;
  bool empty() const { return points.empty(); }
  PaintBox bounds() const;
};

struct PaintGradient {
  struct Stop {
    double at = 0;
    PaintColor color;
  };
  bool radial = false;
  dvec2 from{0}, to{0};  // a radial one has its middle at `from`
  double radius = 0;
  std::vector<Stop> stops;
};

// Says what fills or strokes a path: nothing, a colour, or one of the painting's gradients.
struct PaintInk {
  bool is_there = false;
  PaintColor color;
  int gradient = -1;
};

struct PaintItem {
  enum class Kind : uint8_t { shape, group, repeat, hatch, geo };
  Kind kind = Kind::shape;
  PaintPath path;  // a shape's outline, a group's clip, the region of a repeat or a hatch
  PaintInk fill, stroke;
  double width = 0;          // a stroke's
  PaintPlacement placement;  // a group's
  std::vector<PaintItem> children;
  int symbol = -1;                        // draws one of the painting's symbols as its only child
  int brush = -1;                         // -1: the brush of what lies below
  double shade = 0;                       // how far the lightness of repeated symbols varies
  std::shared_ptr<const GeoDrawing> geo;  // a geo item draws it
  // Says how a repeat sows, and a hatch lies.
  double cell = 0, jitter = 0, density = 1;
  double least_scale = 1, most_scale = 1;  // a symbol's
  double least_turn = 0, most_turn = 0;    // radians
  double grow = 1;                         // scale at the region's lower end, relative to the upper
  double angle = 0;                        // radians; a hatch's
  uint64_t seed = 0;
  // Follows from the rest.
  bool is_soft = false;  // an ellipse whose radial gradient ends at its edge, transparent
  PaintBox bounds;       // in the space of what holds it
  PaintColor mean;       // mean over the bounds of a group, over the region of a repeat or a hatch
  double cost = 1;       // how many of its items are large beside it
  std::vector<dvec2> region;  // corners of a repeat's or a hatch's path
};

// Says how paint was put on. Octaves are strokes of the same kind, each three times as large.
struct PaintBrush {
  double width = 0.001, length = 0.006;  // metres
  double angle = 0, turn = 0;            // radians; `turn`: how far the direction wanders
  bool around = false;                   // strokes go round `middle` instead
  dvec2 middle{0};                       // share of the picture's width
  float tone = 0.05f, warmth = 0.02f;    // how far lightness and tint vary
  float impasto = 0.1f;                  // height of paint, share of the stroke's width
  double smear = 0;                      // metres that a stroke draws the colour along
  int octaves = 2;
};

// Describes what age and ground do to the surface.
struct PaintMaterial {
  double crack_cell = 0, crack_width = 0;  // metres; 0: no cracks
  float crack_depth = 0;                   // how far a crack darkens
  double weave = 0;                        // metres from thread to thread; 0: none is seen
  float weave_depth = 0;
  double grain = 0;  // metres, of the finest spots; 0: none
  float grain_depth = 0;
  int grain_octaves = 1;  // each twice as large
};

struct PaintLayer {
  std::string name;
  std::vector<PaintItem> items;
  PaintColor ground{1, 1, 1, 1};
  PaintMaterial material;
  bool gray = false;  // colours are seen as their lightness
};

struct Painting {
  int64_t width = 0, height = 0;  // texels of the finest level
  double metres = 1;              // real width
  uint64_t seed = 0;
  std::vector<PaintGradient> gradients;
  std::vector<PaintBrush> brushes;
  std::vector<PaintItem> symbols;  // groups; each includes only earlier ones
  std::vector<PaintLayer> layers;
  std::vector<std::string> languages;  // it has labels in these, each once
};

inline constexpr int64_t least_painting = 64, longest_painting = 262144;  // texels a side
inline constexpr int most_paint_items = 20000;                            // in a file
inline constexpr int most_path_points = 4000, most_painting_points = 400000;
inline constexpr int most_paint_brushes = 200, most_paint_gradients = 400, most_symbols = 400;
inline constexpr int most_repeats = 200, most_paint_groups = 2000;
inline constexpr int most_included = 12;  // groups and symbols within one another

// Returns a number from 0 to 1 that depends on all arguments.
double paint_chance(uint64_t seed, int64_t a, int64_t b, int c);

}  // namespace wellspring::store
