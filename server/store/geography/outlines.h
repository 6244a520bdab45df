// SPDX-License-Identifier: Apache-2.0
// Keeps lines and rings so that a window of a drawing takes only what touches it. Edges are
// cut where they cross a grid that lies still in the drawing, so windows beside one another have
// the same corners: what is drawn of them meets without a seam. Rings are clipped after Sutherland
// and Hodgman 1974 ("Reentrant Polygon Clipping").
#pragma once
#include <vector>

#include "store/geography/geo_box.h"

namespace wellspring::store {

// Holds lines one after another; each is cut into runs of points, each of which begins with the
// last point of the one before.
struct GeoOutlines {
  struct Run {
    size_t first = 0, count = 0;  // in `points`
    double before = 0;            // length of the line up to it
    GeoBox box;
  };
  struct Line {
    size_t first_run = 0, runs = 0;
    GeoBox box;
  };
  std::vector<dvec2> points;
  std::vector<Run> runs;
  std::vector<Line> lines;
  // Adds a line; a closed one gets its first point as the last, too.
  void add(const dvec2* places, size_t count, bool closed);
};

// Says which part of a drawing is wanted: places are mapped to texels of a level by
// x * across + y * down + at.
struct GeoWindow {
  dvec2 across{1, 0}, down{0, 1}, at{0};
  GeoBox texels;  // these are wanted; its sides lie on the grid
  GeoBox places;  // box around the same before it is mapped
  dvec2 apply(dvec2 p) const { return p.x * across + p.y * down + at; }
};
inline constexpr double geo_grid = 64;      // texels from one cut to the next
inline constexpr double least_step = 0.25;  // texels; nearer points of a run are left out

// Makes a window of these texels and `reach` more on each side.
GeoWindow make_geo_window(dvec2 across, dvec2 down, dvec2 at, const GeoBox& texels, double reach);

// Holds corners of a part of a line, in texels.
struct GeoPiece {
  size_t first = 0, count = 0;  // in the corners
  double before = 0;            // length of the line up to it, before it is mapped
};

// Appends the parts of a line that touch the window.
void cut_line(const GeoOutlines& outlines, const GeoOutlines::Line& line, const GeoWindow& window,
              std::vector<dvec2>& corners, std::vector<GeoPiece>& pieces);
// Sets the corners of a closed line to those of what the window sees of its inside.
void clip_ring(const GeoOutlines& outlines, const GeoOutlines::Line& line, const GeoWindow& window,
               std::vector<dvec2>& corners);

}  // namespace wellspring::store
