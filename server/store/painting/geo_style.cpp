// SPDX-License-Identifier: Apache-2.0
#include "store/painting/geo_style.h"

#include <algorithm>
#include <filesystem>

#include "store/painting/painting_finish.h"

namespace wellspring::store {

using json::FieldReader;
using json::JsonValue;
using json::Need;

namespace {

constexpr double most_millimetres = 1000;
constexpr size_t most_geo_styles = 100, most_label_properties = 16;
constexpr int most_geo_items = 8;  // in a painting

// Reads a length in millimetres as a share of the picture's width.
void read_length(FieldReader& fields, const char* name, const char* about, double millimetre,
                 double& to) {
  double length = 0;
  if (fields.number(name, 0, most_millimetres, length, about)) to = length * millimetre;
}

void read_geo_label(FieldReader& fields, double millimetre, GeoLettering& label) {
  read_length(fields, "size_mm", "of an em; 0: no names", millimetre, label.size);
  fields.word("font", {"serif", "sans", "script"}, label.family, "kind of letters");
  fields.boolean("bold", label.bold);
  fields.boolean("slanted", label.slanted);
  read_color(fields, "fill", label.fill);
  read_color(fields, "halo", label.halo);
  read_length(fields, "halo_mm", "how far it reaches around letters", millimetre, label.halo_width);
  dvec2 shift(0);
  if (fields.vector("shift_mm", most_millimetres, shift, "to the right and down"))
    label.shift = shift * millimetre;
  fields.boolean("overlap", label.overlaps, "names may lie over earlier ones");
  const std::vector<JsonValue> names =
      fields.list("properties", 1, most_label_properties,
                  "names of properties, the first that is there; {language} is replaced");
  if (names.empty()) return;
  label.properties.clear();
  for (const JsonValue& name : names) {
    std::string text;
    if (name.text(text, 100, Need::required)) label.properties.push_back(text);
  }
}

void read_geo_style(FieldReader& fields, double millimetre, GeoStyle& style) {
  read_color(fields, "fill", style.fill);
  read_color(fields, "stroke", style.stroke);
  read_length(fields, "width_mm", "of lines", millimetre, style.width);
  read_color(fields, "casing", style.casing);
  read_length(fields, "casing_mm", "width of the line below a line", millimetre,
              style.casing_width);
  dvec2 dash(0);
  if (fields.vector("dash_mm", most_millimetres, dash, "dash and gap")) {
    if (dash.x > 0 && dash.y > 0) style.dash = {dash.x * millimetre, dash.y * millimetre};
    else fields.fail("dash_mm", "is the lengths of a dash and of a gap, above 0");
  }
  read_length(fields, "radius_mm", "of points", millimetre, style.radius);
  fields.part("label", "how names are written",
              [&](FieldReader& part) { read_geo_label(part, millimetre, style.label); });
}

// Returns the path of a file beside the painting; empty: it is none, which is noted.
std::string geo_path(FieldReader& fields, const PaintingReading& reading) {
  namespace fs = std::filesystem;
  std::string name;
  if (!fields.text("geojson", name, "a file beside this one", Need::required)) return "";
  const fs::path path(name);
  bool stays = path.is_relative() && !name.empty();
  for (const fs::path& part : path) stays = stays && part != "..";
  if (!stays) fields.fail("geojson", "is no file in the painting's folder");
  return stays ? (fs::path(reading.folder) / path).string() : "";
}

// Puts a map of this aspect into the middle of a box.
PaintBox fit_into(const PaintBox& box, double aspect) {
  const dvec2 size = box.high - box.low, middle = 0.5 * (box.low + box.high);
  const dvec2 half =
      0.5 * dvec2(std::min(size.x, size.y * aspect), std::min(size.y, size.x / aspect));
  return {middle - half, middle + half};
}

// Reads four numbers, of which the first two lie below the last two; false: there are none.
bool read_box(FieldReader& fields, const char* name, double limit, const char* sides, dvec2& low,
              dvec2& high) {
  if (!fields.has(name)) return false;
  const std::vector<double> n = fields.numbers(name, 4, -limit, limit);
  if (n.size() != 4) return false;
  constexpr double least = 1e-9;
  if (n[2] - n[0] < least || n[3] - n[1] < least) {
    fields.fail(name, std::string("is ") + sides + ", the first two below the last two");
    return false;
  }
  low = {n[0], n[1]}, high = {n[2], n[3]};
  return true;
}

}  // namespace

GeoStyle plain_geo_style(double millimetre) {
  GeoStyle style;
  style.fill = {0.42f, 0.53f, 0.42f, 0.25f};
  style.stroke = {0.24f, 0.22f, 0.2f, 1};
  style.width = 0.8 * millimetre, style.radius = 2 * millimetre;
  style.label.size = 9 * millimetre, style.label.family = "sans";
  style.label.halo = {1, 1, 1, 0.8f}, style.label.halo_width = 0.8 * millimetre;
  return style;
}

PaintItem read_geo_item(FieldReader& fields, PaintingReading& reading) {
  const Painting& painting = reading.painting;
  const double millimetre = 0.001 / painting.metres;
  const std::string path = geo_path(fields, reading);
  GeoFrame frame;
  const bool bounded = read_box(fields, "bounds", farthest_geo, "west, south, east and north",
                                frame.bounds.low, frame.bounds.high);
  frame.frame = {{0, 0}, {1, double(painting.height) / double(painting.width)}};
  const bool framed = read_box(fields, "frame", 10, "left, top, right and bottom", frame.frame.low,
                               frame.frame.high);
  GeoStyles styles;
  fields.text("style_by", styles.by, "property that names a feature's style");
  fields.part("style", "how features are drawn",
              [&](FieldReader& part) { read_geo_style(part, millimetre, styles.styles[0]); });
  fields.members("styles", "of kinds of features, each with what differs from style",
                 [&](const std::string& kind, FieldReader& one) {
                   if (styles.styles.size() > most_geo_styles) return;
                   GeoStyle style = styles.styles[0];
                   read_geo_style(one, millimetre, style);
                   styles.known[kind] = int(styles.styles.size());
                   styles.styles.push_back(std::move(style));
                 });
  PaintItem item;
  item.kind = PaintItem::Kind::geo;
  if (path.empty()) return item;
  if (++reading.geo_items > most_geo_items) {
    fields.JsonValue::fail("a painting has too many GeoJSON files");
    return item;
  }
  const GeoFile file = read_geojson(path);
  if (!bounded) {
    frame.bounds = geo_bounds(file);
    if (!is_geographic(frame.bounds))
      fields.JsonValue::fail("the file has no longitudes and latitudes: give their \"bounds\"");
  }
  // With both of them the curator says how the map lies; else it keeps its shape.
  if (!(bounded && framed)) frame.frame = fit_into(frame.frame, geo_aspect(frame.bounds));
  item.geo = std::make_shared<const GeoDrawing>(
      make_geo_drawing(file, frame, std::move(styles), reading.language));
  reading.languages.insert(item.geo->languages.begin(), item.geo->languages.end());
  return item;
}

}  // namespace wellspring::store
