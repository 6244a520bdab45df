// SPDX-License-Identifier: Apache-2.0
#include "kiosk/station/learn_twins.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace wellspring::kiosk {
namespace {

constexpr int cell = 40, step = 20;  // pixels of a view
constexpr float tells = 0.25f;       // twins.cpp tells two marks apart from here on
constexpr size_t marks_of_pair = 5;

struct Place {
  int side, x, y;
  float apart;
};

// Lists the cells in which two objects differ, the best first.
std::vector<Place> find_places(const std::vector<SharedSide>& sides, size_t a, size_t b,
                               MarkKind kind) {
  std::vector<Place> places;
  for (size_t s = 0; s < sides.size(); s++) {
    const View& view = sides[s].view;
    const int w = std::min(cell, view.width), h = std::min(cell, view.height);
    for (int y = 0; y + h <= view.height; y += step)
      for (int x = 0; x + w <= view.width; x += step) {
        const Mark one = cut_mark(sides[s].pictures[a], view, int(s), x, y, w, h);
        const Mark other = cut_mark(sides[s].pictures[b], view, int(s), x, y, w, h);
        const float apart = std::min(marks_apart(kind, one, other), marks_apart(kind, other, one));
        if (apart >= tells) places.push_back({int(s), x, y, apart});
      }
  }
  std::ranges::stable_sort(places, [](const auto& p, const auto& q) { return p.apart > q.apart; });
  return places;
}

bool overlaps(const Place& a, const Place& b) {
  return a.side == b.side && std::abs(a.x - b.x) < cell && std::abs(a.y - b.y) < cell;
}

struct Chosen {
  std::vector<Place> places;
  std::vector<float> apart;
  float least = 1;  // lowest of all pairs
};

Chosen choose(const std::vector<SharedSide>& sides, size_t objects, MarkKind kind) {
  Chosen out;
  out.apart.assign(objects * objects, 0.f);
  for (size_t a = 0; a < objects; a++)
    for (size_t b = a + 1; b < objects; b++) {
      const auto places = find_places(sides, a, b, kind);
      const float best = places.empty() ? 0 : places[0].apart;
      out.apart[a * objects + b] = out.apart[b * objects + a] = best;
      out.least = std::min(out.least, best);
      std::vector<Place> of_pair;
      // Each side has its best marks, so that any of them can tell.
      for (size_t s = 0; s < sides.size(); s++) {
        size_t count = 0;
        for (const Place& place : places) {
          if (place.side != int(s) || place.apart < 0.5f * best || count >= marks_of_pair) continue;
          if (std::ranges::any_of(of_pair, [&](const auto& p) { return overlaps(p, place); }))
            continue;
          of_pair.push_back(place);
          count++;
        }
      }
      for (const Place& place : of_pair)
        if (out.places.size() < 60 && std::ranges::none_of(out.places, [&](const auto& p) {
              return p.side == place.side && p.x == place.x && p.y == place.y;
            }))
          out.places.push_back(place);
    }
  return out;
}

}  // namespace

std::optional<mat3> align_views(const View& a, const View& b) {
  const auto pairs = pair_features(a.features, b.features);
  if (pairs.size() < 20) return {};
  std::vector<vec2> from, to;
  for (const auto& [i, k] : pairs)
    from.push_back(a.features[size_t(i)].place), to.push_back(b.features[size_t(k)].place);
  const auto found = fit_pose(from, to, 3);
  const size_t fewer = std::min(a.features.size(), b.features.size());
  if (!found || float(found->inliers) < std::max(18.f, 0.25f * float(fewer))) return {};
  // The other view is looked at as if it were a picture.
  GrayFrame frame;
  frame.width = b.gray_width(), frame.height = b.gray_height();
  frame.pixels = b.gray;
  Sight sight;
  look_at(sight, frame, 1);
  const mat3 half(vec3(0.5f, 0, 0), vec3(0, 0.5f, 0), vec3(0, 0, 1));
  if (agreement(sight, a, half * found->pose) < 0.5f) return {};
  return found->pose;
}

std::vector<uint8_t> align_photo(const Photo& photo, const View& own, const mat3& pose,
                                 const View& to) {
  auto bgr = shrink_photo(photo, own.width, own.height);
  GrayFrame frame;
  frame.width = frame.color_width = own.width, frame.height = frame.color_height = own.height;
  frame.bgr = std::move(bgr);
  Sight sight;
  look_at(sight, frame, 1);
  return take_color(sight, pose, {0, 0, float(to.width), float(to.height)}, 1).pixels;
}

Mark cut_mark(const std::vector<uint8_t>& bgr, const View& view, int index, int x, int y, int width,
              int height) {
  Mark mark{index, x, y, width, height, {}};
  mark.bgr.reserve(size_t(width) * size_t(height) * 3);
  for (int row = 0; row < height; row++) {
    const auto begin = bgr.begin() + 3 * ((y + row) * view.width + x);
    mark.bgr.insert(mark.bgr.end(), begin, begin + 3 * width);
  }
  return mark;
}

ClassMarks choose_marks(const std::vector<SharedSide>& sides, size_t objects) {
  const Chosen edges = choose(sides, objects, MarkKind::edges);
  const Chosen colors = edges.least >= 0.5f ? Chosen{} : choose(sides, objects, MarkKind::colors);
  const bool by_edges = edges.least >= 0.5f || edges.least >= colors.least;
  const Chosen& chosen = by_edges ? edges : colors;
  ClassMarks out{by_edges ? MarkKind::edges : MarkKind::colors, {}, chosen.apart};
  out.marks.resize(objects);
  for (const Place& place : chosen.places) {
    const View& view = sides[size_t(place.side)].view;
    for (size_t i = 0; i < objects; i++)
      out.marks[i].push_back(cut_mark(sides[size_t(place.side)].pictures[i], view, place.side,
                                      place.x, place.y, std::min(cell, view.width),
                                      std::min(cell, view.height)));
  }
  return out;
}

}  // namespace wellspring::kiosk
