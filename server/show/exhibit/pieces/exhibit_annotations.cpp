// SPDX-License-Identifier: Apache-2.0
#include "show/exhibit/pieces/exhibit_annotations.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string_view>

#include "base/unicode.h"
#include "show/exhibit/pieces/exhibit_scans.h"

namespace wellspring::show {
namespace {

constexpr size_t longest_title = 90;  // bytes; the first words of a longer note are its title

// Holds where a picture's place is in the world, and metres for each unit of its coordinates.
struct Spot {
  vec3 place{0};
  float across = 0, down = 0;
};

// Finds a place of the picture, 0 to 1 from its upper left, on the surfaces that show it.
std::optional<Spot> find_spot(const Scene& scene, int image, dvec2 at) {
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[size_t(instance.mesh)];
    const TextureRef& reference = scene.materials[size_t(mesh.material)].base_color_texture;
    const std::vector<vec2>& set = mesh.uv[reference.uv_set];
    if (reference.texture < 0 || set.empty()) continue;
    if (scene.textures[size_t(reference.texture)].image != image) continue;
    for (const uvec3& t : mesh.triangles) {
      dvec2 uv[3];
      dvec3 place[3];
      for (int i = 0; i < 3; i++) {
        uv[i] = dvec2(reference.uv_transform * vec3(set[t[i]], 1));
        place[i] = dvec3(instance.to_world * vec4(mesh.positions[t[i]], 1));
      }
      const glm::dmat2 edges(uv[1] - uv[0], uv[2] - uv[0]);
      if (!(std::abs(glm::determinant(edges)) > 1e-12)) continue;
      const glm::dmat2 to_weights = glm::inverse(edges);
      const dvec2 weights = to_weights * (at - uv[0]);
      constexpr double edge = 1e-6;
      if (weights.x < -edge || weights.y < -edge || weights.x + weights.y > 1 + edge) continue;
      const dvec3 right = place[1] - place[0], below = place[2] - place[0];
      auto metres = [&](dvec2 w) { return float(length(right * w.x + below * w.y)); };
      return Spot{vec3(place[0] + right * weights.x + below * weights.y), metres(to_weights[0]),
                  metres(to_weights[1])};
    }
  }
  return std::nullopt;
}

// Holds a part of a picture: its middle and half sides, 0 to 1.
struct Part {
  dvec2 middle{0}, half{0};
};

// Reads "xywh=10,20,30,40", "xywh=pixel:..." or "xywh=percent:..." (W3C Media Fragments 4.2.2).
std::optional<Part> read_fragment(std::string_view text, dvec2 size) {
  const size_t begin = text.find("xywh=");
  if (begin == std::string_view::npos) return std::nullopt;
  std::string numbers(text.substr(begin + 5));
  dvec2 scale = 1.0 / size;
  for (const std::string_view unit : {"pixel:", "percent:"})
    if (numbers.starts_with(unit)) {
      numbers.erase(0, unit.size());
      if (unit == "percent:") scale = dvec2(0.01);
    }
  double x, y, w, h;
  if (std::sscanf(numbers.c_str(), "%lf,%lf,%lf,%lf", &x, &y, &w, &h) != 4) return std::nullopt;
  return Part{dvec2(x + 0.5 * w, y + 0.5 * h) * scale, dvec2(w, h) * 0.5 * scale};
}

// Holds what a target names: a part of a picture, or a point of a scan.
struct Target {
  std::optional<Part> part;
  std::optional<dvec3> point;
};

void read_selector(FieldReader& fields, dvec2 size, Target& target) {
  constexpr double most = 1e9;
  std::string type, value;
  fields.text("type", type);
  fields.text("value", value);
  for (const char* other : {"id", "conformsTo"}) fields.take(other);
  dvec3 at(NAN);
  fields.number("x", -most, most, at.x);
  fields.number("y", -most, most, at.y);
  fields.number("z", -most, most, at.z);
  if (type != "PointSelector") target.part = read_fragment(value, size);
  else if (std::isfinite(at.x + at.y + at.z)) target.point = at;
  else if (at.x >= 0 && at.y >= 0) target.part = Part{dvec2(at) / size, dvec2(0.02)};
}

Target read_target(FieldReader& fields, dvec2 size) {
  const std::optional<JsonValue> value = fields.take("target", Need::required);
  Target target;
  if (!value) return target;
  std::string address;
  if (value->value().is_string()) {
    value->text(address, most_address_bytes);
    target.part = read_fragment(address, size);
    return target;
  }
  FieldReader::read_object(*value, [&](FieldReader& whole) {
    for (const char* other : {"type", "source", "id", "styleClass"}) whole.take(other);
    const std::optional<JsonValue> selector = whole.take("selector");
    if (!selector) return;
    auto read = [&](const JsonValue& one) {
      FieldReader::read_object(one, [&](FieldReader& all) { read_selector(all, size, target); });
    };
    if (!selector->value().is_array()) read(*selector);
    else
      for (const JsonValue& one : selector->list(1, 16)) read(one);
  });
  return target;
}

// Reads a body, or several of them, as texts by language.
LocalText read_bodies(const Exhibit& exhibit, FieldReader& fields) {
  LocalText text;
  const std::optional<JsonValue> body = fields.take("body", Need::required);
  if (!body) return text;
  auto read = [&](const JsonValue& one) {
    FieldReader::read_object(one, [&](FieldReader& parts) {
      std::string value, language;
      for (const char* other : {"type", "format", "purpose", "id"}) parts.take(other);
      parts.text("value", value, "", Need::required, most_local_text_bytes);
      parts.text("language", language);
      if (!is_language_tag(language)) language = exhibit.languages.front();
      std::string& all = text[language];
      all += (all.empty() ? "" : "\n") + value;
    });
  };
  if (!body->value().is_array()) read(*body);
  else
    for (const JsonValue& one : body->list(1, 16)) read(one);
  return text;
}

// Returns the first words, as many as a title has room for.
std::string first_words(const std::string& text) {
  if (text.size() <= longest_title) return text;
  const size_t end = text.find_last_of(" \n", longest_title);
  return text.substr(0, end == std::string::npos ? longest_title : end) + " …";
}

constexpr float note_size = 0.3f;  // metres around a note on a scan
constexpr double beside = 1;       // metres off a scan's box that a note may lie

// Puts a note where the target lies on what is seen of a picture. Returns what is wrong.
std::string put_on_picture(const Exhibit& exhibit, const ExhibitPiece& piece, const Target& target,
                           PointOfInterest& note) {
  if (!target.part) return "says no place of the picture, as #xywh=0,0,10,10 does";
  const std::optional<Spot> spot = find_spot(exhibit.scene, piece.image, target.part->middle);
  if (!spot) return "is not on what is seen of the picture";
  note.place = exhibit.scene.origin + dvec3(spot->place);
  note.half = 0.5f * glm::length(vec2(2.0 * target.part->half) * vec2(spot->across, spot->down));
  return {};
}

// Puts a note where the target lies in a scan's own coordinates. Returns what is wrong.
std::string put_in_scan(const Exhibit& exhibit, const ExhibitPiece& piece, const Target& target,
                        PointOfInterest& note) {
  if (!target.point) return "says no place of the scan, as a PointSelector with x, y and z does";
  note.place = dvec3(file_to_world(piece) * glm::dvec4(*target.point, 1));
  note.half = note_size;
  const Bounds box = bounds_of_scan(exhibit, piece);
  const dvec3 at = note.place - exhibit.scene.origin;
  for (int axis = 0; axis < 3; axis++)
    if (at[axis] < double(box.low[axis]) - beside || at[axis] > double(box.high[axis]) + beside)
      return "lies outside the scan";
  return {};
}

}  // namespace

void read_annotations(Exhibit& exhibit, const ExhibitPiece& piece, const std::string& file,
                      const PointOfInterest& whole, std::vector<Problem>& problems) {
  dvec2 size(1);
  if (piece.picture) {
    const PyramidLevel& finest = piece.picture->pyramid->levels().front();
    size = {double(finest.width), double(finest.height)};
  }
  int number = 0;
  read_fields(file, problems, [&](FieldReader& page) {
    for (const char* other : {"@context", "id", "type", "label"}) page.take(other);
    page.parts("items", most_annotations, "", [&](FieldReader& item) {
      for (const char* other : {"id", "type", "motivation", "created", "creator"}) item.take(other);
      PointOfInterest note;
      note.text = read_bodies(exhibit, item);
      const Target target = read_target(item, size);
      const std::string wrong = piece.picture ? put_on_picture(exhibit, piece, target, note)
                                              : put_in_scan(exhibit, piece, target, note);
      if (!wrong.empty()) return item.fail("target", wrong);
      note.id = piece.id + "." + std::to_string(++number);
      note.node = whole.node;
      note.objects = whole.objects;
      for (const auto& [language, text] : note.text) note.title[language] = first_words(text);
      if (note.title == note.text) note.text.clear();
      exhibit.points.push_back(std::move(note));
    });
  });
}

}  // namespace wellspring::show
