// SPDX-License-Identifier: Apache-2.0
// Finds where names of a map stand: points have them below, lines along their middle, areas inside.
#include <algorithm>
#include <cmath>

#include "store/painting/geo_drawing.h"

namespace wellspring::store {

namespace {

constexpr double x_height = 0.35;  // half of it lies so far above a line of letters, in ems
constexpr double ascent = 0.8, descent = 0.25;  // reach of letters, in ems

// Says where the middle of a name's line of letters stands.
struct GeoStand {
  dvec2 at{0};
  double turn = 0;
};

double length_of(const GeoOutlines& outlines, const GeoOutlines::Line& line) {
  const GeoOutlines::Run& last = outlines.runs[line.first_run + line.runs - 1];
  double length = last.before;
  for (size_t i = 1; i < last.count; i++)
    length += glm::length(outlines.points[last.first + i] - outlines.points[last.first + i - 1]);
  return length;
}

// Returns the place so far along a line.
dvec2 place_at(const GeoOutlines& outlines, const GeoOutlines::Line& line, double along) {
  size_t r = 0;
  while (r + 1 < line.runs && outlines.runs[line.first_run + r + 1].before <= along) r++;
  const GeoOutlines::Run& run = outlines.runs[line.first_run + r];
  double rest = along - run.before;
  for (size_t i = 1; i < run.count; i++) {
    const dvec2 a = outlines.points[run.first + i - 1], b = outlines.points[run.first + i];
    const double step = glm::length(b - a);
    if (rest <= step && step > 0) return glm::mix(a, b, std::max(rest, 0.0) / step);
    rest -= step;
  }
  return outlines.points[run.first + run.count - 1];
}

// Stands on the middle of the longest line, straight from where it begins to where it ends.
GeoStand stand_on_line(const GeoDrawing& drawing, size_t first, double width) {
  const GeoOutlines& outlines = drawing.outlines;
  const GeoOutlines::Line* longest = nullptr;
  double length = -1;
  for (size_t i = first; i < drawing.shapes.size(); i++)
    for (size_t k = 0; k < drawing.shapes[i].lines; k++) {
      const GeoOutlines::Line& line = outlines.lines[drawing.shapes[i].first_line + k];
      if (line.runs == 0) continue;
      if (const double one = length_of(outlines, line); one > length) length = one, longest = &line;
    }
  if (!longest) return {};
  const double half = 0.5 * std::min(width, length);
  const dvec2 a = place_at(outlines, *longest, 0.5 * length - half),
              b = place_at(outlines, *longest, 0.5 * length + half);
  dvec2 along = b - a;
  if (along.x < 0) along = -along;
  return {0.5 * (a + b), along == dvec2(0) ? 0 : std::atan2(along.y, along.x)};
}

// Returns the middle of the widest part of a level line inside a polygon, and that width.
std::pair<double, double> widest_part(const GeoOutlines& outlines, const GeoShape& shape,
                                      double y) {
  std::vector<double> crossings;
  for (size_t k = 0; k < shape.lines; k++) {
    const GeoOutlines::Line& line = outlines.lines[shape.first_line + k];
    for (size_t r = 0; r < line.runs; r++) {
      const GeoOutlines::Run& run = outlines.runs[line.first_run + r];
      if (run.box.low.y > y || run.box.high.y < y) continue;
      for (size_t i = 1; i < run.count; i++) {
        const dvec2 a = outlines.points[run.first + i - 1], b = outlines.points[run.first + i];
        if ((a.y > y) != (b.y > y))
          crossings.push_back(a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y));
      }
    }
  }
  std::ranges::sort(crossings);
  std::pair<double, double> best{0, 0};
  for (size_t i = 0; i + 1 < crossings.size(); i += 2)
    if (const double wide = crossings[i + 1] - crossings[i]; wide > best.second)
      best = {0.5 * (crossings[i] + crossings[i + 1]), wide};
  return best;
}

// Stands inside the largest polygon where it is wide, and rather in its middle.
GeoStand stand_in_area(const GeoDrawing& drawing, size_t first) {
  constexpr int rows = 15;
  const GeoShape* largest = nullptr;
  double most = -1;
  for (size_t i = first; i < drawing.shapes.size(); i++) {
    const dvec2 size = drawing.shapes[i].box.high - drawing.shapes[i].box.low;
    if (size.x * size.y > most) most = size.x * size.y, largest = &drawing.shapes[i];
  }
  if (!largest) return {};
  GeoStand stand{0.5 * (largest->box.low + largest->box.high), 0};
  double best = 0;
  for (int i = 1; i < rows; i++) {
    const double share = double(i) / rows, off = 2 * share - 1;
    const double y = glm::mix(largest->box.low.y, largest->box.high.y, share);
    const auto [x, wide] = widest_part(drawing.outlines, *largest, y);
    const double worth = wide * (1 - 0.6 * off * off);
    if (worth > best * (1 + 1e-9)) best = worth, stand.at = {x, y};
  }
  return stand;
}

// Returns the area of letters by the even-odd rule, about, and the length of their edges.
void measure_letters(const PaintPath& path, double& area, double& length) {
  area = length = 0;
  dvec2 begin(0), current(0);
  double part = 0;
  const auto line_to = [&](dvec2 p) {
    part += 0.5 * (current.x * p.y - p.x * current.y);
    length += glm::length(p - current);
    current = p;
  };
  size_t next = 0;
  for (char step : path.steps) {
    if (step == 'M') begin = current = path.points[next++];
    else if (step == 'L') line_to(path.points[next++]);
    else if (step == 'C') line_to(path.points[next + 2]), next += 3;
    else line_to(begin);
  }
  area = std::abs(part);  // holes of letters go round the other way
}

// Returns whether two turned boxes overlap: no side of either parts them.
bool overlap(const std::array<dvec2, 4>& a, const std::array<dvec2, 4>& b) {
  for (const auto* box : {&a, &b})
    for (int i = 0; i < 2; i++) {
      const dvec2 axis = (*box)[size_t(i + 1)] - (*box)[size_t(i)];
      double low[2] = {1e300, 1e300}, high[2] = {-1e300, -1e300};
      for (int k = 0; k < 2; k++)
        for (dvec2 corner : k ? b : a) {
          const double at = glm::dot(axis, corner);
          low[k] = std::min(low[k], at), high[k] = std::max(high[k], at);
        }
      if (high[0] <= low[1] || high[1] <= low[0]) return false;
    }
  return true;
}

}  // namespace

void add_geo_name(GeoDrawing& drawing, size_t first, const GeoStyle& style,
                  const std::string& text) {
  const GeoLettering& label = style.label;
  const GeoFeature::Kind kind = drawing.shapes[first].kind;
  PaintLettering lettering;
  lettering.text = text, lettering.family = label.family, lettering.size = label.size;
  lettering.bold = label.bold, lettering.slanted = label.slanted, lettering.align = 0.5;
  const double width = letter_width(lettering);
  GeoStand stand;
  dvec2 shift = label.shift;
  switch (kind) {
    case GeoFeature::Kind::points:
      stand.at = drawing.shapes[first].point;
      shift.y += style.radius + ascent * label.size + label.halo_width;
      break;
    case GeoFeature::Kind::lines:
      stand = stand_on_line(drawing, first, width);
      shift.y -= 0.5 * std::max(style.width, style.casing_width) + descent * label.size;
      break;
    case GeoFeature::Kind::areas:
      stand = stand_in_area(drawing, first);
      shift.y += x_height * label.size;
      break;
  }
  const dvec2 x(std::cos(stand.turn), std::sin(stand.turn)), y(-x.y, x.x);
  lettering.at = stand.at + shift.x * x + shift.y * y, lettering.turn = stand.turn;
  GeoName name;
  name.letters = letter_path(lettering);
  if (name.letters.empty()) return;
  name.size = label.size, name.halo_width = label.halo_width;
  name.fill = label.fill, name.halo = label.halo;
  for (dvec2 point : name.letters.points) name.box.add(point);
  name.box = name.box.grown(label.halo_width);
  const dvec2 half_width = 0.5 * width * x, up = -ascent * label.size * y,
              under = descent * label.size * y;
  name.corners = {lettering.at - half_width + up, lettering.at + half_width + up,
                  lettering.at + half_width + under, lettering.at - half_width + under};
  double area = 0, length = 0;
  measure_letters(name.letters, area, length);
  const double whole = std::max(width * (ascent + descent) * label.size, 1e-30);
  name.letters_cover = float(std::min(area / whole, 1.0));
  name.halo_cover = float(std::min((area + length * label.halo_width) / whole, 1.0));
  if (!label.overlaps)
    for (const GeoName& earlier : drawing.names)
      if (earlier.box.touches(name.box) && overlap(earlier.corners, name.corners)) return;
  drawing.names.push_back(std::move(name));
}

}  // namespace wellspring::store
