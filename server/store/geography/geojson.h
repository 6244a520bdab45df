// SPDX-License-Identifier: Apache-2.0
// Reads GeoJSON (RFC 7946): a FeatureCollection, a Feature or a bare geometry, of all seven types.
// Heights are ignored, foreign members allowed. Coordinates are as the file has them: longitude and
// latitude in degrees, or whatever its maker agreed on with the curator.
#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "store/geography/geo_box.h"

namespace wellspring::store {

inline constexpr size_t most_geo_bytes = size_t(32) << 20;
inline constexpr size_t most_geo_points = 500000, most_geo_features = 50000;
inline constexpr double farthest_geo = 1e8;  // bounds coordinates of either sign
inline constexpr int most_geo_depth = 8;     // collections within one another

// Holds a line, a ring without its repeated last place, or points.
struct GeoPart {
  size_t first = 0, count = 0;  // in GeoFile::points
  bool begins = true;           // a hole does not begin a polygon: it belongs to the part before
};

struct GeoFeature {
  enum class Kind : uint8_t { points, lines, areas };
  Kind kind = Kind::points;
  size_t first_part = 0, parts = 0;
  const nlohmann::json* properties = nullptr;  // an object; null: there is none
  bool is_first = true;                        // a collection of geometries becomes several
};

struct GeoFile {
  nlohmann::json root;  // has the properties
  std::vector<dvec2> points;
  std::vector<GeoPart> parts;
  std::vector<GeoFeature> features;
  GeoBox box;                  // around all points; empty: there are none
  std::optional<GeoBox> bbox;  // as the file tells it: west, south, east, north
};

// Throws LoadError, which names the file and the place in it, for what is wrong and for what is too
// much.
GeoFile read_geojson(const std::string& path);

// Returns a property's text in a language: each of `names` is tried in turn, with "{language}"
// replaced by it and by its base ("de" of "de-AT"). A property may also be a number, or an object
// of languages, in which the language is looked for, then English, then any. Empty: there is none.
std::string geo_text(const nlohmann::json* properties, const std::vector<std::string>& names,
                     const std::string& language);

// Adds the languages in which a feature has such a text: by names of properties, and by objects.
void add_geo_languages(const nlohmann::json* properties, const std::vector<std::string>& names,
                       std::set<std::string, std::less<>>& languages);

}  // namespace wellspring::store
