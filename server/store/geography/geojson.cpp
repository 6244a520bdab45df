// SPDX-License-Identifier: Apache-2.0
#include "store/geography/geojson.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "base/load_error.h"
#include "json/fields.h"
#include "json/text.h"

namespace wellspring::store {

namespace {

using GeoValue = nlohmann::json;

constexpr size_t most_geo_values = 4000000;  // JSON values of a file
constexpr size_t most_name_bytes = 200;
constexpr std::string_view language_mark = "{language}";

// Names a place in the file; it is put into words only for a fault.
struct GeoPlace {
  const GeoPlace* outer = nullptr;
  const char* name = nullptr;  // null: an entry of a list
  size_t index = 0;
  std::string text() const {
    if (!outer) return "";
    return outer->text() + "/" + (name ? name : std::to_string(index));
  }
};

class GeoReader {
 public:
  GeoReader(const std::string& file, const std::string& text, GeoFile& to)
      : faults_(file, false, text), to_(to) {}

  void read_root() {
    const GeoPlace root;
    read_object(to_.root, root);
    if (to_.root.contains("bbox")) read_bbox(to_.root["bbox"], {&root, "bbox"});
  }

 private:
  [[noreturn]] void fail(const GeoPlace& at, const std::string& what) {
    faults_.add(at.text(), what);
    throw std::logic_error("a fault was kept");
  }
  const GeoValue& member(const GeoValue& object, const GeoPlace& at, const char* name) {
    const auto found = object.find(name);
    if (found == object.end()) fail(at, std::string("has no \"") + name + "\"");
    return *found;
  }
  std::string type_of(const GeoValue& object, const GeoPlace& at) {
    if (!object.is_object()) fail(at, "is no object of GeoJSON");
    const GeoValue& type = member(object, at, "type");
    if (!type.is_string()) fail({&at, "type"}, "is no text");
    return type.get<std::string>();
  }
  const GeoValue& list_of(const GeoValue& value, const GeoPlace& at) {
    if (!value.is_array()) fail(at, "is no list");
    return value;
  }

  void read_object(const GeoValue& object, const GeoPlace& at) {
    const std::string type = type_of(object, at);
    if (type == "FeatureCollection") {
      const GeoPlace features{&at, "features"};
      size_t index = 0;
      for (const GeoValue& one : list_of(member(object, at, "features"), features)) {
        const GeoPlace place{&features, nullptr, index++};
        if (type_of(one, place) != "Feature") fail({&place, "type"}, "is not \"Feature\"");
        read_feature(one, place);
      }
    } else if (type == "Feature") {
      read_feature(object, at);
    } else {
      bool is_first = true;
      read_geometry(object, at, nullptr, 0, is_first);
    }
  }

  void read_feature(const GeoValue& feature, const GeoPlace& at) {
    const GeoValue& geometry = member(feature, at, "geometry");
    const GeoValue* properties = nullptr;
    if (const auto found = feature.find("properties"); found != feature.end()) {
      if (!found->is_object() && !found->is_null())
        fail({&at, "properties"}, "is neither an object nor null");
      if (found->is_object()) properties = &*found;
    }
    if (geometry.is_null()) return;  // a feature without a place
    bool is_first = true;
    read_geometry(geometry, {&at, "geometry"}, properties, 0, is_first);
  }

  void read_geometry(const GeoValue& geometry, const GeoPlace& at, const GeoValue* properties,
                     int depth, bool& is_first) {
    const std::string type = type_of(geometry, at);
    if (type == "GeometryCollection") {
      if (depth >= most_geo_depth) fail(at, "collections lie too deep within one another");
      const GeoPlace list{&at, "geometries"};
      size_t index = 0;
      for (const GeoValue& one : list_of(member(geometry, at, "geometries"), list))
        read_geometry(one, {&list, nullptr, index++}, properties, depth + 1, is_first);
      return;
    }
    constexpr const char* types[] = {"Point",           "MultiPoint", "LineString",
                                     "MultiLineString", "Polygon",    "MultiPolygon"};
    if (std::ranges::find(types, type) == std::end(types))
      fail({&at, "type"}, "'" + type.substr(0, 40) + "' is no geometry of GeoJSON");
    if (to_.features.size() >= most_geo_features)
      fail(at, "there are more than " + std::to_string(most_geo_features) + " features");
    GeoFeature feature;
    feature.properties = properties;
    feature.first_part = to_.parts.size();
    feature.is_first = is_first;
    const GeoPlace place{&at, "coordinates"};
    const GeoValue& coordinates = list_of(member(geometry, at, "coordinates"), place);
    using enum GeoFeature::Kind;
    if (type == "Point") {
      feature.kind = points;
      const size_t first = to_.points.size();
      if (!coordinates.empty()) add_part({first, read_position(coordinates, place), true});
    } else if (type == "MultiPoint") {
      feature.kind = points, read_line(coordinates, place, 0);
    } else if (type == "LineString") {
      feature.kind = lines, read_line(coordinates, place, 2);
    } else if (type == "MultiLineString") {
      feature.kind = lines;
      for (size_t i = 0; i < coordinates.size(); i++)
        read_line(coordinates[i], {&place, nullptr, i}, 2);
    } else if (type == "Polygon") {
      feature.kind = areas, read_polygon(coordinates, place);
    } else {
      feature.kind = areas;
      for (size_t i = 0; i < coordinates.size(); i++)
        read_polygon(coordinates[i], {&place, nullptr, i});
    }
    feature.parts = to_.parts.size() - feature.first_part;
    if (feature.parts == 0) return;  // empty coordinates are allowed, and nowhere
    to_.features.push_back(feature);
    is_first = false;
  }

  void add_part(const GeoPart& part) {
    if (part.count > 0) to_.parts.push_back(part);
  }

  // Reads a position, and returns 1.
  size_t read_position(const GeoValue& value, const GeoPlace& at) {
    if (!value.is_array() || value.size() < 2)
      fail(at, "is no position: a list of two numbers or more");
    dvec2 point;
    for (int i = 0; i < 2; i++) {
      const GeoValue& number = value[size_t(i)];
      point[i] = number.is_number() ? number.get<double>() : NAN;
      if (!(std::abs(point[i]) <= farthest_geo))
        fail({&at, nullptr, size_t(i)}, "is no coordinate: a number of at most 1e8");
    }
    if (to_.points.size() >= most_geo_points)
      fail(at, "there are more than " + std::to_string(most_geo_points) + " positions");
    to_.points.push_back(point);
    to_.box.add(point);
    return 1;
  }

  void read_line(const GeoValue& list, const GeoPlace& at, size_t least) {
    if (list_of(list, at).empty()) return;
    if (list.size() < least) fail(at, "a line has two positions or more");
    GeoPart part{to_.points.size(), 0, true};
    for (size_t i = 0; i < list.size(); i++)
      part.count += read_position(list[i], {&at, nullptr, i});
    add_part(part);
  }

  void read_polygon(const GeoValue& rings, const GeoPlace& at) {
    list_of(rings, at);
    const size_t first = to_.parts.size();
    for (size_t i = 0; i < rings.size(); i++) {
      const GeoPlace place{&at, nullptr, i};
      const GeoValue& ring = list_of(rings[i], place);
      if (ring.empty()) continue;
      if (ring.size() < 4) fail(place, "a ring has four positions or more, the last as the first");
      GeoPart part{to_.points.size(), 0, to_.parts.size() == first};
      for (size_t k = 0; k < ring.size(); k++)
        part.count += read_position(ring[k], {&place, nullptr, k});
      if (to_.points[part.first] != to_.points.back())
        fail(place, "a ring ends at the position where it begins");
      to_.points.pop_back(), part.count--;
      add_part(part);
    }
  }

  void read_bbox(const GeoValue& value, const GeoPlace& at) {
    if (!value.is_array() || (value.size() != 4 && value.size() != 6))
      fail(at, "is no list of four or six numbers");
    double n[6];
    for (size_t i = 0; i < value.size(); i++) {
      n[i] = value[i].is_number() ? value[i].get<double>() : NAN;
      if (!(std::abs(n[i]) <= farthest_geo))
        fail({&at, nullptr, i}, "is no coordinate: a number of at most 1e8");
    }
    const size_t half = value.size() / 2;
    const GeoBox box{{n[0], n[1]}, {n[half], n[half + 1]}};
    // One that goes round the back of the earth, from east to west, is left to the points.
    if (!box.empty()) to_.bbox = box;
  }

  json::Faults faults_;
  GeoFile& to_;
};

// Returns a text without control characters, cut to a length at the beginning of a letter.
std::string plain_text(const GeoValue& value) {
  std::string text = value.is_string()   ? value.get<std::string>()
                     : value.is_number() ? value.dump()
                                         : "";
  std::erase_if(text, [](unsigned char c) { return c < 0x20 || c == 0x7f; });
  if (text.size() > most_name_bytes) {
    size_t end = most_name_bytes;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) end--;
    text.resize(end);
  }
  return text;
}

std::string text_by_language(const GeoValue& words, const std::vector<std::string>& languages) {
  for (const std::string& language : languages)
    if (const auto found = words.find(language); found != words.end())
      if (std::string text = plain_text(*found); !text.empty()) return text;
  if (const auto found = words.find("en"); found != words.end())
    if (std::string text = plain_text(*found); !text.empty()) return text;
  for (const GeoValue& any : words)
    if (std::string text = plain_text(any); !text.empty()) return text;
  return "";
}

}  // namespace

GeoFile read_geojson(const std::string& path) {
  const std::string text = read_file(path, most_geo_bytes);
  auto parsed = json::parse_json(text, {.values = most_geo_values});
  if (const auto* error = std::get_if<json::JsonError>(&parsed))
    throw LoadError(path, "", error->message);
  GeoFile file;
  file.root = std::get<nlohmann::json>(std::move(parsed));
  GeoReader(path, text, file).read_root();
  return file;
}

void add_geo_languages(const nlohmann::json* properties, const std::vector<std::string>& names,
                       std::set<std::string, std::less<>>& languages) {
  constexpr size_t longest_tag = 12, most_languages = 100;
  if (!properties) return;
  const auto add = [&](std::string_view tag) {
    const bool is_tag =
        tag.size() >= 2 && tag.size() <= longest_tag &&
        std::ranges::all_of(tag, [](unsigned char c) { return std::isalnum(c) || c == '-'; });
    if (is_tag && languages.size() < most_languages) languages.emplace(tag);
  };
  for (const std::string& name : names) {
    const size_t at = name.find(language_mark);
    if (at == std::string::npos) {
      const auto words = properties->find(name);
      if (words == properties->end() || !words->is_object()) continue;
      for (const auto& word : words->items()) add(word.key());
      continue;
    }
    const std::string_view all(name), before = all.substr(0, at),
                                      after = all.substr(at + language_mark.size());
    for (const auto& property : properties->items()) {
      const std::string_view key(property.key());
      if (key.size() > name.size() - language_mark.size() && key.starts_with(before) &&
          key.ends_with(after) && property.value().is_string())
        add(key.substr(at, key.size() - before.size() - after.size()));
    }
  }
}

std::string geo_text(const nlohmann::json* properties, const std::vector<std::string>& names,
                     const std::string& language) {
  if (!properties) return "";
  std::vector<std::string> languages{language};
  if (const size_t base = language.find('-'); base != std::string::npos)
    languages.push_back(language.substr(0, base));
  for (const std::string& name : names) {
    const size_t at = name.find(language_mark);
    for (const std::string& one : languages) {
      std::string key = name;
      if (at != std::string::npos) key.replace(at, language_mark.size(), one);
      const auto found = properties->find(key);
      if (found == properties->end()) continue;
      std::string text =
          found->is_object() ? text_by_language(*found, languages) : plain_text(*found);
      if (!text.empty()) return text;
      if (at == std::string::npos) break;
    }
  }
  return "";
}

}  // namespace wellspring::store
