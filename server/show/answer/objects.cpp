// SPDX-License-Identifier: Apache-2.0
#include "show/answer/objects.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "show/exhibit/exhibit_objects.h"

namespace wellspring::show {

using nlohmann::json;

namespace {

constexpr int most_map_cells = 240;  // a side

json rounded(dvec3 v) {
  auto round = [](double x) { return std::round(x * 1e3) / 1e3; };
  return json::array({round(v.x), round(v.y), round(v.z)});
}

// `say`: what becomes of a text in languages.
template <class Say>
json describe(const PointOfInterest& point, const Say& say) {
  json about = {{"id", point.id}, {"title", say(point.title)}, {"position", rounded(point.place)}};
  if (!point.text.empty()) about["text"] = say(point.text);
  if (!point.story.empty()) about["story"] = point.story;
  if (!point.manifest.empty()) about["manifest"] = point.manifest;
  if (point.around) about["around"] = true;
  if (!point.door.exhibit.empty()) {
    about["door"] = {{"exhibit", point.door.exhibit}};
    if (!point.door.viewpoint.empty()) about["door"]["viewpoint"] = point.door.viewpoint;
  }
  if (point.provenance.empty()) return about;
  json& facts = about["provenance"] = json::array();
  for (const char* element : provenance_elements)
    if (auto found = point.provenance.find(element); found != point.provenance.end())
      facts.push_back({{"element", element}, {"value", say(found->second)}});
  return about;
}

}  // namespace

json describe_objects(const Exhibit& exhibit) {
  json objects = json::array();
  for (const PointOfInterest& point : exhibit.points)
    objects.push_back(describe(point, [](const LocalText& text) { return json(text); }));
  return objects;
}

json describe_objects(const Exhibit& exhibit, const std::string& lang) {
  json objects = json::array();
  for (const PointOfInterest& point : exhibit.points) {
    if (point.title.empty()) continue;
    objects.push_back(describe(point, [&](const LocalText& text) {
      return json(text_in(text, lang, exhibit.languages));
    }));
  }
  return objects;
}

std::string describe_map(const Exhibit& exhibit, const WalkMap& map) {
  // Only as much as there is ground on, in cells that are not too many.
  ivec2 low(map.width, map.depth), high(-1);
  for (int z = 0; z < map.depth; z++)
    for (int x = 0; x < map.width; x++) {
      if (map.column[size_t(z) * size_t(map.width) + size_t(x)] < 0) continue;
      low = min(low, ivec2(x, z));
      high = max(high, ivec2(x, z));
    }
  const ivec2 size = max(high - low + 1, ivec2(0));
  const int scale = std::max(1, (std::max(size.x, size.y) + most_map_cells - 1) / most_map_cells);
  const ivec2 cells = (size + scale - 1) / scale;
  std::vector<std::string> rows(size_t(cells.y), std::string(size_t(cells.x), '.'));
  for (int z = 0; z < size.y; z++)
    for (int x = 0; x < size.x; x++) {
      char& cell = rows[size_t(z / scale)][size_t(x / scale)];
      int p = map.column[size_t(low.y + z) * size_t(map.width) + size_t(low.x + x)];
      for (; p >= 0; p = map.place_after[size_t(p)])
        if (cell != 'o') cell = map.places[size_t(p)].clear >= map.radius ? 'o' : 'x';
    }
  const float middle = 0.5f * float(scale - 1);  // of a cell's places
  const dvec3 corner =
      exhibit.scene.origin +
      dvec3(map.corner + map.cell * vec3(float(low.x) + middle, 0, float(low.y) + middle));
  json about = {{"cell", map.cell * float(scale)}, {"corner", {corner.x, corner.z}},
                {"eye_height", map.eye_height},    {"rows", rows},
                {"viewpoints", json::array()},     {"objects", json::array()}};
  for (const ExhibitViewpoint& viewpoint : exhibit.viewpoints)
    about["viewpoints"].push_back({{"name", viewpoint.view.name},
                                   {"position", rounded(viewpoint.view.position)},
                                   {"yaw", viewpoint.view.yaw}});
  for (const PointOfInterest& point : exhibit.points)
    about["objects"].push_back({{"id", point.id}, {"position", rounded(point.place)}});
  return about.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace wellspring::show
