// SPDX-License-Identifier: Apache-2.0
#include "store/format/iiif_service.h"

#include <algorithm>
#include <string_view>

#include "base/load_error.h"
#include "image/image.h"
#include "store/format/iiif_info.h"
#include "store/picture/kept_levels.h"
#include "store/picture/texels.h"
#include "store/remote/http_get.h"

namespace wellspring::store {
namespace {

constexpr size_t most_info_answer = size_t(1) << 20, most_tile_answer = size_t(16) << 20;
// Seconds after which a tile is asked for again, in case the picture was replaced: a day.
constexpr double renewed_seconds = 86400;

// Returns the address without what follows the service's base.
std::string base_of(std::string address) {
  address.erase(std::min(address.find_first_of("?#"), address.size()));
  constexpr std::string_view info = "/info.json";
  if (address.ends_with(info)) address.erase(address.size() - info.size());
  while (address.ends_with('/')) address.pop_back();
  return address;
}

// Repeats the last column and row, or leaves them out.
Piece fit_piece(const Piece& from, int width, int height) {
  Piece fitted = make_piece(width, height);
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width; x++) {
      const size_t at = size_t(std::min(y, from.height - 1)) * size_t(from.width) +
                        size_t(std::min(x, from.width - 1));
      std::copy_n(&from.bytes[at * 4], 4,
                  &fitted.bytes[(size_t(y) * size_t(width) + size_t(x)) * 4]);
    }
  return fitted;
}

class IiifService : public KeptLevels {
 public:
  IiifService(const std::string& address, const std::vector<std::string>& hosts, double patience)
      : base_(base_of(address)) {
    limits_.hosts = hosts;
    limits_.seconds = patience;
    limits_.most_bytes = most_info_answer;
    limits_.accept = "application/ld+json, application/json";
    const std::string file = base_ + "/info.json";
    const auto text = http_get(file, limits_);
    if (!text) throw LoadError(file, "", "is not there");
    info_ = read_iiif_info(file, {reinterpret_cast<const char*>(text->data()), text->size()},
                           IiifHost::server);
    levels_ = info_.levels;
    limits_.most_bytes = most_tile_answer;
    limits_.accept = "image/*";
    add_coarser_levels(file);
  }

 protected:
  Fetched fetch_stored(PieceKey key) const override {
    for (const std::string& address : addresses_of(key))
      if (const auto bytes = http_get(address, limits_))
        return {decode(key, *bytes, address), renewed_seconds};
    return {nullptr, absent_seconds, absent_seconds};
  }

 private:
  std::shared_ptr<const Piece> decode(PieceKey key, const std::vector<uint8_t>& bytes,
                                      const std::string& address) const {
    const PyramidLevel& level = levels_[size_t(key.level())];
    const int width = level.width_at(int(key.column())), height = level.height_at(int(key.row()));
    const int64_t most_texels = int64_t(width + 1) * (height + 1);
    Piece piece = to_piece(image::decode_codes(bytes, most_texels, address));
    if (piece.width == width && piece.height == height)
      return std::make_shared<Piece>(std::move(piece));
    if (std::abs(piece.width - width) > 1 || std::abs(piece.height - height) > 1)
      throw LoadError(address, "",
                      "tile of " + std::to_string(piece.width) + " x " +
                          std::to_string(piece.height) + ", expected " + std::to_string(width) +
                          " x " + std::to_string(height));
    return std::make_shared<Piece>(fit_piece(piece, width, height));
  }

  // Returns the canonical address of a tile. The files of level 0 may be named otherwise: they have
  // a second one.
  std::vector<std::string> addresses_of(PieceKey key) const {
    const PyramidLevel& level = levels_[size_t(key.level())];
    const int width = level.width_at(int(key.column())), height = level.height_at(int(key.row()));
    const IiifRegion region = region_of(info_, key);
    const bool is_all = region.width == info_.width && region.height == info_.height;
    const bool is_whole = is_all && width == info_.width && height == info_.height;
    const std::string wide = std::to_string(width) + ",", both = wide + std::to_string(height);
    std::string size = info_.version == 3 ? both : wide, other = info_.version == 3 ? wide : both;
    if (is_whole) other = size, size = info_.version == 3 ? "max" : "full";
    const std::string place = base_ + "/" + (is_all ? "full" : to_text(region)) + "/";
    const std::string end =
        std::string("/0/") + (info_.version == 1 ? "native." : "default.") + info_.format;
    std::vector<std::string> addresses = {place + size + end};
    if (info_.compliance == 0) addresses.push_back(place + other + end);
    return addresses;
  }

  std::string base_;
  HttpLimits limits_;
  IiifInfo info_;
};

}  // namespace

std::shared_ptr<const PicturePyramid> load_iiif_service(const std::string& address,
                                                        const std::vector<std::string>& hosts,
                                                        double patience) {
  return std::make_shared<IiifService>(address, hosts, patience);
}

}  // namespace wellspring::store
