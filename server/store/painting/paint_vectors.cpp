// SPDX-License-Identifier: Apache-2.0
#include "store/painting/paint_vectors.h"

#include <cairo.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "store/painting/draw_geo.h"
#include "store/painting/painting_path.h"

namespace wellspring::store {

namespace {

constexpr double most_work = 200000;    // about drawn shapes a window
constexpr double most_mean_work = 600;  // the same for a mean
constexpr double farthest_texel = 4e6;  // within Cairo's numbers of 24.8 bits
constexpr double least_seen = 0.4;      // texels
// Smaller shapes have the strokes of what lies below them, in texels.
constexpr double least_brushed = 40, least_speck_brushed = 8;
constexpr double most_rough = 60;      // texels, below which edges have 16 steps only
constexpr double most_speck = 4.5;     // texels, below which shapes are dabs
constexpr double thinnest_line = 0.3;  // texels; thinner ones are drawn paler
constexpr double least_cell = 2.5;     // texels, below which repeats become their mean
constexpr double least_hatch = 1.6;    // texels from line to line, likewise
constexpr double blob_a_cost = 4;      // texels a root of cost, below which symbols are dabs
constexpr double least_blob = 3, most_blob = 40;  // texels

struct CairoEnd {
  void operator()(cairo_t* cairo) const { cairo_destroy(cairo); }
};

// Says how an item is drawn within what holds it.
struct PaintState {
  PaintPlacement to_window;
  int brush = -1;
  float tint = 1;
  bool repeated = false;
  int depth = 0;
};

class VectorPainter {
 public:
  VectorPainter(const Painting& painting, PaintedVectors& to, dvec2 origin, double work)
      : painting_(painting), to_(to), origin_(origin), work_(work) {
    view_ = {dvec2(-1), dvec2(to.width + 1, to.height + 1)};
    colors_ = open(CAIRO_FORMAT_ARGB32, to.colors.data(), 4 * to.width);
    brushes_ = open(CAIRO_FORMAT_A8, to.brushes.data(), to.width);
    cairo_set_operator(brushes_.get(), CAIRO_OPERATOR_SOURCE);
    cairo_set_antialias(brushes_.get(), CAIRO_ANTIALIAS_NONE);
    for (cairo_t* cairo : {colors_.get(), brushes_.get()}) {
      cairo_set_line_cap(cairo, CAIRO_LINE_CAP_ROUND);
      cairo_set_line_join(cairo, CAIRO_LINE_JOIN_ROUND);
    }
  }

  void draw(const PaintItem& item, PaintState state) {
    if (state.depth > most_included || --work_ < 0) return;
    const PaintBox box = state.to_window.apply(item.bounds);
    if (box.empty() || !box.touches(view_)) return;
    const dvec2 size = box.high - box.low;
    const double side = std::max(size.x, size.y);
    if (!(std::max({std::abs(box.low.x), std::abs(box.low.y), std::abs(box.high.x),
                    std::abs(box.high.y)}) < farthest_texel))
      return;
    if (side < (state.repeated ? 2 * least_seen : least_seen)) return;
    if (item.brush >= 0) state.brush = item.brush;
    if (side < (state.repeated ? least_brushed : least_speck_brushed)) state.brush = -1;
    switch (item.kind) {
      case PaintItem::Kind::shape:
        return side < most_speck ? draw_dab(item.mean, box, state) : draw_shape(item, state);
      case PaintItem::Kind::group: return draw_group(item, state, box);
      case PaintItem::Kind::repeat: return draw_repeat(item, state);
      case PaintItem::Kind::hatch: return draw_hatch(item, state);
      case PaintItem::Kind::geo:
        return draw_geo(*item.geo, {colors_.get(), state.to_window, origin_, to_.width, to_.height},
                        work_);
    }
  }

  // Returns whether something was left out because all of it is too much work.
  bool crowded() const { return work_ < 0; }

 private:
  static std::unique_ptr<cairo_t, CairoEnd> open(cairo_format_t format, void* bytes, int stride);
  void set_matrix(const PaintPlacement& p) {
    const cairo_matrix_t matrix{p.across.x, p.across.y, p.down.x, p.down.y, p.at.x, p.at.y};
    cairo_set_matrix(colors_.get(), &matrix);
    cairo_set_matrix(brushes_.get(), &matrix);
  }
  void set_path(const PaintPath& path, bool also_brush);
  void set_ink(const PaintInk& ink, float tint, double alpha = 1);
  void set_brush(int brush) {
    cairo_set_source_rgba(brushes_.get(), 0, 0, 0, double(brush + 1) / 255);
  }
  void draw_shape(const PaintItem& item, const PaintState& state);
  // Draws a soft circle without Cairo, whose radial gradients are slow.
  void draw_soft(const PaintItem& item, const PaintState& state);
  void draw_group(const PaintItem& item, const PaintState& state, const PaintBox& box);
  void draw_children(const PaintItem& item, const PaintState& state);
  void draw_repeat(const PaintItem& item, const PaintState& state);
  void draw_repeated(const PaintItem& item, const PaintState& state, int64_t column, int64_t row);
  void draw_hatch(const PaintItem& item, const PaintState& state);
  void fill_mean(const PaintItem& item, const PaintState& state);
  void stroke(const PaintItem& item, const PaintState& state);
  void draw_dab(const PaintColor& mean, const PaintBox& box, const PaintState& state);
  // Returns the part of an item's bounds that is seen, in the item's space, and room around it.
  PaintBox seen(const PaintBox& bounds, const PaintPlacement& to_window, double room) const;

  const Painting& painting_;
  PaintedVectors& to_;
  const dvec2 origin_;  // texel of the level at which the window begins
  double work_;
  PaintBox view_;
  std::unique_ptr<cairo_t, CairoEnd> colors_, brushes_;
  int clips_ = 0;
};

std::unique_ptr<cairo_t, CairoEnd> VectorPainter::open(cairo_format_t format, void* bytes,
                                                       int stride) {
  const int width = format == CAIRO_FORMAT_A8 ? stride : stride / 4;
  cairo_surface_t* surface = cairo_image_surface_create_for_data(static_cast<unsigned char*>(bytes),
                                                                 format, width, width, stride);
  std::unique_ptr<cairo_t, CairoEnd> cairo(cairo_create(surface));
  cairo_surface_destroy(surface);
  return cairo;
}

void VectorPainter::set_path(const PaintPath& path, bool also_brush) {
  for (cairo_t* cairo : {colors_.get(), brushes_.get()}) {
    if (cairo == brushes_.get() && !also_brush) break;
    cairo_new_path(cairo);
    const dvec2* p = path.points.data();
    for (char step : path.steps) {
      if (step == 'M') cairo_move_to(cairo, p->x, p->y), p++;
      else if (step == 'L') cairo_line_to(cairo, p->x, p->y), p++;
      else if (step == 'Z') cairo_close_path(cairo);
      else cairo_curve_to(cairo, p[0].x, p[0].y, p[1].x, p[1].y, p[2].x, p[2].y), p += 3;
    }
  }
}

void VectorPainter::set_ink(const PaintInk& ink, float tint, double alpha) {
  const auto tinted = [&](float code) { return std::min(double(code * tint), 1.0); };
  if (ink.gradient < 0) {
    const PaintColor& c = ink.color;
    cairo_set_source_rgba(colors_.get(), tinted(c.red), tinted(c.green), tinted(c.blue),
                          double(c.alpha) * alpha);
    return;
  }
  const PaintGradient& g = painting_.gradients[size_t(ink.gradient)];
  cairo_pattern_t* pattern =
      g.radial ? cairo_pattern_create_radial(g.from.x, g.from.y, 0, g.from.x, g.from.y, g.radius)
               : cairo_pattern_create_linear(g.from.x, g.from.y, g.to.x, g.to.y);
  for (const auto& [at, c] : g.stops)
    cairo_pattern_add_color_stop_rgba(pattern, at, tinted(c.red), tinted(c.green), tinted(c.blue),
                                      double(c.alpha) * alpha);
  cairo_set_source(colors_.get(), pattern);
  cairo_pattern_destroy(pattern);
}

void VectorPainter::draw_soft(const PaintItem& item, const PaintState& state) {
  constexpr int steps = 512;  // by the square of the distance from the middle
  const PaintGradient& gradient = painting_.gradients[size_t(item.fill.gradient)];
  std::array<std::array<float, 4>, steps + 1> inks;  // blue, green, red by alpha; alpha
  for (int i = 0; i <= steps; i++) {
    const double at = std::sqrt(double(i) / steps);
    size_t next = 0;
    while (next < gradient.stops.size() && gradient.stops[next].at < at) next++;
    const auto& b = gradient.stops[std::min(next, gradient.stops.size() - 1)];
    const auto& a = gradient.stops[next > 0 ? next - 1 : 0];
    const float t = b.at > a.at ? float((at - a.at) / (b.at - a.at)) : 0.f;
    const float alpha = std::lerp(a.color.alpha, b.color.alpha, t);
    const auto ink = [&](float from, float to) {
      return 255 * alpha * std::min(std::lerp(from, to, t) * state.tint, 1.f);
    };
    inks[size_t(i)] = {ink(a.color.blue, b.color.blue), ink(a.color.green, b.color.green),
                       ink(a.color.red, b.color.red), 255 * alpha};
  }
  const PaintBox box = state.to_window.apply(item.bounds);
  const PaintPlacement back = state.to_window.inverse();
  const double by_radius = 1 / gradient.radius;
  const vec2 step(by_radius * back.across);
  const auto inner = [](double x, int most) { return int(std::clamp(x, 0.0, double(most))); };
  const int left = inner(box.low.x, to_.width), right = inner(box.high.x + 1, to_.width);
  work_ -= double(right - left) * inner(box.high.y - box.low.y, to_.height) / 100000;
  for (int y = inner(box.low.y, to_.height); y < inner(box.high.y + 1, to_.height); y++) {
    const vec2 begin(by_radius * (back.apply(dvec2(left + 0.5, y + 0.5)) - gradient.from));
    uint32_t* row = &to_.colors[size_t(y) * size_t(to_.width)];
    for (int x = left; x < right; x++) {
      const vec2 arm = begin + float(x - left) * step;
      const float square = arm.x * arm.x + arm.y * arm.y;
      if (square >= 1) continue;
      const std::array<float, 4>& ink = inks[size_t(square * steps + 0.5f)];
      const float rest = 1 - ink[3] * (1.f / 255);
      uint32_t mixed = 0;
      for (int i = 0; i < 4; i++)
        mixed |= uint32_t(float(row[x] >> 8 * i & 255) * rest + ink[size_t(i)] + 0.5f) << 8 * i;
      row[x] = mixed;
    }
  }
}

void VectorPainter::draw_shape(const PaintItem& item, const PaintState& state) {
  if (item.is_soft && state.brush < 0 && clips_ == 0) return draw_soft(item, state);
  const PaintBox box = state.to_window.apply(item.bounds);
  const dvec2 part = glm::min(box.high, view_.high) - glm::max(box.low, view_.low);
  work_ -= double(item.path.points.size()) / 16 + part.x * part.y / 20000;
  set_matrix(state.to_window);
  set_path(item.path, state.brush >= 0);
  const dvec2 size = box.high - box.low;
  cairo_set_antialias(colors_.get(), std::max(size.x, size.y) < most_rough ? CAIRO_ANTIALIAS_FAST
                                                                           : CAIRO_ANTIALIAS_GOOD);
  if (item.fill.is_there) {
    set_ink(item.fill, state.tint);
    cairo_fill_preserve(colors_.get());
  }
  if (state.brush >= 0) {
    set_brush(state.brush);
    if (item.fill.is_there) cairo_fill_preserve(brushes_.get());
  }
  if (item.stroke.is_there) stroke(item, state);
  cairo_new_path(colors_.get());
}

// Strokes the current path.
void VectorPainter::stroke(const PaintItem& item, const PaintState& state) {
  const double scale = std::max(state.to_window.scale(), 1e-12);
  const double width = item.width * scale;
  if (width < (state.repeated ? 0.4 : 0.01)) return;
  set_ink(item.stroke, state.tint, std::min(width / thinnest_line, 1.0));
  cairo_set_line_width(colors_.get(), std::max(width, thinnest_line) / scale);
  cairo_stroke(colors_.get());
  if (state.brush < 0 || width < 1) return;
  cairo_set_line_width(brushes_.get(), item.width);
  cairo_stroke(brushes_.get());
}

void VectorPainter::draw_group(const PaintItem& item, const PaintState& state,
                               const PaintBox& box) {
  const dvec2 size = box.high - box.low;
  const double least = std::clamp(blob_a_cost * std::sqrt(item.cost), least_blob, most_blob);
  const double side = std::max(size.x, size.y);
  if (side < (state.repeated ? least : least_blob)) return draw_dab(item.mean, box, state);
  PaintState inner = state;
  inner.to_window = state.to_window.over(item.placement);
  inner.depth++;
  if (item.path.empty()) return draw_children(item, inner);
  const PaintBox clip = inner.to_window.apply(item.path.bounds());
  const bool is_box = item.path.points.size() == 4 && std::ranges::count(item.path.steps, 'C') == 0;
  const bool covers = is_box && clip.low.x <= 0 && clip.low.y <= 0 && clip.high.x >= to_.width &&
                      clip.high.y >= to_.height;
  if (covers) return draw_children(item, inner);
  set_matrix(inner.to_window);
  set_path(item.path, true);
  for (cairo_t* cairo : {colors_.get(), brushes_.get()}) cairo_save(cairo), cairo_clip(cairo);
  clips_++;
  draw_children(item, inner);
  clips_--;
  for (cairo_t* cairo : {colors_.get(), brushes_.get()}) cairo_restore(cairo);
}

void VectorPainter::draw_children(const PaintItem& item, const PaintState& state) {
  for (const PaintItem& child : item.children) draw(child, state);
  if (item.symbol >= 0) draw(painting_.symbols[size_t(item.symbol)], state);
}

PaintBox VectorPainter::seen(const PaintBox& bounds, const PaintPlacement& to_window,
                             double room) const {
  PaintBox box = to_window.inverse().apply(view_);
  box.low = glm::max(box.low - room, bounds.low), box.high = glm::min(box.high + room, bounds.high);
  return box;
}

void VectorPainter::fill_mean(const PaintItem& item, const PaintState& state) {
  work_ -= double(item.path.points.size()) / 16;
  set_matrix(state.to_window);
  set_path(item.path, false);
  set_ink({true, item.mean, -1}, state.tint);
  cairo_fill(colors_.get());
}

void VectorPainter::draw_repeat(const PaintItem& item, const PaintState& state) {
  const double scale = state.to_window.scale(), cell = item.cell * scale;
  if (!(scale > 0)) return;
  if (cell < least_cell) return fill_mean(item, state);
  const PaintItem& symbol = painting_.symbols[size_t(item.symbol)];
  PaintBox reach = symbol.bounds;
  reach.add(dvec2(0));
  const double room = std::max(glm::length(reach.low), glm::length(reach.high)) * item.most_scale *
                          std::max(item.grow, 1.0) +
                      item.cell;
  PaintBox region;
  for (dvec2 corner : item.region) region.add(corner);
  const PaintBox box = seen(region, state.to_window, room);
  if (box.empty()) return;
  const auto index = [&](double x) { return int64_t(std::floor(x / item.cell)); };
  for (int64_t row = index(box.low.y); row <= index(box.high.y); row++)
    for (int64_t column = index(box.low.x); column <= index(box.high.x) && work_ > 0; column++)
      draw_repeated(item, state, column, row);
}

void VectorPainter::draw_repeated(const PaintItem& item, const PaintState& state, int64_t column,
                                  int64_t row) {
  work_ -= 0.05 + double(item.region.size()) / 400;
  const auto chance = [&](int i) { return paint_chance(item.seed, column, row, i); };
  if (chance(0) >= item.density) return;
  const dvec2 at = item.cell * dvec2(double(column) + 0.5 + item.jitter * (chance(1) - 0.5),
                                     double(row) + 0.5 + item.jitter * (chance(2) - 0.5));
  if (!is_within(item.region, at)) return;
  const PaintBox& bounds = item.bounds;
  const double down = (at.y - bounds.low.y) / std::max(bounds.high.y - bounds.low.y, 1e-12);
  const double size = glm::mix(item.least_scale, item.most_scale, chance(3)) *
                      glm::mix(1.0, item.grow, std::clamp(down, 0.0, 1.0));
  const double turn = glm::mix(item.least_turn, item.most_turn, chance(4));
  PaintState inner = state;
  inner.to_window = state.to_window.over({size * dvec2(std::cos(turn), std::sin(turn)),
                                          size * dvec2(-std::sin(turn), std::cos(turn)), at});
  inner.repeated = true, inner.depth++;
  inner.tint *= float(1 + item.shade * (2 * chance(5) - 1));
  draw(painting_.symbols[size_t(item.symbol)], inner);
}

void VectorPainter::draw_hatch(const PaintItem& item, const PaintState& state) {
  const double scale = state.to_window.scale();
  if (!(scale > 0)) return;
  if (item.cell * scale < least_hatch) return fill_mean(item, state);
  const PaintBox box = seen(item.bounds, state.to_window, item.cell);
  if (box.empty()) return;
  const dvec2 along(std::cos(item.angle), std::sin(item.angle)), across(-along.y, along.x);
  PaintBox turned;  // x along the lines, y across
  for (dvec2 p : {box.low, box.high, dvec2(box.low.x, box.high.y), dvec2(box.high.x, box.low.y)})
    turned.add(dvec2(glm::dot(p, along), glm::dot(p, across)));
  const double part = 10 * item.cell;
  const int64_t first = int64_t(std::floor(turned.low.y / item.cell)),
                last = int64_t(std::ceil(turned.high.y / item.cell)),
                begin = int64_t(std::floor(turned.low.x / part)),
                end = int64_t(std::ceil(turned.high.x / part));
  const double lines = double(last - first + 1) * double(end - begin + 1);
  work_ -= double(item.path.points.size()) / 16 + lines / 8;
  if (work_ < 0 || lines > 1e5) return;
  set_matrix(state.to_window);
  set_path(item.path, false);
  cairo_save(colors_.get());
  cairo_clip(colors_.get());
  for (int64_t line = first; line <= last; line++)
    for (int64_t i = begin; i < end; i++) {
      if (paint_chance(item.seed, line, i, 0) >= item.density) continue;
      const auto at = [&](int64_t k) {
        const double off = item.jitter * (paint_chance(item.seed, line, k, 1) - 0.5);
        return double(k) * part * along + (double(line) + off) * item.cell * across;
      };
      const dvec2 a = at(i), b = at(i + 1);
      cairo_move_to(colors_.get(), a.x, a.y);
      cairo_line_to(colors_.get(), b.x, b.y);
    }
  PaintState plain = state;
  plain.brush = -1;
  stroke(item, plain);
  cairo_restore(colors_.get());
}

// Draws an ellipse in a box that is as dark as the whole box in its mean colour.
void VectorPainter::draw_dab(const PaintColor& mean, const PaintBox& box, const PaintState& state) {
  constexpr double least_radius = 0.6;
  const dvec2 middle = 0.5 * (box.low + box.high), half = 0.5 * (box.high - box.low);
  const dvec2 radii = glm::max(half, dvec2(least_radius));
  const double alpha =
      std::min(double(mean.alpha) * 4 * half.x * half.y / (double(pi) * radii.x * radii.y), 1.0);
  work_ -= radii.x * radii.y / 200;
  if (clips_ > 0) {  // only Cairo knows how far
    set_matrix({});
    set_path(ellipse_path(middle, radii, 0), false);
    set_ink({true, mean, -1}, state.tint, alpha / std::max(double(mean.alpha), 1e-6));
    cairo_fill(colors_.get());
    return;
  }
  const auto inner = [](double x, int most) { return int(std::clamp(x, 0.0, double(most))); };
  const int left = inner(middle.x - radii.x - 0.5, to_.width),
            right = inner(middle.x + radii.x + 1.5, to_.width),
            top = inner(middle.y - radii.y - 0.5, to_.height),
            bottom = inner(middle.y + radii.y + 1.5, to_.height);
  const double least = std::min(radii.x, radii.y);
  const float inks[3] = {mean.blue, mean.green, mean.red};
  for (int y = top; y < bottom; y++)
    for (int x = left; x < right; x++) {
      const dvec2 d = (dvec2(x + 0.5, y + 0.5) - middle) / radii;
      const double cover = std::clamp((1 - glm::length(d)) * least + 0.5, 0.0, 1.0) * alpha;
      if (cover <= 0) continue;
      uint32_t& texel = to_.colors[size_t(y) * size_t(to_.width) + size_t(x)];
      uint32_t mixed = 0;
      for (int i = 0; i < 4; i++) {
        const double ink = i < 3 ? std::min(double(inks[i] * state.tint), 1.0) : 1.0;
        const double code = (texel >> 8 * i & 255) * (1 - cover) + 255 * ink * cover;
        mixed |= uint32_t(code + 0.5) << 8 * i;
      }
      texel = mixed;
      if (state.brush >= 0 && cover > 0.5)
        to_.brushes[size_t(y) * size_t(to_.width) + size_t(x)] = uint8_t(state.brush + 1);
    }
}

// Makes an empty window whose rows are as long as Cairo wants them.
PaintedVectors make_vectors(int side, uint32_t color) {
  PaintedVectors window;
  window.width = window.height = (side + 3) / 4 * 4;
  window.colors.assign(size_t(window.width) * size_t(window.height), color);
  window.brushes.assign(window.colors.size(), 0);
  return window;
}

}  // namespace

PaintedVectors draw_vectors(const Painting& painting, const PaintLayer& layer,
                            const PaintWindow& window) {
  const auto code = [](float x) { return uint32_t(std::lrint(255 * x)); };
  const PaintColor& c = layer.ground;
  PaintedVectors to =
      make_vectors(std::max(window.width, window.height),
                   255u << 24 | code(c.red) << 16 | code(c.green) << 8 | code(c.blue));
  const double tiles = std::max(double(to.width) * to.height / (256 * 256), 1.0);
  VectorPainter painter(painting, to, {window.left, window.top}, most_work * tiles);
  PaintState state;
  state.to_window = {dvec2(window.scale, 0), dvec2(0, window.scale),
                     dvec2(-window.left, -window.top)};
  for (const PaintItem& item : layer.items) painter.draw(item, state);
  to.crowded = painter.crowded();
  return to;
}

PaintColor mean_color(const Painting& painting, const PaintItem& item, const PaintBox& box) {
  constexpr int side = 48;
  const dvec2 size = glm::max(box.high - box.low, dvec2(1e-12));
  PaintedVectors to = make_vectors(side, 0);
  PaintState state;
  state.to_window = {dvec2(side / size.x, 0), dvec2(0, side / size.y),
                     -double(side) * box.low / size};
  {
    VectorPainter painter(painting, to, dvec2(0), most_mean_work);
    painter.draw(item, state);
  }
  double sums[4] = {};
  for (uint32_t texel : to.colors)
    for (int i = 0; i < 4; i++) sums[i] += texel >> 8 * i & 255;
  if (!(sums[3] > 0)) return {};
  const auto share = [&](int i) { return float(std::min(sums[i] / sums[3], 1.0)); };
  return {share(2), share(1), share(0), float(sums[3] / (255.0 * double(to.colors.size())))};
}

}  // namespace wellspring::store
