// SPDX-License-Identifier: Apache-2.0
#include "store/format/tile_folder.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <pugixml.hpp>
#include <string_view>

#include "base/load_error.h"
#include "base/read_file.h"
#include "store/format/stored_jpeg.h"
#include "store/picture/texels.h"

namespace wellspring::store {
namespace {

namespace fs = std::filesystem;

constexpr int64_t most_tile_texels = int64_t(largest_tile) * largest_tile;
constexpr size_t most_tile_bytes = size_t(64) << 20, most_xml_bytes = size_t(1) << 20;

bool is_there(const std::string& path) {
  std::error_code error;
  return fs::exists(path, error);
}

std::string size_text(int64_t width, int64_t height) {
  return std::to_string(width) + " x " + std::to_string(height);
}

std::shared_ptr<Piece> decode_tile_file(const std::string& path) {
  const auto bytes = read_file<std::vector<uint8_t>>(path, most_tile_bytes);
  return std::make_shared<Piece>(to_piece(image::decode_codes(bytes, most_tile_texels, path)));
}

// Reads an element of a file's XML; names may have a prefix.
struct XmlElement {
  const std::string& file;
  pugi::xml_node node;

  static std::string_view local(std::string_view name) { return name.substr(name.find(':') + 1); }
  std::string_view name() const { return local(node.name()); }

  [[noreturn]] void fail(const std::string& where, const std::string& what) const {
    throw LoadError(file, std::string(name()) + (where.empty() ? "" : "/" + where), what);
  }
  XmlElement child(std::string_view wanted) const {
    for (const pugi::xml_node& node : node.children())
      if (local(node.name()) == wanted) return {file, node};
    fail(std::string(wanted), "is missing");
  }
  int64_t number(const char* wanted, int64_t least, int64_t most) const {
    const std::string_view text = node.attribute(wanted).value();
    int64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (text.empty() || error != std::errc() || end != text.data() + text.size() || value < least ||
        value > most)
      fail(wanted,
           "is no whole number from " + std::to_string(least) + " to " + std::to_string(most));
    return value;
  }
};

PyramidLevel level_of(int64_t width, int64_t height, int tile) {
  return {width, height, tile, tile};
}

void check_level(const PyramidLevel& level, const std::string& file) {
  if (!can_be_cut(level))
    throw LoadError(file, "",
                    "level of " + size_text(level.width, level.height) + " has tiles of " +
                        size_text(level.tile_width, level.tile_height) +
                        ": they must be 16 to 4096 texels a side, and not too many");
}

// Deep Zoom: levels halve, rounded up, until one texel is left; level 0 is that. Tiles have the
// texels next to them, `overlap` on each side that is no edge of the picture.
// (Microsoft, Deep Zoom File Format Overview)
class DeepZoom : public TileFolder {
 public:
  DeepZoom(const std::string& file, const XmlElement& image) {
    const std::string_view format = image.node.attribute("Format").value();
    for (const std::string_view known : {"jpg", "jpeg", "png", "webp"})
      if (std::ranges::equal(format, known, {}, [](char c) { return c | 0x20; })) format_ = format;
    if (format_.empty())
      image.fail("Format", "\"" + std::string(format) + "\" is none of jpg, jpeg, png, webp");
    const int tile = int(image.number("TileSize", 16, largest_tile));
    overlap_ = int(image.number("Overlap", 0, std::min(tile, (largest_tile - tile) / 2)));
    const XmlElement size = image.child("Size");
    int64_t width = size.number("Width", 1, longest_picture);
    int64_t height = size.number("Height", 1, longest_picture);
    for (;;) {
      levels_.push_back(level_of(width, height, tile));
      check_level(levels_.back(), file);
      if (width == 1 && height == 1) break;
      width = (width + 1) / 2, height = (height + 1) / 2;
    }
    stored_ = int(levels_.size());
    folder_ = fs::path(file).replace_extension().string() + "_files/";
  }

 protected:
  TileFile file_of(PieceKey key) const override {
    const PyramidLevel& level = levels_[size_t(key.level())];
    const int column = int(key.column()), row = int(key.row());
    TileFile tile;
    tile.paths = {folder_ + std::to_string(stored_ - 1 - key.level()) + "/" +
                  std::to_string(column) + "_" + std::to_string(row) + "." + format_};
    tile.part = {column > 0 ? overlap_ : 0, row > 0 ? overlap_ : 0, level.width_at(column),
                 level.height_at(row)};
    const int64_t right = level.width - int64_t(column) * level.tile_width - tile.part.width;
    const int64_t below = level.height - int64_t(row) * level.tile_height - tile.part.height;
    tile.width = tile.part.x + tile.part.width + int(std::min<int64_t>(overlap_, right));
    tile.height = tile.part.y + tile.part.height + int(std::min<int64_t>(overlap_, below));
    return tile;
  }

 private:
  std::string folder_, format_;
  int overlap_ = 0, stored_ = 0;  // stored_: levels
};

// Zoomify: levels halve until one fits into a tile, which is tier 0. Tiles are numbered from there,
// row by row; 256 of them are a group.
class Zoomify : public TileFolder {
 public:
  Zoomify(const std::string& file, const XmlElement& image)
      : folder_((fs::path(file).parent_path() / "").string()) {
    const int tile = int(image.number("TILESIZE", 16, largest_tile));
    const int64_t width = image.number("WIDTH", 1, longest_picture);
    const int64_t height = image.number("HEIGHT", 1, longest_picture);
    set_levels(width, height, tile, 0, file);
    const int last = int(levels_.size()) - 1;
    const std::shared_ptr<Piece> coarsest = read_tile_file(file_of({1, last, 0, 0}).paths);
    const auto fits = [&] {
      return !coarsest ||
             (levels_.back().width == coarsest->width && levels_.back().height == coarsest->height);
    };
    if (fits()) return;
    set_levels(width, height, tile, 1, file);
    if (!fits()) set_levels(width, height, tile, 0, file);
  }

 protected:
  TileFile file_of(PieceKey key) const override {
    const PyramidLevel& level = levels_[size_t(key.level())];
    const int column = int(key.column()), row = int(key.row());
    const int64_t number =
        first_[size_t(key.level())] + int64_t(row) * level.columns() + int64_t(column);
    const std::string name = folder_ + "TileGroup" + std::to_string(number / 256) + "/" +
                             std::to_string(int(first_.size()) - 1 - key.level()) + "-" +
                             std::to_string(column) + "-" + std::to_string(row);
    const int wide = level.width_at(column), high = level.height_at(row);
    return {{name + ".jpg", name + ".png"}, wide, high, {0, 0, wide, high}};
  }

 private:
  // round: 1 to round sizes up, 0 down.
  void set_levels(int64_t width, int64_t height, int tile, int round, const std::string& file) {
    levels_.clear();
    for (;;) {
      levels_.push_back(level_of(width, height, tile));
      check_level(levels_.back(), file);
      if (std::max(width, height) <= tile) break;
      width = std::max<int64_t>((width + round) / 2, 1);
      height = std::max<int64_t>((height + round) / 2, 1);
    }
    first_.assign(levels_.size(), 0);
    for (size_t i = levels_.size() - 1; i > 0; i--)
      first_[i - 1] = first_[i] + int64_t(levels_[i].columns()) * levels_[i].rows();
  }

  std::string folder_;
  std::vector<int64_t> first_;  // the number of each level's first tile
};

template <class Folder>
std::shared_ptr<const PicturePyramid> open_folder(const std::string& file, const XmlElement& root) {
  struct Opened : Folder {
    Opened(const std::string& file, const XmlElement& root) : Folder(file, root) {
      this->add_coarser_levels(file);
    }
  };
  return std::make_shared<Opened>(file, root);
}

}  // namespace

Fetched TileFolder::fetch_stored(PieceKey key) const {
  const TileFile wanted = file_of(key);
  std::string wrong, wrong_file;  // the first file of another size, and its sizes
  for (const std::string& path : wanted.paths) {
    if (!is_there(path)) continue;
    std::shared_ptr<Piece> piece = decode_tile_file(path);
    if (piece->width == wanted.width && piece->height == wanted.height) {
      const image::ImagePart all{0, 0, wanted.width, wanted.height};
      if (wanted.part != all) *piece = cut(*piece, wanted.part);
      return {std::move(piece), replaced_seconds};
    }
    if (!wrong.empty()) continue;
    wrong_file = path;
    wrong = "tile of " + size_text(piece->width, piece->height) + ", expected " +
            size_text(wanted.width, wanted.height);
  }
  if (!wrong.empty()) throw LoadError(wrong_file, "", wrong);
  return {nullptr, absent_seconds, absent_seconds};
}

// Takes the file that fetch_stored() would, if it is a JPEG and all of it is the tile.
std::vector<uint8_t> TileFolder::take_stored_jpeg(PieceKey key) const {
  const TileFile wanted = file_of(key);
  if (wanted.part != image::ImagePart{0, 0, wanted.width, wanted.height}) return {};
  for (const std::string& path : wanted.paths) {
    if (!is_there(path)) continue;
    const auto bytes = read_file<std::vector<uint8_t>>(path, most_tile_bytes);
    StoredJpeg jpeg = take_jpeg_file(bytes);
    if (jpeg.bytes.empty()) return {};
    if (jpeg.width != wanted.width || jpeg.height != wanted.height) continue;
    const bool is_shown = jpeg.channels == 1 || jpeg.channels == 3;
    return is_shown ? std::move(jpeg.bytes) : std::vector<uint8_t>();
  }
  return {};
}

std::shared_ptr<Piece> read_tile_file(const std::vector<std::string>& paths) {
  for (const std::string& path : paths)
    if (is_there(path)) return decode_tile_file(path);
  return nullptr;
}

bool can_be_cut(const PyramidLevel& level) {
  constexpr int smallest_tile = 16;
  const auto [small, large] = std::minmax(level.tile_width, level.tile_height);
  return small >= smallest_tile && large <= largest_tile &&
         level.width <= int64_t(level.tile_width) * most_pieces_a_side &&
         level.height <= int64_t(level.tile_height) * most_pieces_a_side;
}

std::shared_ptr<const PicturePyramid> load_tile_folder(const std::string& file) {
  const std::string text = read_file(file, most_xml_bytes);
  pugi::xml_document document;
  const pugi::xml_parse_result parsed = document.load_buffer(text.data(), text.size());
  if (!parsed)
    throw LoadError(file, "byte " + std::to_string(parsed.offset),
                    std::string("is no XML: ") + parsed.description());
  const XmlElement root{file, document.document_element()};
  if (root.name() == "IMAGE_PROPERTIES") return open_folder<Zoomify>(file, root);
  if (root.name() == "info" || root.name() == "error")
    root.fail("", "is XML of IIIF 1.0; only its info.json is read");
  if (root.name() == "Collection") root.fail("", "is a collection of Deep Zoom, no picture");
  if (root.name() != "Image")
    root.fail("", "is neither Deep Zoom (Image) nor Zoomify (IMAGE_PROPERTIES)");
  const std::string_view space = root.node.attribute("xmlns").value();
  if (!space.empty() && !space.ends_with("schemas.microsoft.com/deepzoom/2008") &&
      !space.ends_with("schemas.microsoft.com/deepzoom/2009"))
    root.fail("xmlns", "\"" + std::string(space) + "\" is no namespace of Deep Zoom");
  return open_folder<DeepZoom>(file, root);
}

}  // namespace wellspring::store
