// SPDX-License-Identifier: Apache-2.0
// Turns GeoJSON (RFC 7946) in local metres into the items of a map, drawn in styles by kind.
#include <algorithm>
#include <cmath>
#include <optional>

#include "store/painting/painting_file.h"
#include "store/painting/painting_finish.h"

namespace wellspring::store {

using json::FieldReader;
using json::JsonValue;
using json::Need;

namespace {

constexpr double farthest_metres = 1e6;
constexpr size_t most_features = 4000;
constexpr int most_hachures = 1000;

// Says how features of a kind are drawn. Lengths are shares of the picture's width.
struct FeatureStyle {
  PaintInk fill, stroke, casing;
  double width = 0, casing_width = 0;  // a casing lies below a line, wider
  double wobble = 0, wobble_period = 0.004;
  bool smooth = false;
  int brush = -1, symbol = -1;  // a symbol is drawn at points, and sown over areas
  double cell = 0, scale = 1, shade = 0;
  PaintColor hatch;
  double spacing = 0, angle = 0, hatch_width = 0, hatch_density = 1;
  PaintColor hachure;
  double hachure_length = 0, hachure_spacing = 0, hachure_width = 0;
  PaintLettering label;
  PaintInk label_fill;
  dvec2 label_shift{0};
};

using FeatureStyles = std::map<std::string, FeatureStyle, std::less<>>;

void read_hatching(FieldReader& fields, FeatureStyle& style) {
  fields.part("hatch", "parallel lines over areas", [&](FieldReader& part) {
    part.number("spacing", 1e-6, 1, style.spacing, "from line to line", Need::required);
    double degrees = 0;
    part.number("angle", -360, 360, degrees, "degrees, clockwise");
    style.angle = double(pi) / 180 * degrees;
    read_color(part, "stroke", style.hatch);
    part.number("width", 0, 1, style.hatch_width, "of a line", Need::required);
    part.number("density", 0, 1, style.hatch_density, "share of lines that are not left out");
  });
  fields.part("hachures", "strokes from the edge of an area inward", [&](FieldReader& part) {
    part.number("length", 1e-6, 1, style.hachure_length, "of the longest", Need::required);
    part.number("spacing", 1e-6, 1, style.hachure_spacing, "along the edge", Need::required);
    part.number("width", 1e-7, 1, style.hachure_width, "at the edge", Need::required);
    read_color(part, "fill", style.hachure);
  });
}

FeatureStyle read_feature_style(FieldReader& fields, const PaintingReading& reading) {
  FeatureStyle style;
  read_ink(fields, "fill", style.fill, reading);
  read_ink(fields, "stroke", style.stroke, reading);
  fields.number("width", 0, 1, style.width, "of lines");
  read_ink(fields, "casing", style.casing, reading);
  fields.number("casing_width", 0, 1, style.casing_width, "of the line below a line");
  fields.number("wobble", 0, 1, style.wobble, "how far a hand strays from the line");
  fields.number("wobble_period", 1e-6, 1, style.wobble_period, "after which it strays again");
  fields.boolean("smooth", style.smooth, "corners are rounded");
  style.brush = read_known(fields, "brush", "one of brushes", reading.brushes);
  style.symbol = read_known(fields, "symbol", "one of symbols, for points, or sown over areas",
                            reading.symbols);
  fields.number("cell", 1e-6, 1, style.cell, "from one symbol of an area to the next");
  fields.number("scale", 1e-6, 1000, style.scale, "of the symbol");
  fields.number("shade", 0, 1, style.shade, "how far the symbols' lightness varies");
  read_hatching(fields, style);
  fields.part("label", "how names are written", [&](FieldReader& part) {
    part.number("size", 1e-6, 1, style.label.size, "of an em", Need::required);
    part.word("font", {"serif", "sans", "script"}, style.label.family, "kind of letters");
    part.boolean("bold", style.label.bold);
    part.boolean("slanted", style.label.slanted);
    part.number("align", 0, 1, style.label.align, "0.5: centred, 1: ends there");
    read_ink(part, "fill", style.label_fill, reading);
    part.vector("shift", 1, style.label_shift, "from the place to the name");
  });
  return style;
}

// Maps metres to the picture.
struct MapFrame {
  dvec2 west_south{0}, east_north{1}, left_top{0}, right_bottom{1};
  dvec2 place(dvec2 metres) const {
    const dvec2 share = (metres - west_south) / (east_north - west_south);
    return {glm::mix(left_top.x, right_bottom.x, share.x),
            glm::mix(right_bottom.y, left_top.y, share.y)};
  }
};

bool read_map_frame(FieldReader& fields, MapFrame& frame) {
  const auto metres = fields.numbers("metres", 4, -farthest_metres, farthest_metres);
  const auto box = fields.numbers("frame", 4, -10, 10);
  if (metres.size() != 4 || box.size() != 4) return false;
  frame = {{metres[0], metres[1]}, {metres[2], metres[3]}, {box[0], box[1]}, {box[2], box[3]}};
  const bool good = metres[2] - metres[0] >= 1 && metres[3] - metres[1] >= 1;
  if (!good) fields.fail("metres", "is west, south, east and north, at least a metre apart");
  return good;
}

// Reads the places of a line or a ring.
std::vector<dvec2> read_places(const JsonValue& list, const MapFrame& frame) {
  std::vector<dvec2> places;
  for (const JsonValue& one : list.list(1, size_t(most_path_points), "places")) {
    double metres[2];
    if (one.numbers(2, -farthest_metres, farthest_metres, metres))
      places.push_back(frame.place({metres[0], metres[1]}));
  }
  return places;
}

PaintPath path_through(const std::vector<dvec2>& places, bool closes, bool smooth) {
  PaintPath path;
  const int count = int(places.size());
  const auto at = [&](int i) {
    if (closes) return places[size_t((i + count) % count)];
    return places[size_t(std::clamp(i, 0, count - 1))];
  };
  if (count == 0) return path;
  path.steps.push_back('M'), path.points.push_back(places[0]);
  for (int i = 0; i + (closes && smooth ? 0 : 1) < count; i++) {
    path.steps.push_back(smooth ? 'C' : 'L');
    if (smooth) {
      path.points.push_back(at(i) + (at(i + 1) - at(i - 1)) / 6.0);
      path.points.push_back(at(i + 1) - (at(i + 2) - at(i)) / 6.0);
    }
    path.points.push_back(at(i + 1));
  }
  if (closes) path.steps.push_back('Z');
  return path;
}

// Holds what a feature becomes.
struct FeatureItems {
  PaintItem& group;
  FieldReader& fields;
  PaintingReading& reading;
  void add(PaintItem item) {
    if (item.path.empty() && item.kind != PaintItem::Kind::group) return;
    if (!count_item(item, fields, reading)) return;
    finish_item(item, reading.painting);
    group.children.push_back(std::move(item));
  }
};

// Draws tapering strokes from the edge of an area towards its inside.
void add_hachures(FeatureItems& to, const PaintPath& path, const FeatureStyle& style) {
  const std::vector<dvec2> edge = flatten_path(path);
  PaintItem item;
  item.fill = {true, style.hachure, -1};
  const uint64_t seed = to.reading.next_seed();
  double turned = 0;
  for (size_t i = 0; i < edge.size(); i++) {
    const dvec2 a = edge[i], b = edge[(i + 1) % edge.size()];
    turned += a.x * b.y - b.x * a.y;
  }
  int count = 0;
  for (size_t i = 0; i < edge.size() && count < most_hachures; i++) {
    const dvec2 a = edge[i], b = edge[(i + 1) % edge.size()];
    const double length = glm::length(b - a);
    if (!(length > 0)) continue;
    const dvec2 along = (b - a) / length;
    const dvec2 inward = (turned > 0 ? 1.0 : -1.0) * dvec2(-along.y, along.x);
    const int parts = int(std::min(length / style.hachure_spacing, double(most_hachures)));
    for (int k = 0; k < parts && count < most_hachures; k++, count++) {
      const double where = (k + paint_chance(seed, count, 0, 0)) / parts;
      const dvec2 foot = glm::mix(a, b, where);
      const double long_by = style.hachure_length * (0.5 + 0.5 * paint_chance(seed, count, 0, 1));
      const dvec2 lean = 0.15 * (paint_chance(seed, count, 0, 2) - 0.5) * along;
      const dvec2 half = 0.5 * style.hachure_width * along;
      for (dvec2 p : {foot - half, foot + half, foot + long_by * (inward + lean)}) {
        item.path.steps.push_back(item.path.points.size() % 3 == 0 ? 'M' : 'L');
        item.path.points.push_back(p);
      }
      item.path.steps.push_back('Z');
    }
  }
  to.add(std::move(item));
}

void add_area(FeatureItems& to, PaintPath path, const FeatureStyle& style) {
  path = wobbled_path(path, style.wobble, style.wobble_period, to.reading.next_seed());
  PaintItem item;
  item.path = path, item.fill = style.fill, item.brush = style.brush;
  if (item.fill.is_there) to.add(item);
  if (style.spacing > 0) {
    PaintItem hatch;
    hatch.kind = PaintItem::Kind::hatch;
    hatch.path = path, hatch.stroke = {true, style.hatch, -1}, hatch.width = style.hatch_width;
    hatch.cell = style.spacing, hatch.angle = style.angle, hatch.density = style.hatch_density;
    hatch.jitter = 0.3, hatch.seed = to.reading.next_seed();
    to.add(std::move(hatch));
  }
  if (style.hachure_spacing > 0) add_hachures(to, path, style);
  if (style.symbol >= 0 && style.cell > 0) {
    PaintItem sown;
    sown.kind = PaintItem::Kind::repeat;
    sown.path = path, sown.symbol = style.symbol, sown.cell = style.cell, sown.jitter = 0.7;
    sown.least_scale = 0.8 * style.scale, sown.most_scale = 1.15 * style.scale;
    sown.shade = style.shade, sown.seed = to.reading.next_seed();
    to.add(std::move(sown));
  }
  item.fill = {}, item.stroke = style.stroke, item.width = style.width;
  if (item.stroke.is_there) to.add(std::move(item));
}

void add_line(FeatureItems& to, PaintPath path, const FeatureStyle& style) {
  path = wobbled_path(path, style.wobble, style.wobble_period, to.reading.next_seed());
  PaintItem item;
  item.path = std::move(path), item.brush = style.brush;
  item.stroke = style.casing, item.width = style.casing_width;
  if (item.stroke.is_there) to.add(item);
  item.stroke = style.stroke, item.width = style.width;
  if (item.stroke.is_there) to.add(std::move(item));
}

void add_label(FeatureItems& to, const std::string& text, const std::vector<dvec2>& places,
               bool is_line, const FeatureStyle& style) {
  PaintLettering label = style.label;
  label.text = text;
  PaintBox box;
  for (dvec2 place : places) box.add(place);
  if (box.empty()) return;
  label.at = 0.5 * (box.low + box.high);
  if (is_line && places.size() > 1) {
    const size_t middle = (places.size() - 1) / 2;
    dvec2 along = places[middle + 1] - places[middle];
    if (along.x < 0) along = -along;
    label.turn = std::atan2(along.y, along.x);
    label.at = 0.5 * (places[middle] + places[middle + 1]);
  }
  const dvec2 x(std::cos(label.turn), std::sin(label.turn)), y(-x.y, x.x);
  label.at += style.label_shift.x * x + style.label_shift.y * y;
  PaintItem item;
  item.path = letter_path(label), item.fill = style.label_fill;
  to.add(std::move(item));
}

void read_geometry(FieldReader& fields, FeatureItems& to, const MapFrame& frame,
                   const FeatureStyle& style, const std::string& label) {
  std::string type;
  fields.word("type", {"Point", "LineString", "Polygon"}, type, "of GeoJSON", Need::required);
  const auto coordinates = fields.take("coordinates", Need::required);
  if (!coordinates || type.empty()) return;
  std::vector<dvec2> places;
  if (type == "Point") {
    double metres[2];
    if (!coordinates->numbers(2, -farthest_metres, farthest_metres, metres)) return;
    places = {frame.place({metres[0], metres[1]})};
    if (style.symbol >= 0) {
      PaintItem item;
      item.kind = PaintItem::Kind::group, item.symbol = style.symbol, item.brush = style.brush;
      item.placement = {dvec2(style.scale, 0), dvec2(0, style.scale), places[0]};
      to.add(std::move(item));
    }
  } else if (type == "LineString") {
    places = read_places(*coordinates, frame);
    add_line(to, path_through(places, false, style.smooth), style);
  } else {
    PaintPath path;
    for (const JsonValue& ring : coordinates->list(1, 100, "rings")) {
      std::vector<dvec2> corners = read_places(ring, frame);
      if (corners.size() > 1 && corners.front() == corners.back()) corners.pop_back();
      const PaintPath part = path_through(corners, true, style.smooth);
      path.steps.insert(path.steps.end(), part.steps.begin(), part.steps.end());
      path.points.insert(path.points.end(), part.points.begin(), part.points.end());
      if (places.empty()) places = corners;
    }
    if (!path.empty()) add_area(to, std::move(path), style);
  }
  if (!label.empty()) add_label(to, label, places, type == "LineString", style);
}

void read_feature(FieldReader& fields, PaintItem& group, PaintingReading& reading,
                  const MapFrame& frame, const FeatureStyles& styles) {
  std::string type, kind, label;
  fields.word("type", {"Feature"}, type, "of GeoJSON", Need::required);
  fields.part(
      "properties", "kind and name",
      [&](FieldReader& part) {
        part.text("kind", kind, "one of styles", Need::required);
        label = read_label(part, "label", reading);
        if (!kind.empty() && !styles.contains(kind))
          part.fail("kind", "there is no style '" + kind + "'");
      },
      Need::required);
  const auto style = styles.find(kind);
  fields.part(
      "geometry", "its place in metres",
      [&](FieldReader& part) {
        FeatureItems to{group, part, reading};
        if (style != styles.end()) read_geometry(part, to, frame, style->second, label);
      },
      Need::required);
}

}  // namespace

PaintItem read_features(FieldReader& fields, PaintingReading& reading) {
  PaintItem group;
  group.kind = PaintItem::Kind::group;
  MapFrame frame;
  const bool framed = read_map_frame(fields, frame);
  FeatureStyles styles;
  fields.members("styles", "how each kind is drawn",
                 [&](const std::string& kind, FieldReader& one) {
                   if (styles.size() < 100) styles[kind] = read_feature_style(one, reading);
                 });
  fields.part("features", "a FeatureCollection of GeoJSON", [&](FieldReader& part) {
    std::string type;
    part.word("type", {"FeatureCollection"}, type, "of GeoJSON", Need::required);
    part.parts(
        "features", most_features, "drawn one over the other",
        [&](FieldReader& one) {
          if (framed) read_feature(one, group, reading, frame, styles);
        },
        Need::required);
  });
  return group;
}

}  // namespace wellspring::store
