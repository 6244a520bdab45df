// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/load_error.h"
#include "json/fields.h"
#include "volume/compare/registration.h"

namespace wellspring::volume {

std::vector<ControlPair> read_control_pairs(const std::string& file) {
  constexpr double limit = 1e6;  // metres
  const std::string text = read_json_text(file, FileKind::regular_or_pipe);
  const nlohmann::json value = parse_json_file(file, text);
  Faults faults(file, true, text);
  std::vector<ControlPair> pairs;
  FieldReader::read_object(JsonValue(value, faults), [&](FieldReader& fields) {
    fields.parts(
        "pairs", 1000, "equal places of the surface and the volume",
        [&](FieldReader& one) {
          ControlPair& pair = pairs.emplace_back();
          one.vector("surface_m", limit, pair.surface, "on the surface", Need::required);
          one.vector("volume_m", limit, pair.volume, "in the volume", Need::required);
        },
        Need::required);
  });
  if (pairs.size() < 3) throw LoadError(file, "/pairs", "needs three pairs or more");
  // The largest triangle with the first two different places has an area, or all are on one line.
  auto spread = [&](auto place_of) {
    double widest = 0, longest = 0;
    for (const ControlPair& a : pairs)
      longest = std::max(longest, glm::distance(place_of(a), place_of(pairs[0])));
    const auto far =
        std::max_element(pairs.begin(), pairs.end(), [&](const auto& a, const auto& b) {
          return glm::distance(place_of(a), place_of(pairs[0])) <
                 glm::distance(place_of(b), place_of(pairs[0]));
        });
    for (const ControlPair& a : pairs)
      widest = std::max(widest, glm::length(glm::cross(place_of(*far) - place_of(pairs[0]),
                                                       place_of(a) - place_of(pairs[0]))));
    return longest > 0 ? widest / (longest * longest) : 0;
  };
  if (std::min(spread([](const ControlPair& pair) { return pair.surface; }),
               spread([](const ControlPair& pair) { return pair.volume; })) < 1e-4)
    throw LoadError(file, "/pairs", "all places lie on one line, so nothing says how to turn");
  return pairs;
}

}  // namespace wellspring::volume
