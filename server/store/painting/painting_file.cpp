// SPDX-License-Identifier: Apache-2.0
#include "store/painting/painting_file.h"

#include <algorithm>
#include <charconv>
#include <filesystem>

#include "base/load_error.h"
#include "base/unicode.h"
#include "store/painting/painting_finish.h"

namespace wellspring::store {

using json::FieldReader;
using json::Need;

namespace {

constexpr double painting_degree = double(pi) / 180;
constexpr double farthest_gradient = 100;  // widths of the picture
constexpr double longest_brush = 0.5;      // bounds a brush's stroke
constexpr size_t most_paint_languages = 100;
constexpr double most_slender = 20;  // length of a brush's stroke by its width

void read_paint_gradient(const std::string& name, FieldReader& fields, PaintingReading& reading) {
  PaintGradient gradient;
  fields.vector("from", farthest_gradient, gradient.from, "where it begins; a radial one's middle",
                Need::required);
  gradient.radial =
      fields.number("radius", 1e-9, farthest_gradient, gradient.radius, "makes it radial");
  if (!gradient.radial)
    fields.vector("to", farthest_gradient, gradient.to, "where it ends", Need::required);
  double last = 0;
  fields.parts(
      "stops", 16, "colours along it",
      [&](FieldReader& stop) {
        PaintGradient::Stop one;
        stop.number("at", last, 1, one.at, "0 to 1, not falling", Need::required);
        read_color(stop, "color", one.color);
        last = one.at;
        gradient.stops.push_back(one);
      },
      Need::required);
  if (gradient.stops.empty()) fields.fail("stops", "a gradient has colours");
  if (reading.painting.gradients.size() >= size_t(most_paint_gradients))
    fields.JsonValue::fail("a painting has too many gradients");
  reading.gradients[name] = int(reading.painting.gradients.size());
  reading.painting.gradients.push_back(std::move(gradient));
}

void read_paint_brush(const std::string& name, FieldReader& fields, PaintingReading& reading) {
  PaintBrush brush;
  fields.number("width", 1e-5, longest_brush, brush.width, "metres", Need::required);
  fields.number("length", brush.width, std::min(longest_brush, most_slender * brush.width),
                brush.length, "metres", Need::required);
  double degrees = 0, turn = 0, tone = 0, warmth = 0, impasto = 0;
  fields.number("angle", -360, 360, degrees, "degrees from the right, clockwise");
  fields.number("turn", 0, 360, turn, "degrees by which the direction wanders");
  brush.angle = painting_degree * degrees, brush.turn = painting_degree * turn;
  brush.around = fields.vector("around", farthest_gradient, brush.middle, "strokes go round it");
  fields.number("tone", 0, 0.5, tone, "how far lightness varies");
  fields.number("warmth", 0, 0.5, warmth, "how far the tint varies");
  fields.number("impasto", 0, 1, impasto, "height of paint by the stroke's width");
  brush.tone = float(tone), brush.warmth = float(warmth), brush.impasto = float(impasto);
  fields.number("smear", 0, 0.05, brush.smear, "metres by which colours are drawn along");
  fields.integer("octaves", 1, 4, brush.octaves, "sizes of strokes, each three times as large");
  if (reading.painting.brushes.size() >= size_t(most_paint_brushes))
    fields.JsonValue::fail("a painting has too many brushes");
  reading.brushes[name] = int(reading.painting.brushes.size());
  reading.painting.brushes.push_back(brush);
}

void read_paint_symbol(const std::string& name, FieldReader& fields, PaintingReading& reading) {
  PaintItem symbol;
  symbol.kind = PaintItem::Kind::group;
  read_paint_items(fields, "items", symbol.children, reading);
  symbol.brush = read_known(fields, "brush", "one of brushes", reading.brushes);
  finish_item(symbol, reading.painting);
  if (reading.painting.symbols.size() >= size_t(most_symbols))
    fields.JsonValue::fail("a painting has too many symbols");
  reading.symbols[name] = int(reading.painting.symbols.size());
  reading.painting.symbols.push_back(std::move(symbol));
}

void read_paint_material(FieldReader& fields, PaintMaterial& material) {
  const auto depth = [](FieldReader& part, float& to) {
    double depth = 0;
    part.number("depth", 0, 1, depth, "how far it darkens", Need::required);
    to = float(depth);
  };
  fields.part("cracks", "of the paint", [&](FieldReader& part) {
    part.number("cell", 1e-4, 1, material.crack_cell, "metres across an island", Need::required);
    part.number("width", 1e-7, 1e-2, material.crack_width, "metres", Need::required);
    depth(part, material.crack_depth);
  });
  fields.part("weave", "of the canvas", [&](FieldReader& part) {
    part.number("period", 1e-5, 1, material.weave, "metres from thread to thread", Need::required);
    depth(part, material.weave_depth);
  });
  fields.part("grain", "of paper or ground", [&](FieldReader& part) {
    part.number("period", 1e-5, 1, material.grain, "metres from spot to spot", Need::required);
    depth(part, material.grain_depth);
    part.integer("octaves", 1, 10, material.grain_octaves, "each twice as large");
  });
}

void read_paint_layer(FieldReader& fields, PaintingReading& reading) {
  PaintLayer layer;
  fields.name("name", layer.name, "by which it is opened", Need::required);
  read_color(fields, "ground", layer.ground);
  fields.boolean("gray", layer.gray, "colours are seen as their lightness");
  fields.part("material", "what age and ground do",
              [&](FieldReader& part) { read_paint_material(part, layer.material); });
  read_paint_items(fields, "items", layer.items, reading);
  reading.painting.layers.push_back(std::move(layer));
}

void read_painting_root(FieldReader& root, PaintingReading& reading) {
  Painting& painting = reading.painting;
  root.integer("width", double(least_painting), double(longest_painting), painting.width, "texels",
               Need::required);
  root.integer("height", double(least_painting), double(longest_painting), painting.height,
               "texels", Need::required);
  root.number("metres", 0.01, 100, painting.metres, "its width", Need::required);
  uint32_t seed = 0;
  root.u32("seed", seed, "of all that is random");
  painting.seed = seed;
  root.members("gradients", "colours that change", [&](const std::string& name, FieldReader& one) {
    read_paint_gradient(name, one, reading);
  });
  root.members("brushes", "how paint is put on", [&](const std::string& name, FieldReader& one) {
    read_paint_brush(name, one, reading);
  });
  root.parts("symbols", size_t(most_symbols), "groups that are used again", [&](FieldReader& one) {
    std::string name;
    one.name("name", name, "by which items include it", Need::required);
    read_paint_symbol(name, one, reading);
  });
  root.parts(
      "layers", 8, "pictures one below the other",
      [&](FieldReader& one) { read_paint_layer(one, reading); }, Need::required);
  if (painting.layers.empty()) root.fail("layers", "a painting has a layer");
}

}  // namespace

bool read_path_field(FieldReader& fields, const char* name, PaintPath& path, Need need) {
  constexpr size_t most_bytes = 60000;
  std::string text;
  if (!fields.text(name, text, "letters M, L, C, R, Z and coordinates", need, most_bytes))
    return false;
  const std::string wrong = read_paint_path(text, path);
  if (!wrong.empty()) fields.fail(name, wrong);
  return wrong.empty();
}

bool read_color(FieldReader& fields, const char* name, PaintColor& color) {
  std::string text;
  if (!fields.text(name, text, "#rrggbb or #rrggbbaa")) return false;
  uint32_t code = 0;
  const char *begin = text.data() + 1, *end = text.data() + text.size();
  const bool sized = text.size() == 7 || text.size() == 9;
  if (!sized || text[0] != '#' || std::from_chars(begin, end, code, 16).ptr != end) {
    fields.fail(name, "is not a colour like #c0a080 or #c0a08080");
    return false;
  }
  if (text.size() == 7) code = code << 8 | 255;
  const auto part = [code](int shift) { return float(code >> shift & 255) / 255; };
  color = {part(24), part(16), part(8), part(0)};
  return true;
}

void read_ink(FieldReader& fields, const char* name, PaintInk& ink,
              const PaintingReading& reading) {
  const nlohmann::json& value = fields.value();
  const auto found = value.find(name);
  if (found != value.end() && found->is_string() &&
      found->get_ref<const std::string&>().starts_with("@")) {
    std::string text;
    if (!fields.text(name, text)) return;
    const auto gradient = reading.gradients.find(text.substr(1));
    if (gradient == reading.gradients.end())
      return fields.fail(name, "there is no gradient '" + text.substr(1) + "'");
    ink.gradient = gradient->second;
    ink.is_there = true;
  } else {
    ink.is_there = read_color(fields, name, ink.color);
  }
}

int read_known(FieldReader& fields, const char* name, const char* about,
               const std::map<std::string, int, std::less<>>& known, Need need) {
  std::string text;
  if (!fields.text(name, text, about, need)) return -1;
  if (const auto found = known.find(text); found != known.end()) return found->second;
  std::vector<std::string> names;
  for (const auto& one : known) names.push_back(one.first);
  fields.fail(name, "there is no '" + text + "' before it" + did_you_mean(text, names));
  return -1;
}

std::string read_label(FieldReader& fields, const char* name, PaintingReading& reading) {
  const std::string& language = reading.language;
  std::string text;
  const auto found = fields.value().find(name);
  if (found == fields.value().end() || !found->is_object()) {
    fields.text(name, text, "what is written");
    return text;
  }
  fields.part(name, "what is written, by language", [&](FieldReader& words) {
    for (const auto& [tongue, value] : words.members()) {
      std::string word;
      if (reading.languages.size() < most_paint_languages) reading.languages.insert(tongue);
      if (value.text(word) && (text.empty() || tongue == "en" || tongue == language)) {
        const bool better = text.empty() || tongue == language || !words.has(language.c_str());
        if (better) text = word;
      }
    }
  });
  return text;
}

bool count_item(const PaintItem& item, const FieldReader& fields, PaintingReading& reading) {
  reading.items++;
  reading.points += int(item.path.points.size());
  reading.groups += item.kind == PaintItem::Kind::group;
  reading.repeats += item.kind == PaintItem::Kind::repeat;
  if (reading.items > most_paint_items) fields.JsonValue::fail("a painting has too many items");
  else if (reading.points > most_painting_points)
    fields.JsonValue::fail("a painting has too many points");
  else if (reading.groups > most_paint_groups)
    fields.JsonValue::fail("a painting has too many groups");
  else if (reading.repeats > most_repeats)
    fields.JsonValue::fail("a painting has too many repeats");
  else return true;
  return false;
}

Painting read_painting(const std::string& path, const std::string& language) {
  const std::string text = json::read_json_text(path);
  const nlohmann::json value = json::parse_json_file(path, text);
  json::Faults faults(path, true, text);
  PaintingReading reading;
  reading.language = language;
  reading.folder = std::filesystem::path(path).parent_path().string();
  const json::JsonValue root(value, faults);
  FieldReader::read_object(root, [&](FieldReader& fields) { read_painting_root(fields, reading); });
  reading.painting.languages.assign(reading.languages.begin(), reading.languages.end());
  return std::move(reading.painting);
}

}  // namespace wellspring::store
