// SPDX-License-Identifier: Apache-2.0
// Reads the items of a painting's layers and symbols.
#include <algorithm>
#include <cmath>

#include "store/painting/geo_style.h"
#include "store/painting/painting_file.h"
#include "store/painting/painting_finish.h"

namespace wellspring::store {

using json::FieldReader;
using json::Need;

namespace {

constexpr double item_degree = double(pi) / 180;
constexpr double farthest_item = 1000;  // widths of the picture

// Reads "move", "scale" (a number or two) and "turn" in degrees.
PaintPlacement read_placement(FieldReader& fields) {
  dvec2 move(0), scale(1);
  double degrees = 0, factor = 1;
  fields.vector("move", farthest_item, move, "where its origin lies");
  const auto found = fields.value().find("scale");
  if (found != fields.value().end() && found->is_array())
    fields.vector("scale", farthest_item, scale, "along x and y");
  else if (fields.number("scale", 1e-9, farthest_item, factor, "how large it is"))
    scale = dvec2(factor);
  if (!(std::abs(scale.x) >= 1e-9 && std::abs(scale.y) >= 1e-9))
    fields.fail("scale", "is too small"), scale = dvec2(1);
  fields.number("turn", -360, 360, degrees, "degrees, clockwise");
  const double turn = item_degree * degrees;
  return {scale.x * dvec2(std::cos(turn), std::sin(turn)),
          scale.y * dvec2(-std::sin(turn), std::cos(turn)), move};
}

void read_letters(FieldReader& fields, PaintItem& item, PaintingReading& reading) {
  PaintLettering lettering;
  lettering.text = read_label(fields, "text", reading);
  fields.vector("at", farthest_item, lettering.at, "where its line begins", Need::required);
  fields.number("size", 1e-9, 10, lettering.size, "of an em", Need::required);
  fields.number("align", 0, 1, lettering.align, "0.5: centred there, 1: ends there");
  fields.word("font", {"serif", "sans", "script"}, lettering.family, "kind of letters");
  fields.boolean("bold", lettering.bold);
  fields.boolean("slanted", lettering.slanted);
  double degrees = 0;
  fields.number("turn", -360, 360, degrees, "degrees, clockwise");
  lettering.turn = item_degree * degrees;
  item.path = letter_path(lettering);
}

void read_outline(FieldReader& fields, PaintItem& item, PaintingReading& reading) {
  if (fields.has("text")) {
    read_letters(fields, item, reading);
  } else if (fields.has("ellipse")) {
    const std::vector<double> n = fields.numbers("ellipse", 4, -farthest_item, farthest_item);
    double degrees = 0;
    fields.number("turn", -360, 360, degrees, "degrees, clockwise");
    if (n.size() == 4) item.path = ellipse_path({n[0], n[1]}, {n[2], n[3]}, item_degree * degrees);
  } else if (fields.has("box")) {
    const std::vector<double> n = fields.numbers("box", 4, -farthest_item, farthest_item);
    if (n.size() == 4)
      item.path = {{'M', 'L', 'L', 'L', 'Z'},
                   {{n[0], n[1]}, {n[2], n[1]}, {n[2], n[3]}, {n[0], n[3]}}};
  } else {
    read_path_field(fields, "path", item.path, Need::required);
  }
  double wobble = 0, period = 0.01;
  fields.number("wobble", 0, 1, wobble, "how far a hand strays from the line");
  fields.number("wobble_period", 1e-9, 10, period, "after which it strays again");
  item.path = wobbled_path(item.path, wobble, period, reading.next_seed());
}

void read_paint_shape(FieldReader& fields, PaintItem& item, PaintingReading& reading) {
  read_outline(fields, item, reading);
  read_ink(fields, "fill", item.fill, reading);
  read_ink(fields, "stroke", item.stroke, reading);
  fields.number("width", 0, 10, item.width, "of the stroke");
}

void read_paint_group(FieldReader& fields, PaintItem& item, PaintingReading& reading) {
  item.kind = PaintItem::Kind::group;
  item.placement = read_placement(fields);
  if (fields.has("clip")) read_path_field(fields, "clip", item.path);
  if (fields.has("include"))
    item.symbol = read_known(fields, "include", "one of symbols", reading.symbols, Need::required);
  if (fields.has("group")) read_paint_items(fields, "group", item.children, reading);
}

void read_paint_repeat(FieldReader& fields, PaintItem& item, PaintingReading& reading) {
  item.kind = PaintItem::Kind::repeat;
  item.symbol = read_known(fields, "repeat", "one of symbols", reading.symbols, Need::required);
  read_path_field(fields, "within", item.path, Need::required);
  fields.number("cell", 1e-9, 10, item.cell, "from one to the next", Need::required);
  item.jitter = 0.8;
  fields.number("jitter", 0, 2, item.jitter, "how far they stray, in cells");
  fields.number("density", 0, 1, item.density, "share of cells that are not left empty");
  dvec2 scale(1), turn(0);
  fields.vector("scale", farthest_item, scale, "from, to");
  fields.vector("turn", 360, turn, "from, to, in degrees");
  item.least_scale = std::max(scale.x, 1e-9), item.most_scale = std::max(scale.y, 1e-9);
  item.least_turn = item_degree * turn.x, item.most_turn = item_degree * turn.y;
  fields.number("shade", 0, 1, item.shade, "how far their lightness varies");
  fields.number("grow", 1e-3, 100, item.grow, "how much larger they are at the lower end");
  item.seed = reading.next_seed();
}

void read_paint_hatch(FieldReader& fields, PaintItem& item, PaintingReading& reading) {
  item.kind = PaintItem::Kind::hatch;
  read_path_field(fields, "hatch", item.path, Need::required);
  fields.number("spacing", 1e-9, 10, item.cell, "from line to line", Need::required);
  double degrees = 0;
  fields.number("angle", -360, 360, degrees, "degrees, clockwise");
  item.angle = item_degree * degrees;
  item.jitter = 0.3;
  fields.number("jitter", 0, 2, item.jitter, "how far lines stray, in spacings");
  fields.number("density", 0, 1, item.density, "share of lines that are not left out");
  item.stroke.is_there = read_color(fields, "stroke", item.stroke.color);
  fields.number("width", 0, 10, item.width, "of a line", Need::required);
  item.seed = reading.next_seed();
}

// Returns whether the item refers to what is there; it is left out otherwise.
bool is_whole_item(const PaintItem& item) {
  if (item.kind == PaintItem::Kind::repeat)
    return item.symbol >= 0 && !item.path.empty() && item.cell > 0;
  if (item.kind == PaintItem::Kind::hatch) return !item.path.empty() && item.cell > 0;
  return true;
}

}  // namespace

PaintItem read_paint_item(FieldReader& fields, PaintingReading& reading) {
  PaintItem item;
  if (fields.has("geojson")) {
    // It is ink on what lies below, and has no brush of its own.
    item = read_geo_item(fields, reading);
    if (!item.geo || !count_item(item, fields, reading)) return {};
    finish_item(item, reading.painting);
    return item;
  }
  if (fields.has("features")) {
    item = read_features(fields, reading);
  } else if (fields.has("group") || fields.has("include")) {
    read_paint_group(fields, item, reading);
  } else if (fields.has("repeat")) {
    read_paint_repeat(fields, item, reading);
  } else if (fields.has("hatch")) {
    read_paint_hatch(fields, item, reading);
  } else {
    read_paint_shape(fields, item, reading);
  }
  if (const int brush = read_known(fields, "brush", "one of brushes", reading.brushes); brush >= 0)
    item.brush = brush;
  if (!count_item(item, fields, reading) || !is_whole_item(item)) return {};
  finish_item(item, reading.painting);
  return item;
}

void read_paint_items(FieldReader& fields, const char* name, std::vector<PaintItem>& items,
                      PaintingReading& reading) {
  fields.parts(name, size_t(most_paint_items), "drawn one over the other",
               [&](FieldReader& one) { items.push_back(read_paint_item(one, reading)); });
}

}  // namespace wellspring::store
