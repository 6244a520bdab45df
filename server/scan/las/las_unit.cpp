// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <string_view>

#include "scan/las/las_bytes.h"
#include "scan/las/las_header.h"

namespace wellspring::scan {
namespace {

constexpr uint16_t wkt_record = 2112, keys_record = 34735;
constexpr double metres_of_foot = 0.3048, metres_of_survey_foot = 1200.0 / 3937.0;
constexpr double unit_tolerance = 1e-8;  // texts round

struct Unit {
  double metres = 1;
  std::string notice;  // a sentence; empty: none
};

Unit unit_of(double metres, std::string_view name) {
  for (const double known : {1.0, metres_of_foot, metres_of_survey_foot})
    if (std::abs(metres - known) < unit_tolerance) return {known, ""};
  return {1, fmt::format("The unit '{}' is not known; it is taken as a metre.", name)};
}

Unit degrees() { return {1, "Places are degrees, which are taken as metres."}; }

// Reads the first of these words' brackets from `begin` on: the name and the number in it.
std::optional<Unit> find_wkt_unit(std::string_view text, std::string_view word) {
  const size_t at = text.find(word);
  if (at == std::string_view::npos) return {};
  const size_t name = text.find('"', at), end = text.find('"', name + 1);
  const size_t comma = end == std::string_view::npos ? end : text.find(',', end);
  if (comma == std::string_view::npos) return {};
  size_t begin = comma + 1;
  while (begin < text.size() && text[begin] == ' ') begin++;
  double metres = 0;
  std::from_chars(text.data() + begin, text.data() + text.size(), metres);
  return unit_of(metres, text.substr(name + 1, end - name - 1));
}

// WKT 1 gives a projected system's own unit behind the degrees of its base; WKT 2 names lengths.
std::optional<Unit> read_wkt(std::string_view text) {
  if (const size_t at = text.find("PROJCS["); at != std::string_view::npos) {
    const size_t projection = text.find("PROJECTION[", at);
    if (projection == std::string_view::npos) return {};
    return find_wkt_unit(text.substr(projection), "UNIT[");
  }
  if (const size_t at = text.find("PROJCRS["); at != std::string_view::npos) {
    const size_t axes = text.find("CS[Cartesian", at);
    if (axes == std::string_view::npos) return {};
    return find_wkt_unit(text.substr(axes), "LENGTHUNIT[");
  }
  if (text.find("GEOGCS[") != std::string_view::npos ||
      text.find("GEOGCRS[") != std::string_view::npos)
    return degrees();
  return {};
}

// GeoTIFF keys: four numbers each, behind four of their own.
std::optional<Unit> read_geo_keys(std::span<const uint8_t> bytes) {
  constexpr int model_key = 1024, linear_unit_key = 3076, geographic_model = 2;
  const auto number = [&](size_t index) { return las_number<uint16_t>(bytes.data() + 2 * index); };
  if (bytes.size() < 8) return {};
  const size_t keys = std::min<size_t>(number(3), bytes.size() / 8 - 1);
  std::optional<Unit> found;
  for (size_t i = 1; i <= keys; i++) {
    if (number(4 * i) == 0)
      return Unit{1, "GeoTIFF keys are damaged; the unit is taken as a metre."};
    const int key = number(4 * i), lies_in = number(4 * i + 1), value = number(4 * i + 3);
    if (lies_in != 0) continue;
    if (key == model_key && value == geographic_model) return degrees();
    if (key != linear_unit_key) continue;
    if (value == 9001) found = Unit{};
    else if (value == 9002) found = Unit{metres_of_foot, ""};
    else if (value == 9003) found = Unit{metres_of_survey_foot, ""};
    else found = unit_of(0, fmt::format("EPSG {}", value));
  }
  return found;
}

}  // namespace

double wkt_unit(std::string_view wkt, std::vector<std::string>& notices) {
  const std::optional<Unit> unit = read_wkt(wkt);
  if (!unit) return 1;
  if (!unit->notice.empty()) notices.push_back(unit->notice);
  return unit->metres;
}

double las_unit(const LasHeader& header, std::vector<std::string>& notices) {
  std::optional<Unit> unit;
  if (const LasRecord* wkt = header.find("LASF_Projection", wkt_record)) {
    const auto* text = reinterpret_cast<const char*>(wkt->bytes.data());
    unit = read_wkt({text, wkt->bytes.size()});
  }
  if (!unit)
    if (const LasRecord* keys = header.find("LASF_Projection", keys_record))
      unit = read_geo_keys(keys->bytes);
  if (!unit) return 1;
  if (!unit->notice.empty()) notices.push_back(unit->notice);
  return unit->metres;
}

}  // namespace wellspring::scan
