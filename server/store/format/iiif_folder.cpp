// SPDX-License-Identifier: Apache-2.0
#include "store/format/iiif_folder.h"

#include <algorithm>
#include <filesystem>

#include "json/text.h"
#include "store/format/iiif_info.h"
#include "store/format/tile_folder.h"

namespace wellspring::store {
namespace {

class IiifFolder : public TileFolder {
 public:
  explicit IiifFolder(const std::string& file)
      : folder_((std::filesystem::path(file).parent_path() / "").string()),
        info_(read_iiif_info(file, json::read_json_text(file), IiifHost::folder)) {
    levels_ = info_.levels;
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
    if (info_.version == 3) std::swap(sizes[0], sizes[1]);
    if (info_.is_one_tile(key.level())) regions.push_back("full");
    if (level.width == info_.width && level.height == info_.height)
      sizes.insert(sizes.end(), {"full", "max"});
    if (info_.scales[size_t(key.level())] > 0) regions.push_back(to_text(region_of(info_, key)));
    for (const std::string& region : regions)
      for (const std::string& size : sizes) add_paths(region, size, tile.paths);
    return tile;
  }

 private:
  void add_paths(const std::string& region, const std::string& size,
                 std::vector<std::string>& paths) const {
    const bool old = info_.version == 1;
    for (const char* quality : {old ? "native" : "default", old ? "default" : "native"})
      for (const char* format : {"jpg", "png", "webp"})
        paths.push_back(folder_ + region + "/" + size + "/0/" + quality + "." + format);
  }
  // Takes the size of a level of one tile from its file, if that is one texel off at most.
  void find_size(int number) {
    PyramidLevel& level = levels_[size_t(number)];
    if (!info_.is_one_tile(number) || info_.scales[size_t(number)] < 2) return;
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
  IiifInfo info_;
};

}  // namespace

std::shared_ptr<const PicturePyramid> load_iiif_folder(const std::string& file) {
  return std::make_shared<IiifFolder>(file);
}

}  // namespace wellspring::store
