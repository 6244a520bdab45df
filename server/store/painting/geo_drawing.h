// SPDX-License-Identifier: Apache-2.0
// Holds a GeoJSON file as it is drawn on a painting: outlines, how each is drawn, and names where
// they stand. Lengths are shares of the picture's width, as all of a painting's.
#pragma once
#include <array>
#include <map>
#include <string>
#include <vector>

#include "store/geography/geojson.h"
#include "store/geography/outlines.h"
#include "store/painting/painting.h"
#include "store/painting/painting_path.h"

namespace wellspring::store {

// Says how names are written. `size` 0: not at all.
struct GeoLettering {
  double size = 0;  // length of an em
  std::string family = "serif";
  bool bold = false, slanted = false;
  PaintColor fill{0.13f, 0.12f, 0.1f, 1}, halo{1, 1, 1, 0};
  double halo_width = 0;  // around the letters
  dvec2 shift{0};
  bool overlaps = false;  // otherwise names that would lie over an earlier one are left out
  std::vector<std::string> properties{"name:{language}", "name_{language}", "name", "label"};
};

struct GeoStyle {
  PaintColor fill, stroke, casing;  // alpha 0: none
  double width = 0, casing_width = 0;
  std::array<double, 2> dash{0, 0};  // on, off; 0: it is whole
  double radius = 0;                 // a point's
  GeoLettering label;
};

struct GeoShape {
  GeoFeature::Kind kind = GeoFeature::Kind::points;
  int style = 0;
  // Lines or rings of `outlines`, of one polygon; or the only point.
  size_t first_line = 0, lines = 0;
  dvec2 point{0};
  GeoBox box;  // with its strokes
};

struct GeoName {
  PaintPath letters;
  GeoBox box;                       // with its halo
  std::array<dvec2, 4> corners;     // they make a turned box around the letters
  double size = 0, halo_width = 0;  // length of an em; width around the letters
  PaintColor fill, halo;
  float letters_cover = 0, halo_cover = 0;  // shares of the turned box
};

struct GeoDrawing {
  GeoOutlines outlines;
  std::vector<GeoStyle> styles;
  std::vector<GeoShape> shapes;
  std::vector<GeoName> names;
  GeoBoxTree shape_tree, name_tree;
  PaintBox frame;                                // nothing is drawn beyond it
  std::set<std::string, std::less<>> languages;  // it has names in these
};

// Says how coordinates become places: west, south, east and north of `bounds` are the sides of
// `frame`. Equirectangular: straight in longitude and latitude.
struct GeoFrame {
  GeoBox bounds{{-180, -90}, {180, 90}};
  PaintBox frame{{0, 0}, {1, 1}};
  dvec2 place(dvec2 coordinate) const {
    const dvec2 share = (coordinate - bounds.low) / (bounds.high - bounds.low);
    return {glm::mix(frame.low.x, frame.high.x, share.x),
            glm::mix(frame.high.y, frame.low.y, share.y)};
  }
};

// Styles by the value of a property; the first of `styles` is for all others.
struct GeoStyles {
  std::string by = "kind";
  std::vector<GeoStyle> styles{GeoStyle{}};
  std::map<std::string, int, std::less<>> known;
  // A length of GitHub's properties of a feature ("stroke-width"); 0: they are not regarded.
  double simple_width = 0;
};

inline constexpr size_t most_geo_names = 4000;

// Returns the bounds of a file: its bbox, else those of its points; of an empty file, the world.
// Widened where they have no width or height.
GeoBox geo_bounds(const GeoFile& file);
// Returns the width of a box of degrees by its height, on the ground at its middle latitude; of
// other coordinates as they are.
double geo_aspect(const GeoBox& bounds);
// Returns whether all of a box are longitudes and latitudes.
bool is_geographic(const GeoBox& bounds);

// Makes the drawing, with names in a language.
GeoDrawing make_geo_drawing(const GeoFile& file, const GeoFrame& frame, GeoStyles styles,
                            const std::string& language);
// Adds the name of a feature whose shapes, `first` and those after it, were added last; not if it
// would lie over an earlier one.
void add_geo_name(GeoDrawing& drawing, size_t first, const GeoStyle& style,
                  const std::string& text);

}  // namespace wellspring::store
