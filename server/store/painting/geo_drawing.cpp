// SPDX-License-Identifier: Apache-2.0
#include "store/painting/geo_drawing.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace wellspring::store {

namespace {

using GeoKind = GeoFeature::Kind;

constexpr double farthest_longitude = 540, farthest_latitude = 90;
constexpr double least_cosine = 0.05;  // bounds that of the middle latitude
constexpr size_t most_simple_styles = 5000;

// Reads "#rgb" or "#rrggbb"; names of colours are not known.
bool read_simple_color(const nlohmann::json& properties, const char* name, PaintColor& color) {
  const auto found = properties.find(name);
  if (found == properties.end() || !found->is_string()) return false;
  std::string text = found->get<std::string>();
  if (text.starts_with("#")) text.erase(0, 1);
  if (text.size() == 3) text = {text[0], text[0], text[1], text[1], text[2], text[2]};
  uint32_t code = 0;
  const char *begin = text.data(), *end = begin + text.size();
  if (text.size() != 6 || std::from_chars(begin, end, code, 16).ptr != end) return false;
  const auto part = [code](int shift) { return float(code >> shift & 255) / 255; };
  color = {part(16), part(8), part(0), color.alpha > 0 ? color.alpha : 1.f};
  return true;
}

bool read_simple_number(const nlohmann::json& properties, const char* name, double most,
                        double& number) {
  const auto found = properties.find(name);
  if (found == properties.end() || !found->is_number()) return false;
  const double read = found->get<double>();
  if (!(read >= 0 && read <= most)) return false;
  return number = read, true;
}

// Returns the style with what a feature says of itself (simplestyle-spec 1.1.0).
GeoStyle simple_style(GeoStyle style, const nlohmann::json& properties, double width) {
  double number = 0;
  read_simple_color(properties, "stroke", style.stroke);
  read_simple_color(properties, "marker-color", style.fill);
  read_simple_color(properties, "fill", style.fill);
  if (read_simple_number(properties, "stroke-width", 200, number)) style.width = number * width;
  if (read_simple_number(properties, "stroke-opacity", 1, number))
    style.stroke.alpha = float(number);
  if (read_simple_number(properties, "fill-opacity", 1, number)) style.fill.alpha = float(number);
  return style;
}

bool has_simple_style(const nlohmann::json& properties) {
  for (const char* name :
       {"stroke", "fill", "marker-color", "stroke-width", "stroke-opacity", "fill-opacity"})
    if (properties.contains(name)) return true;
  return false;
}

// Returns the number of the style that a feature is drawn in.
int style_of(const GeoFeature& feature, GeoStyles& styles) {
  if (!feature.properties) return 0;
  int number = 0;
  const auto kind = feature.properties->find(styles.by);
  if (kind != feature.properties->end() && kind->is_string())
    if (const auto known = styles.known.find(kind->get_ref<const std::string&>());
        known != styles.known.end())
      number = known->second;
  if (styles.simple_width <= 0 || !has_simple_style(*feature.properties)) return number;
  if (styles.styles.size() >= most_simple_styles) return number;
  styles.styles.push_back(
      simple_style(styles.styles[size_t(number)], *feature.properties, styles.simple_width));
  return int(styles.styles.size()) - 1;
}

// Adds a shape for each of the feature's points, lines and polygons.
void add_shapes(const GeoFile& file, const GeoFeature& feature, const GeoFrame& frame, int style,
                const GeoStyle& look, GeoDrawing& drawing) {
  const double half_stroke = 0.5 * std::max(look.width, look.casing_width);
  std::vector<dvec2> places;
  for (size_t k = 0; k < feature.parts; k++) {
    const GeoPart& part = file.parts[feature.first_part + k];
    places.clear();
    for (size_t i = 0; i < part.count; i++)
      places.push_back(frame.place(file.points[part.first + i]));
    if (feature.kind == GeoKind::points) {
      for (dvec2 place : places)
        drawing.shapes.push_back({feature.kind, style, 0, 0, place,
                                  GeoBox{place, place}.grown(look.radius + half_stroke)});
      continue;
    }
    if (part.begins || drawing.shapes.empty())
      drawing.shapes.push_back(
          {feature.kind, style, drawing.outlines.lines.size(), 0, dvec2(0), {}});
    drawing.outlines.add(places.data(), places.size(), feature.kind == GeoKind::areas);
    GeoShape& shape = drawing.shapes.back();
    shape.lines++;
    shape.box.add(drawing.outlines.lines.back().box.grown(half_stroke));
  }
}

}  // namespace

GeoBox geo_bounds(const GeoFile& file) {
  GeoBox box = file.bbox.value_or(file.box);
  if (box.empty()) return {{-180, -90}, {180, 90}};
  const dvec2 size = box.high - box.low;
  const double least =
      std::max({1e-3 * std::max(size.x, size.y), 1e-6, 1e-9 * glm::length(box.high)});
  for (int i = 0; i < 2; i++)
    if (size[i] < least) box.low[i] -= least, box.high[i] += least;
  return box;
}

double geo_aspect(const GeoBox& bounds) {
  const double middle = double(pi) / 180 * 0.5 * (bounds.low.y + bounds.high.y);
  const dvec2 size = bounds.high - bounds.low;
  if (!is_geographic(bounds)) return size.x / size.y;
  return size.x * std::max(std::cos(middle), least_cosine) / size.y;
}

bool is_geographic(const GeoBox& bounds) {
  return bounds.low.x >= -farthest_longitude && bounds.high.x <= farthest_longitude &&
         bounds.low.y >= -farthest_latitude && bounds.high.y <= farthest_latitude;
}

GeoDrawing make_geo_drawing(const GeoFile& file, const GeoFrame& frame, GeoStyles styles,
                            const std::string& language) {
  GeoDrawing drawing;
  drawing.frame = frame.frame;
  for (const GeoFeature& feature : file.features) {
    const int style = style_of(feature, styles);
    const GeoStyle& look = styles.styles[size_t(style)];
    const size_t first = drawing.shapes.size();
    add_shapes(file, feature, frame, style, look, drawing);
    if (!feature.is_first || look.label.size <= 0 || drawing.names.size() >= most_geo_names)
      continue;
    add_geo_languages(feature.properties, look.label.properties, drawing.languages);
    const std::string text = geo_text(feature.properties, look.label.properties, language);
    if (!text.empty()) add_geo_name(drawing, first, look, text);
  }
  drawing.styles = std::move(styles.styles);
  std::vector<GeoBox> boxes;
  for (const GeoShape& shape : drawing.shapes) boxes.push_back(shape.box);
  drawing.shape_tree = GeoBoxTree(boxes);
  boxes.clear();
  for (const GeoName& name : drawing.names) boxes.push_back(name.box);
  drawing.name_tree = GeoBoxTree(std::move(boxes));
  return drawing;
}

}  // namespace wellspring::store
