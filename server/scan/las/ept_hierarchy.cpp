// SPDX-License-Identifier: Apache-2.0
#include "scan/las/ept_hierarchy.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <optional>
#include <set>
#include <string_view>

#include "base/load_error.h"
#include "json/fields.h"

namespace wellspring::scan {
namespace {

constexpr uint32_t deepest_ept_node = 31;
constexpr size_t most_ept_dimensions = 128;
constexpr double most_ept_points = 1e15;

std::optional<EptKey> parse_ept_key(std::string_view text) {
  EptKey key{};
  const char *at = text.data(), *end = at + text.size();
  for (size_t i = 0; i < key.size(); i++) {
    if (i > 0 && (at == end || *at++ != '-')) return {};
    const auto [next, error] = std::from_chars(at, end, key[i]);
    if (error != std::errc{}) return {};
    at = next;
  }
  if (at != end || key[0] > deepest_ept_node) return {};
  for (size_t i = 1; i < key.size(); i++)
    if (key[i] >> key[0] != 0) return {};
  return key;
}

bool lies_below(const EptKey& key, const EptKey& root) {
  if (key[0] < root[0]) return false;
  for (size_t i = 1; i < key.size(); i++)
    if (key[i] >> (key[0] - root[0]) != root[i]) return false;
  return true;
}

// Follows the files of the tree, each of which has the nodes below its own.
class HierarchyReader {
 public:
  explicit HierarchyReader(EptFolder& folder) : folder_(folder) {}

  void read() {
    files_.push_back({});
    seen_files_.insert(EptKey{});
    while (!files_.empty()) {
      const EptKey root = files_.back();
      files_.pop_back();
      read_file_of(root);
    }
    if (points_ != folder_.points)
      throw LoadError(folder_.file, "/points",
                      fmt::format("says {}, the nodes have {}", folder_.points, points_));
    for (const auto& [key, points] : nodes_)
      if (points > 0) folder_.nodes.push_back({key, points});
  }

 private:
  void read_file_of(const EptKey& root) {
    const std::string file = fmt::format("{}ept-hierarchy/{}.json", folder_.folder, ept_name(root));
    const nlohmann::json json = json::parse_json_file(file, json::read_json_text(file));
    if (!json.is_object()) throw LoadError(file, "", "is no object");
    for (const auto& [name, value] : json.items()) {
      const auto fail = [&](const std::string& what) { throw LoadError(file, "/" + name, what); };
      const std::optional<EptKey> key = parse_ept_key(name);
      if (!key) fail("is no node's name");
      if (!lies_below(*key, root)) fail(fmt::format("does not lie below {}", ept_name(root)));
      if (!value.is_number_integer()) fail("is no whole number");
      const int64_t points = value.get<int64_t>();
      if (points == -1) {
        if (!seen_files_.insert(*key).second) fail("is in a file that refers to itself");
        files_.push_back(*key);
        continue;
      }
      if (points < 0 || uint64_t(points) > most_ept_node_points)
        fail(fmt::format("has {} points; a node may have {}", points, most_ept_node_points));
      if (!nodes_.emplace(*key, uint64_t(points)).second) fail("appears twice");
      points_ += uint64_t(points);
      if (points_ > folder_.points)
        fail(fmt::format("is one too many: there should be {} points", folder_.points));
    }
    if (!nodes_.contains(root)) throw LoadError(file, "/" + ept_name(root), "is missing");
  }

  EptFolder& folder_;
  std::vector<EptKey> files_;  // still to be read
  std::set<EptKey> seen_files_;
  std::map<EptKey, uint64_t> nodes_;
  uint64_t points_ = 0;
};

void read_dimensions(const json::JsonValue& schema, EptFolder& folder) {
  for (const json::JsonValue& entry : schema.list(1, most_ept_dimensions, "dimensions")) {
    json::FieldReader fields(entry);
    EptDimension dimension;
    double size = 0;
    fields.text("name", dimension.name, "", json::Need::required);
    // Older programs write "floating".
    const auto kind = entry.find("type");
    const int index = kind ? kind->word({"signed", "unsigned", "float", "floating"}) : -1;
    if (index < 0) entry.fail("has no type");
    dimension.kind = EptKind(std::clamp(index, 0, 2));
    if (const auto value = entry.find("size")) value->whole(1, 8, size);
    if (const auto value = entry.find("scale")) value->number(-1e9, 1e9, dimension.scale);
    if (const auto value = entry.find("offset")) value->number(-1e12, 1e12, dimension.offset);
    dimension.size = int(size);
    const bool is_float = dimension.kind == EptKind::floating;
    if (std::popcount(unsigned(dimension.size)) != 1 || (is_float && dimension.size < 4))
      entry.fail(fmt::format("has a number of {} bytes", dimension.size));
    dimension.at = folder.point_bytes;
    folder.point_bytes += size_t(dimension.size);
    folder.dimensions.push_back(dimension);
  }
}

void read_bounds(const json::JsonValue& bounds, EptFolder& folder) {
  double numbers[6];
  if (!bounds.numbers(6, -1e15, 1e15, numbers)) return;
  folder.low = {numbers[0], numbers[1], numbers[2]};
  folder.high = {numbers[3], numbers[4], numbers[5]};
  folder.is_bounded = true;
  for (int i = 0; i < 3; i++) folder.is_bounded &= folder.low[i] <= folder.high[i];
}

}  // namespace

std::string ept_name(const EptKey& key) {
  return fmt::format("{}-{}-{}-{}", key[0], key[1], key[2], key[3]);
}

const EptDimension* EptFolder::find(const std::string& name) const {
  const auto found = std::ranges::find(dimensions, name, &EptDimension::name);
  return found == dimensions.end() ? nullptr : &*found;
}

EptFolder load_ept_folder(const std::string& path) {
  EptFolder folder;
  const bool is_folder = std::filesystem::is_directory(path);
  folder.folder = is_folder ? path : path.substr(0, path.rfind('/') + 1);
  if (is_folder && !path.ends_with('/')) folder.folder += '/';
  folder.file = is_folder ? folder.folder + "ept.json" : path;
  const std::string text = json::read_json_text(folder.file);
  const nlohmann::json json = json::parse_json_file(folder.file, text);
  json::Faults faults(folder.file, false, text);
  const json::JsonValue value(json, faults);
  if (!value.object()) return folder;
  json::FieldReader fields(value);
  std::string hierarchy = "json";
  fields.choice("dataType", {"binary", "zstandard", "laszip"}, folder.data, "",
                json::Need::required);
  fields.word("hierarchyType", {"json"}, hierarchy, "");
  double points = 0;
  if (const auto count = value.find("points")) count->whole(0, most_ept_points, points);
  else value.fail("has no points");
  folder.points = uint64_t(points);
  if (const auto schema = value.find("schema")) read_dimensions(*schema, folder);
  else value.fail("has no schema");
  const auto bounds = value.find("boundsConforming");
  if (bounds) read_bounds(*bounds, folder);
  else if (const auto cube = value.find("bounds")) read_bounds(*cube, folder);
  if (const auto space = value.find("srs"); space && space->value().is_object())
    if (const auto wkt = space->find("wkt"); wkt && wkt->value().is_string())
      folder.wkt = wkt->value().get<std::string>();
  HierarchyReader(folder).read();
  return folder;
}

}  // namespace wellspring::scan
