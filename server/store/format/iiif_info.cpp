// SPDX-License-Identifier: Apache-2.0
#include "store/format/iiif_info.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/load_error.h"
#include "json/text.h"
#include "store/format/tile_folder.h"

namespace wellspring::store {
namespace {

using Json = nlohmann::json;

int64_t divide_up(int64_t a, int64_t b) { return (a + b - 1) / b; }

// Reads an info.json; errors name the place as a JSON pointer.
struct InfoReader {
  const std::string& file;
  const Json info;

  [[noreturn]] void fail(const std::string& where, const std::string& what) const {
    throw LoadError(file, where, what);
  }
  int64_t number(const Json& from, const std::string& at, const char* name, int64_t most) const {
    const auto found = from.find(name);
    if (found == from.end()) fail(at + "/" + name, "is missing");
    if (!found->is_number_integer() || *found < 1 || *found > most)
      fail(at + "/" + name, "is no whole number from 1 to " + std::to_string(most));
    return found->get<int64_t>();
  }
  const Json& list(const Json& from, const std::string& at, const char* name) const {
    static const Json none = Json::array();
    const auto found = from.find(name);
    if (found == from.end()) return none;
    if (!found->is_array()) fail(at + "/" + name, "is no list");
    if (found->size() > 256) fail(at + "/" + name, "has too many items");
    return *found;
  }
  // Calls read(item, place) for each object in a list.
  template <class Read>
  void each(const char* name, const Read& read) const {
    int at = 0;
    for (const Json& item : list(info, "", name)) {
      const std::string place = std::string("/") + name + "/" + std::to_string(at++);
      if (!item.is_object()) fail(place, "is no object");
      read(item, place);
    }
  }

  // Returns the number of the version, 1 to 3, by its context.
  int version() const {
    const auto context = info.find("@context");
    if (context == info.end()) {
      if (info.contains("identifier")) return 1;  // 1.0 has no context
      fail("/@context", "is missing, as is 1.0's identifier: this is no info.json of IIIF");
    }
    // Version 3 has extensions before its own context.
    const Json& own = context->is_array() && !context->empty() ? context->back() : *context;
    std::string text = own.is_string() ? own.get<std::string>() : "";
    if (const size_t scheme = text.find("://"); scheme != text.npos) text.erase(0, scheme + 3);
    const bool alone = !context->is_array() || context->size() == 1;
    if (text == "iiif.io/api/image/3/context.json") return 3;
    if (alone && text == "iiif.io/api/image/2/context.json") return 2;
    if (alone && (text == "library.stanford.edu/iiif/image-api/1.1/context.json" ||
                  text == "library.stanford.edu/iiif/image-api/context.json"))
      return 1;
    fail("/@context", "is no context of IIIF Image API 1.1, 2 or 3");
  }
  // Returns the number that the profile names; 0 where it names none.
  int compliance() const {
    const auto found = info.find("profile");
    if (found == info.end()) return 0;
    const Json& profile = found->is_array() && !found->empty() ? found->front() : *found;
    const std::string text = profile.is_string() ? profile.get<std::string>() : "";
    const size_t at = text.rfind("level");
    const char digit = at == text.npos || at + 5 >= text.size() ? '0' : text[at + 5];
    return digit == '1' || digit == '2' ? digit - '0' : 0;
  }
  // Returns the first preferred format that is read; JPEG is known to every server.
  std::string format() const {
    for (const Json& wish : list(info, "", "preferredFormats"))
      for (const char* known : {"jpg", "png", "webp"})
        if (wish == known) return known;
    return "jpg";
  }
  void check_profile() const {
    const Json profile = info.value("profile", Json());
    for (const char* known : {"level0", "level1", "level2"})
      if (profile == known) return;
    fail("/profile", "is none of \"level0\", \"level1\", \"level2\"");
  }
};

bool is_one_tile(const PyramidLevel& level) { return level.columns() == 1 && level.rows() == 1; }

// Makes levels of what an info.json names.
struct LevelMaker {
  IiifInfo& made;
  // Adds the level whose texels are `scale` of the picture's wide and high.
  void add_level(int64_t scale, int64_t tile_width, int64_t tile_height) {
    if (std::ranges::count(made.scales, scale)) return;
    const int64_t wide = divide_up(made.width, scale), high = divide_up(made.height, scale);
    if (wide <= tile_width && high <= tile_height) {
      tile_width = std::max<int64_t>(tile_width, 16);
      tile_height = std::max<int64_t>(tile_height, 16);
    }
    made.levels.push_back({wide, high, int(tile_width), int(tile_height)});
    made.scales.push_back(scale);
  }
  void read_scales(const InfoReader& reader, const Json& from, const std::string& at,
                   const char* name, int64_t tile_width, int64_t tile_height) {
    const Json& scales = reader.list(from, at, name);
    for (size_t i = 0; i < scales.size(); i++) {
      const std::string place = at + "/" + name + "/" + std::to_string(i);
      if (!scales[i].is_number_integer() || scales[i] < 1 || scales[i] > longest_picture)
        reader.fail(place, "is no whole number from 1 on");
      add_level(scales[i].get<int64_t>(), tile_width, tile_height);
    }
  }
  void read_tiles_1(const InfoReader& reader) {
    if (!reader.info.contains("tile_width")) return;
    const int64_t wide = reader.number(reader.info, "", "tile_width", largest_tile);
    const int64_t high = reader.info.contains("tile_height")
                             ? reader.number(reader.info, "", "tile_height", largest_tile)
                             : wide;
    read_scales(reader, reader.info, "", "scale_factors", wide, high);
    if (made.scales.empty()) add_levels_of(wide, high);
  }
  void read_tiles(const InfoReader& reader) {
    reader.each("tiles", [&](const Json& tiles, const std::string& at) {
      const int64_t wide = reader.number(tiles, at, "width", largest_tile);
      const int64_t high =
          tiles.contains("height") ? reader.number(tiles, at, "height", largest_tile) : wide;
      if (!tiles.contains("scaleFactors")) reader.fail(at + "/scaleFactors", "is missing");
      read_scales(reader, tiles, at, "scaleFactors", wide, high);
    });
  }
  // Sizes are levels of one tile where no tiles are named, or where those end too early.
  void read_sizes(const InfoReader& reader) {
    const auto is_coarse = [](const PyramidLevel& level) {
      return std::max(level.width, level.height) <= coarsest_side;
    };
    const bool has_tiles = !made.scales.empty();
    const bool ends = std::ranges::any_of(made.levels, is_coarse);
    reader.each("sizes", [&](const Json& size, const std::string& at) {
      const int64_t wide = reader.number(size, at, "width", longest_picture);
      const int64_t high = reader.number(size, at, "height", longest_picture);
      if (ends || std::max(wide, high) > largest_tile || (has_tiles && wide > coarsest_side))
        return;
      add_whole(wide, high);
    });
    if (!has_tiles && !made.levels.empty() && std::max(made.width, made.height) <= largest_tile)
      add_whole(made.width, made.height);
  }
  void add_whole(int64_t wide, int64_t high) {
    for (const PyramidLevel& level : made.levels)
      if (level.width == wide) return;
    made.levels.push_back({wide, high, std::max(int(wide), 16), std::max(int(high), 16)});
    made.scales.push_back(0);
  }
  void choose_tiles() {
    const int64_t shorter = std::min(made.width, made.height);
    int64_t tile = std::max<int64_t>(shorter, 16);
    for (const int64_t usual : {256, 512, 1024})
      if (usual <= shorter) tile = usual;
    add_levels_of(tile, tile);
  }
  // Adds levels until one fits into a tile.
  void add_levels_of(int64_t tile_width, int64_t tile_height) {
    for (int64_t scale = 1;; scale *= 2) {
      add_level(scale, tile_width, tile_height);
      if (is_one_tile(made.levels.back())) return;
    }
  }
  // Goes on with half the size each time until a level fits into a tile.
  void add_coarser() {
    const auto last = std::ranges::max_element(made.scales);
    const PyramidLevel level = made.levels[size_t(last - made.scales.begin())];
    const int64_t coarsest = *last;
    if (is_one_tile(level)) return;
    for (int64_t scale = coarsest * 2;; scale *= 2) {
      add_level(scale, level.tile_width, level.tile_height);
      if (is_one_tile(made.levels.back())) return;
    }
  }
  void sort_levels(const InfoReader& reader) {
    std::vector<std::pair<PyramidLevel, int64_t>> sorted;
    for (size_t i = 0; i < made.levels.size(); i++)
      sorted.emplace_back(made.levels[i], made.scales[i]);
    std::ranges::stable_sort(sorted, std::greater(), [](const auto& level) {
      return std::max(level.first.width, level.first.height);
    });
    if (sorted.size() > size_t(most_levels)) reader.fail("", "has too many levels");
    made.levels.clear(), made.scales.clear();
    for (const auto& [level, scale] : sorted) {
      if (!can_be_cut(level))
        reader.fail("", "tiles must be 16 to 4096 texels a side, and not too many");
      made.levels.push_back(level), made.scales.push_back(scale);
    }
  }
};

}  // namespace

bool IiifInfo::is_one_tile(int level) const { return store::is_one_tile(levels[size_t(level)]); }

IiifInfo read_iiif_info(const std::string& file, std::string_view text, IiifHost host) {
  const InfoReader reader{file, json::parse_json_file(file, text)};
  if (!reader.info.is_object()) reader.fail("", "is no object");
  IiifInfo info;
  LevelMaker maker{info};
  info.version = reader.version();
  if (info.version == 3) reader.check_profile();
  info.compliance = reader.compliance();
  info.format = reader.format();
  info.width = reader.number(reader.info, "", "width", longest_picture);
  info.height = reader.number(reader.info, "", "height", longest_picture);
  if (info.version == 1) maker.read_tiles_1(reader);
  else maker.read_tiles(reader);
  const bool scales_any = host == IiifHost::server && info.compliance > 0;
  if (!scales_any) maker.read_sizes(reader);
  if (info.scales.empty() && host == IiifHost::server && !scales_any)
    reader.fail("/tiles", "is missing, as is /sizes: a server of level 0 has to name one of them");
  if (info.scales.empty()) maker.choose_tiles();
  if (scales_any) maker.add_coarser();
  maker.sort_levels(reader);
  return info;
}

IiifRegion region_of(const IiifInfo& info, PieceKey key) {
  const PyramidLevel& level = info.levels[size_t(key.level())];
  const int64_t scale = info.scales[size_t(key.level())];
  if (scale == 0) return {0, 0, info.width, info.height};
  const int64_t wide = scale * level.tile_width, high = scale * level.tile_height;
  const int64_t x = key.column() * wide, y = key.row() * high;
  return {x, y, std::min(wide, info.width - x), std::min(high, info.height - y)};
}

std::string to_text(const IiifRegion& region) {
  return std::to_string(region.x) + "," + std::to_string(region.y) + "," +
         std::to_string(region.width) + "," + std::to_string(region.height);
}

}  // namespace wellspring::store
