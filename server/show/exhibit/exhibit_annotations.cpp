// SPDX-License-Identifier: Apache-2.0
#include "show/exhibit/exhibit_annotations.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string_view>

#include "base/unicode.h"

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

std::optional<Part> read_target(FieldReader& fields, dvec2 size) {
  const std::optional<JsonValue> target = fields.take("target", Need::required);
  if (!target) return std::nullopt;
  std::string address;
  if (target->value().is_string()) {
    target->text(address, most_address_bytes);
    return read_fragment(address, size);
  }
  std::optional<Part> part;
  FieldReader::read_object(*target, [&](FieldReader& whole) {
    for (const char* other : {"type", "source", "id", "styleClass"}) whole.take(other);
    whole.part("selector", "", [&](FieldReader& selector) {
      std::string type, value;
      selector.text("type", type);
      selector.text("value", value);
      selector.take("conformsTo");
      dvec2 at(-1);
      selector.number("x", 0, 1e9, at.x);
      selector.number("y", 0, 1e9, at.y);
      if (type == "PointSelector" && at.x >= 0 && at.y >= 0) part = Part{at / size, dvec2(0.02)};
      else part = read_fragment(value, size);
    });
  });
  return part;
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

}  // namespace

void read_annotations(Exhibit& exhibit, const ExhibitPiece& piece, const std::string& file,
                      const PointOfInterest& whole, std::vector<Problem>& problems) {
  const PyramidLevel& finest = piece.picture->pyramid->levels().front();
  const dvec2 size(double(finest.width), double(finest.height));
  int number = 0;
  read_fields(file, problems, [&](FieldReader& page) {
    for (const char* other : {"@context", "id", "type", "label"}) page.take(other);
    page.parts("items", most_annotations, "", [&](FieldReader& item) {
      for (const char* other : {"id", "type", "motivation", "created", "creator"}) item.take(other);
      PointOfInterest note;
      note.text = read_bodies(exhibit, item);
      const std::optional<Part> part = read_target(item, size);
      if (!part)
        return item.fail("target", "says no place of the picture, as #xywh=0,0,10,10 does");
      const std::optional<Spot> spot = find_spot(exhibit.scene, piece.image, part->middle);
      if (!spot) return item.fail("target", "is not on what is seen of the picture");
      note.id = piece.id + "." + std::to_string(++number);
      note.node = whole.node;
      note.objects = whole.objects;
      note.place = exhibit.scene.origin + dvec3(spot->place);
      note.half = 0.5f * glm::length(vec2(2.0 * part->half) * vec2(spot->across, spot->down));
      for (const auto& [language, text] : note.text) note.title[language] = first_words(text);
      if (note.title == note.text) note.text.clear();
      exhibit.points.push_back(std::move(note));
    });
  });
}

}  // namespace wellspring::show
