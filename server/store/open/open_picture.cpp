// SPDX-License-Identifier: Apache-2.0
#include "store/open/open_picture.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "base/load_error.h"
#include "store/format/iiif_folder.h"
#include "store/format/iiif_service.h"
#include "store/format/plain_picture.h"
#include "store/format/tiff_pyramid.h"
#include "store/format/tile_folder.h"
#include "store/painting/painted_picture.h"
#include "store/remote/http_get.h"

namespace wellspring::store {
namespace {

namespace fs = std::filesystem;
using namespace std::string_view_literals;

std::string first_bytes(const std::string& file) {
  std::array<char, 64> bytes{};
  std::ifstream in(file, std::ios::binary);
  in.read(bytes.data(), bytes.size());
  if (!in.is_open() || in.bad()) throw LoadError(file, "", "cannot be read");
  return {bytes.data(), size_t(in.gcount())};
}

// Names a format that is known and not read; empty: it is not known.
std::string_view foreign_format(std::string_view bytes) {
  const std::string_view kind = bytes.substr(std::min<size_t>(bytes.size(), 4), 8);
  if (kind.starts_with("ftypavi")) return "AVIF";
  if (kind.starts_with("ftyphei") || kind.starts_with("ftypmif")) return "HEIF";
  if (kind.starts_with("jP  ") || bytes.starts_with("\xff\x4f\xff\x51")) return "JPEG 2000";
  if (bytes.starts_with("\xff\x0a") || kind.starts_with("JXL ")) return "JPEG XL";
  if (bytes.starts_with("GIF8")) return "GIF";
  if (bytes.starts_with("BM")) return "BMP";
  if (bytes.starts_with("8BPS")) return "Photoshop";
  return {};
}

}  // namespace

std::shared_ptr<const PicturePyramid> open_picture(const std::string& path,
                                                   const std::string& layer,
                                                   const std::string& language,
                                                   const std::vector<std::string>& allowed_hosts,
                                                   const BandView& bands) {
  std::error_code error;
  const auto refuse_view = [&] {
    if (bands != BandView{})
      throw LoadError(path, "", "has no bands: lamps and wavelengths are for TIFFs of many bands");
  };
  if (is_http_address(path)) {
    if (!layer.empty()) throw LoadError(path, "", "has no layers: only a .painting.json has");
    refuse_view();
    return load_iiif_service(path, allowed_hosts);
  }
  if (fs::is_directory(path, error)) {
    refuse_view();
    for (const char* name : {"ImageProperties.xml", "info.json"})
      if (const fs::path file = fs::path(path) / name; fs::exists(file, error))
        return open_picture(file.string());
    throw LoadError(path, "",
                    "folder has neither ImageProperties.xml (Zoomify) nor info.json (IIIF)");
  }
  if (!fs::exists(path, error)) throw LoadError(path, "", "is not there");
  if (!fs::is_regular_file(path, error)) throw LoadError(path, "", "is no regular file");
  const std::string bytes = first_bytes(path);
  const bool is_painting = path.ends_with(".painting.json");
  if (!layer.empty() && !is_painting)
    throw LoadError(path, "", "has no layers: only a .painting.json has");
  for (const std::string_view magic : {"II*\0"sv, "MM\0*"sv, "II+\0"sv, "MM\0+"sv})
    if (bytes.starts_with(magic)) return load_tiff(path, most_whole_texels, seconds_now, bands);
  refuse_view();
  if (is_painting) return open_painting(path, layer, language);
  if (path.ends_with(".geojson")) return open_geojson(path, language);
  if (bytes.empty()) throw LoadError(path, "", "is empty");
  for (const std::string_view magic : {"\x89PNG"sv, "\xff\xd8\xff"sv, "RIFF"sv})
    if (bytes.starts_with(magic)) return load_plain_picture(path);
  std::string_view text = bytes;
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
  if (text.starts_with("<")) return load_tile_folder(path);
  if (text.starts_with("{")) return load_iiif_folder(path);
  if (const std::string_view format = foreign_format(bytes); !format.empty())
    throw LoadError(path, "",
                    std::string(format) + " is not read; turn it into a TIFF, JPEG or PNG first");
  throw LoadError(path, "",
                  "is no picture that is known: Deep Zoom, Zoomify, IIIF, TIFF, JPEG, "
                  "PNG, WebP, .geojson or .painting.json");
}

}  // namespace wellspring::store
