// SPDX-License-Identifier: Apache-2.0
#include "store/painting/painting_finish.h"

#include <algorithm>
#include <cmath>

#include "store/painting/geo_drawing.h"
#include "store/painting/paint_vectors.h"
#include "store/painting/painting_path.h"

namespace wellspring::store {

namespace {

// Returns the box of what a group holds, in the space of what holds the group.
PaintBox group_bounds(const PaintItem& item, const Painting& painting) {
  PaintBox inner;
  for (const PaintItem& child : item.children) inner.add(child.bounds);
  if (item.symbol >= 0) inner.add(painting.symbols[size_t(item.symbol)].bounds);
  if (!item.path.empty()) {
    const PaintBox clip = item.path.bounds();
    inner.low = glm::max(inner.low, clip.low), inner.high = glm::min(inner.high, clip.high);
  }
  return item.placement.apply(inner);
}

// Counts the parts of a group that are not small beside it.
double group_cost(const PaintItem& item, const Painting& painting) {
  constexpr double small = 0.2;
  const dvec2 size = item.placement.inverse().apply(item.bounds).high -
                     item.placement.inverse().apply(item.bounds).low;
  double cost = 0;
  for (const PaintItem& child : item.children) {
    const dvec2 part = child.bounds.high - child.bounds.low;
    if (std::max(part.x, part.y) > small * std::max(size.x, size.y)) cost += child.cost;
  }
  if (item.symbol >= 0) cost += painting.symbols[size_t(item.symbol)].cost;
  return std::max(cost, 1.0);
}

// Works out the mean of a shape over its bounds, as if all of its colour lay apart.
PaintColor shape_mean(const PaintItem& item, const Painting& painting) {
  const std::vector<dvec2> corners = flatten_path(item.path);
  double area = 0, length = 0;
  for (size_t i = 0; i < corners.size(); i++) {
    const dvec2 a = corners[i], b = corners[(i + 1) % corners.size()];
    area += 0.5 * (a.x * b.y - b.x * a.y);
    if (i + 1 < corners.size()) length += glm::length(b - a);
  }
  const dvec2 size = item.bounds.high - item.bounds.low;
  const double whole = std::max(size.x * size.y, 1e-30);
  const PaintInk& ink = item.fill.is_there ? item.fill : item.stroke;
  const double covered = item.fill.is_there ? std::abs(area) : length * item.width;
  PaintColor mean = ink.color;
  if (ink.gradient >= 0) {
    const auto& stops = painting.gradients[size_t(ink.gradient)].stops;
    if (!stops.empty()) mean = stops[stops.size() / 2].color;
  }
  mean.alpha *= float(std::min(covered / whole, 1.0));
  return mean;
}

// Returns whether a shape is a circle that its radial gradient leaves transparent at the edge.
bool is_soft_circle(const PaintItem& item, const Painting& painting) {
  if (item.fill.gradient < 0 || item.stroke.is_there || item.path.steps.size() != 6) return false;
  const PaintGradient& gradient = painting.gradients[size_t(item.fill.gradient)];
  if (!gradient.radial || gradient.stops.empty() || gradient.stops.back().color.alpha > 0.01f)
    return false;
  const dvec2 size = item.bounds.high - item.bounds.low,
              middle = 0.5 * (item.bounds.high + item.bounds.low);
  return glm::length(middle - gradient.from) < 1e-6 && std::abs(size.x - size.y) < 1e-6 &&
         std::abs(0.5 * size.x - gradient.radius) < 1e-6;
}

// Works out the mean of a repeat by drawing some cells of it, without its region.
PaintColor repeat_mean(const PaintItem& item, const Painting& painting) {
  constexpr int cells = 4;
  PaintItem patch = item;
  patch.path = {};
  const dvec2 middle = 0.5 * (item.bounds.low + item.bounds.high);
  const dvec2 low = glm::floor(middle / item.cell) * item.cell, half(20 * item.cell);
  patch.region = {
      low - half, {low.x + half.x, low.y - half.y}, low + half, {low.x - half.x, low.y + half.y}};
  patch.bounds = {low - half, low + half};
  patch.grow = 0.5 * (1 + item.grow);
  patch.least_scale *= patch.grow, patch.most_scale *= patch.grow, patch.grow = 1;
  return mean_color(painting, patch, {low, low + double(cells) * item.cell});
}

}  // namespace

void finish_item(PaintItem& item, const Painting& painting) {
  item.bounds = item.path.bounds();
  switch (item.kind) {
    case PaintItem::Kind::shape:
      if (item.stroke.is_there)
        item.bounds.low -= 0.5 * item.width, item.bounds.high += 0.5 * item.width;
      if (!item.bounds.empty()) item.mean = shape_mean(item, painting);
      item.is_soft = is_soft_circle(item, painting);
      break;
    case PaintItem::Kind::group:
      item.bounds = group_bounds(item, painting);
      item.cost = group_cost(item, painting);
      if (!item.children.empty()) item.mean = mean_color(painting, item, item.bounds);
      else if (item.symbol >= 0) item.mean = painting.symbols[size_t(item.symbol)].mean;
      break;
    case PaintItem::Kind::repeat: {
      item.region = flatten_path(item.path);
      item.mean = repeat_mean(item, painting);
      const PaintBox& symbol = painting.symbols[size_t(item.symbol)].bounds;
      const double reach = std::max(glm::length(symbol.low), glm::length(symbol.high)) *
                           item.most_scale * std::max(item.grow, 1.0);
      item.bounds.low -= reach, item.bounds.high += reach;
      item.cost = 10;
      break;
    }
    case PaintItem::Kind::geo:
      if (!item.geo) break;
      item.bounds = item.geo->frame;
      item.mean = mean_color(painting, item, item.bounds);
      item.cost = 10;
      break;
    case PaintItem::Kind::hatch:
      item.mean = item.stroke.color;
      item.mean.alpha *= float(std::min(item.width / item.cell, 1.0) * item.density);
      item.cost = 10;
      break;
  }
}

}  // namespace wellspring::store
