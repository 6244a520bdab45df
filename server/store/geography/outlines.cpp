// SPDX-License-Identifier: Apache-2.0
#include "store/geography/outlines.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace wellspring::store {

namespace {

constexpr size_t most_of_a_run = 64;  // points

// Appends the places where an edge crosses the grid within the window, in order, and its end.
void add_cuts(dvec2 a, dvec2 b, const GeoBox& texels, std::vector<dvec2>& to) {
  struct Cut {
    double share;
    dvec2 at;
  };
  std::vector<Cut> cuts;
  const dvec2 step = b - a;
  for (int i = 0; i < 2; i++) {
    const double low = std::max(std::min(a[i], b[i]), texels.low[i]),
                 high = std::min(std::max(a[i], b[i]), texels.high[i]);
    for (double at = std::ceil(low / geo_grid) * geo_grid; at <= high; at += geo_grid) {
      if (at == a[i] || at == b[i]) continue;
      // It depends on nothing but the edge and the grid: windows agree on it.
      const double share = (at - a[i]) / step[i];
      dvec2 place = a + share * step;
      place[i] = at;
      cuts.push_back({share, place});
    }
  }
  std::ranges::sort(cuts, {}, &Cut::share);
  for (const Cut& cut : cuts) to.push_back(cut.at);
  to.push_back(b);
}

bool crosses_grid(dvec2 a, dvec2 b) { return glm::floor(a / geo_grid) != glm::floor(b / geo_grid); }

GeoBox box_of(dvec2 a, dvec2 b) { return {glm::min(a, b), glm::max(a, b)}; }

// Returns whether the open insides of two boxes may overlap.
bool overlaps(const GeoBox& a, const GeoBox& b) {
  return a.low.x < b.high.x && b.low.x < a.high.x && a.low.y < b.high.y && b.low.y < a.high.y;
}

// Calls each(point, length of the run up to it) for the points of a run that are far enough apart.
template <class Each>
void visit_run(const GeoOutlines& outlines, const GeoOutlines::Run& run, const GeoWindow& window,
               const Each& each) {
  dvec2 last(0), before(0);
  double length = 0;
  for (size_t i = 0; i < run.count; i++) {
    const dvec2 place = outlines.points[run.first + i], at = window.apply(place);
    if (i > 0) length += glm::length(place - before);
    before = place;
    const dvec2 step = glm::abs(at - last);
    if (i > 0 && i + 1 < run.count && std::max(step.x, step.y) < least_step) continue;
    last = at;
    each(at, length);
  }
}

// Clips a ring to one side of a line: `sign` times coordinate `axis` is at most `sign` * `border`.
void clip_side(const std::vector<dvec2>& ring, int axis, double border, double sign,
               std::vector<dvec2>& to) {
  to.clear();
  if (ring.empty()) return;
  const auto inside = [&](dvec2 p) { return sign * p[axis] <= sign * border; };
  dvec2 a = ring.back();
  for (dvec2 b : ring) {
    if (inside(a) != inside(b)) {
      dvec2 cut = a + (border - a[axis]) / (b[axis] - a[axis]) * (b - a);
      cut[axis] = border;
      to.push_back(cut);
    }
    if (inside(b)) to.push_back(b);
    a = b;
  }
}

}  // namespace

void GeoOutlines::add(const dvec2* places, size_t count, bool closed) {
  Line line{runs.size(), 0, {}};
  const size_t first = points.size();
  points.insert(points.end(), places, places + count);
  if (closed && count > 0) points.push_back(places[0]);
  double length = 0;
  for (size_t i = first; i + 1 < points.size(); i += most_of_a_run - 1) {
    Run run{i, std::min(most_of_a_run, points.size() - i), length, {}};
    for (size_t k = 0; k < run.count; k++) {
      run.box.add(points[i + k]);
      if (k > 0) length += glm::length(points[i + k] - points[i + k - 1]);
    }
    line.box.add(run.box);
    runs.push_back(run);
  }
  line.runs = runs.size() - line.first_run;
  lines.push_back(line);
}

GeoWindow make_geo_window(dvec2 across, dvec2 down, dvec2 at, const GeoBox& texels, double reach) {
  GeoWindow window{across, down, at, {}, {}};
  window.texels.low = glm::floor((texels.low - reach) / geo_grid) * geo_grid;
  window.texels.high = glm::ceil((texels.high + reach) / geo_grid) * geo_grid;
  const double area = across.x * down.y - across.y * down.x;
  const dvec2 low = window.texels.low, high = window.texels.high;
  for (dvec2 corner : {low, high, dvec2(low.x, high.y), dvec2(high.x, low.y)}) {
    const dvec2 p = corner - at;
    window.places.add(dvec2(down.y * p.x - down.x * p.y, across.x * p.y - across.y * p.x) / area);
  }
  return window;
}

void cut_line(const GeoOutlines& outlines, const GeoOutlines::Line& line, const GeoWindow& window,
              std::vector<dvec2>& corners, std::vector<GeoPiece>& pieces) {
  std::vector<dvec2> parts;
  bool open = false;  // the last piece goes on
  for (size_t r = 0; r < line.runs; r++) {
    const GeoOutlines::Run& run = outlines.runs[line.first_run + r];
    if (!run.box.touches(window.places)) {
      open = false;
      continue;
    }
    dvec2 a(0);
    double begun = 0;
    bool first = true;
    visit_run(outlines, run, window, [&](dvec2 b, double length) {
      const dvec2 begin = a;
      const double before = begun;
      a = b, begun = length;
      if (std::exchange(first, false)) return;
      parts.clear();
      if (crosses_grid(begin, b)) add_cuts(begin, b, window.texels, parts);
      else parts.push_back(b);
      dvec2 from = begin;
      const double whole = glm::length(b - begin);
      for (dvec2 to : parts) {
        if (!overlaps(box_of(from, to), window.texels)) {
          open = false;
        } else {
          if (!open) {
            const double share = whole > 0 ? glm::length(from - begin) / whole : 0;
            pieces.push_back({corners.size(), 1, run.before + glm::mix(before, length, share)});
            corners.push_back(from);
          }
          corners.push_back(to), pieces.back().count++;
          open = true;
        }
        from = to;
      }
    });
  }
}

void clip_ring(const GeoOutlines& outlines, const GeoOutlines::Line& line, const GeoWindow& window,
               std::vector<dvec2>& corners) {
  std::vector<dvec2> ring;
  for (size_t r = 0; r < line.runs; r++) {
    const GeoOutlines::Run& run = outlines.runs[line.first_run + r];
    if (!run.box.touches(window.places)) {
      // All of it lies on one side of the window, where only its ends count.
      ring.push_back(window.apply(outlines.points[run.first]));
      ring.push_back(window.apply(outlines.points[run.first + run.count - 1]));
      continue;
    }
    bool first = true;
    visit_run(outlines, run, window, [&](dvec2 b, double) {
      if (!std::exchange(first, false) && crosses_grid(ring.back(), b))
        add_cuts(ring.back(), b, window.texels, ring);
      else ring.push_back(b);
    });
  }
  const GeoBox& box = window.texels;
  clip_side(ring, 0, box.low.x, -1, corners);
  clip_side(corners, 0, box.high.x, 1, ring);
  clip_side(ring, 1, box.low.y, -1, corners);
  clip_side(corners, 1, box.high.y, 1, ring);
  corners = std::move(ring);
}

}  // namespace wellspring::store
