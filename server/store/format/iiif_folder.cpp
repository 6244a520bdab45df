// SPDX-License-Identifier: Apache-2.0
#include "store/format/iiif_folder.h"

#include <algorithm>
#include <filesystem>
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
  void check_profile() const {
    const Json profile = info.value("profile", Json());
    for (const char* known : {"level0", "level1", "level2"})
      if (profile == known) return;
    fail("/profile", "is none of \"level0\", \"level1\", \"level2\"");
  }
};

class IiifFolder : public TileFolder {
 public:
  explicit IiifFolder(const std::string& file)
      : folder_((std::filesystem::path(file).parent_path() / "").string()) {
    const InfoReader reader{file, json::parse_json_file(file, json::read_json_text(file))};
    if (!reader.info.is_object()) reader.fail("", "is no object");
    version_ = reader.version();
    if (version_ == 3) reader.check_profile();
    width_ = reader.number(reader.info, "", "width", longest_picture);
    height_ = reader.number(reader.info, "", "height", longest_picture);
    if (version_ == 1) read_tiles_1(reader);
    else read_tiles(reader);
    read_sizes(reader);
    if (scales_.empty()) choose_tiles();
    sort_levels(reader);
    for (size_t i = 0; i < levels_.size(); i++) find_size(int(i));
    add_coarser_levels(file);
  }

 protected:
  TileFile file_of(PieceKey key) const override {
    const PyramidLevel& level = levels_[size_t(key.level())];
    const int column = int(key.column()), row = int(key.row());
    TileFile tile;
    tile.width = level.width_at(column), tile.height = level.height_at(row);
    tile.part = {0, 0, tile.width, tile.height};
    const std::string wide = std::to_string(tile.width) + ",";
    std::vector<std::string> regions, sizes = {wide, wide + std::to_string(tile.height)};
    if (version_ == 3) std::swap(sizes[0], sizes[1]);
    if (is_one_tile(level)) regions.push_back("full");
    if (level.width == width_ && level.height == height_)
      sizes.insert(sizes.end(), {"full", "max"});
    if (const int64_t scale = scales_[size_t(key.level())]) {
      const int64_t x = column * scale * level.tile_width, y = row * scale * level.tile_height;
      std::string region;
      for (const int64_t number : {x, y, std::min(scale * level.tile_width, width_ - x),
                                   std::min(scale * level.tile_height, height_ - y)})
        region += (region.empty() ? "" : ",") + std::to_string(number);
      regions.push_back(region);
    }
    for (const std::string& region : regions)
      for (const std::string& size : sizes) add_paths(region, size, tile.paths);
    return tile;
  }

 private:
  static bool is_one_tile(const PyramidLevel& level) {
    return level.columns() == 1 && level.rows() == 1;
  }
  void add_paths(const std::string& region, const std::string& size,
                 std::vector<std::string>& paths) const {
    const bool old = version_ == 1;
    for (const char* quality : {old ? "native" : "default", old ? "default" : "native"})
      for (const char* format : {"jpg", "png", "webp"})
        paths.push_back(folder_ + region + "/" + size + "/0/" + quality + "." + format);
  }
  // Adds the level whose texels are `scale` of the picture's wide and high.
  void add_level(int64_t scale, int64_t tile_width, int64_t tile_height) {
    if (std::ranges::count(scales_, scale)) return;
    const int64_t wide = divide_up(width_, scale), high = divide_up(height_, scale);
    if (wide <= tile_width && high <= tile_height) {
      tile_width = std::max<int64_t>(tile_width, 16);
      tile_height = std::max<int64_t>(tile_height, 16);
    }
    levels_.push_back({wide, high, int(tile_width), int(tile_height)});
    scales_.push_back(scale);
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
    if (scales_.empty()) add_levels_of(wide, high);
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
    const bool has_tiles = !scales_.empty();
    const bool ends = std::ranges::any_of(levels_, is_coarse);
    reader.each("sizes", [&](const Json& size, const std::string& at) {
      const int64_t wide = reader.number(size, at, "width", longest_picture);
      const int64_t high = reader.number(size, at, "height", longest_picture);
      if (ends || std::max(wide, high) > largest_tile || (has_tiles && wide > coarsest_side))
        return;
      add_whole(wide, high);
    });
    if (!has_tiles && !levels_.empty() && std::max(width_, height_) <= largest_tile)
      add_whole(width_, height_);
  }
  void add_whole(int64_t wide, int64_t high) {
    for (const PyramidLevel& level : levels_)
      if (level.width == wide) return;
    levels_.push_back({wide, high, std::max(int(wide), 16), std::max(int(high), 16)});
    scales_.push_back(0);
  }
  void choose_tiles() {
    const int64_t shorter = std::min(width_, height_);
    int64_t tile = std::max<int64_t>(shorter, 16);
    for (const int64_t usual : {256, 512, 1024})
      if (usual <= shorter) tile = usual;
    add_levels_of(tile, tile);
  }
  // Adds levels until one fits into a tile.
  void add_levels_of(int64_t tile_width, int64_t tile_height) {
    for (int64_t scale = 1;; scale *= 2) {
      add_level(scale, tile_width, tile_height);
      if (is_one_tile(levels_.back())) return;
    }
  }
  void sort_levels(const InfoReader& reader) {
    std::vector<std::pair<PyramidLevel, int64_t>> sorted;
    for (size_t i = 0; i < levels_.size(); i++) sorted.emplace_back(levels_[i], scales_[i]);
    std::ranges::stable_sort(sorted, std::greater(), [](const auto& level) {
      return std::max(level.first.width, level.first.height);
    });
    if (sorted.size() > size_t(most_levels)) reader.fail("", "has too many levels");
    levels_.clear(), scales_.clear();
    for (const auto& [level, scale] : sorted) {
      if (!can_be_cut(level))
        reader.fail("", "tiles must be 16 to 4096 texels a side, and not too many");
      levels_.push_back(level), scales_.push_back(scale);
    }
  }
  // Takes the size of a level of one tile from its file, if that is one texel off at most.
  void find_size(int number) {
    PyramidLevel& level = levels_[size_t(number)];
    if (!is_one_tile(level) || scales_[size_t(number)] < 2) return;
    std::vector<std::string> paths = file_of({1, number, 0, 0}).paths;
    for (const int64_t wide : {level.width, level.width - 1})
      for (const int64_t high : {level.height, level.height - 1}) {
        add_paths("full", std::to_string(wide) + ",", paths);
        add_paths("full", std::to_string(wide) + "," + std::to_string(high), paths);
      }
    const std::shared_ptr<Piece> piece = read_tile_file(paths);
    if (!piece || std::abs(piece->width - level.width) > 1 ||
        std::abs(piece->height - level.height) > 1)
      return;
    level.width = piece->width, level.height = piece->height;
  }

  std::string folder_;
  int version_ = 0;                 // the interface: 1, 2, 3
  int64_t width_ = 0, height_ = 0;  // texels of the picture
  std::vector<int64_t> scales_;     // one a level; 0: it is known by its size alone
};

}  // namespace

std::shared_ptr<const PicturePyramid> load_iiif_folder(const std::string& file) {
  return std::make_shared<IiifFolder>(file);
}

}  // namespace wellspring::store
