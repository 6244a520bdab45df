// SPDX-License-Identifier: Apache-2.0
#include "store/format/plain_picture.h"

#include <algorithm>

#include "base/load_error.h"
#include "base/read_file.h"
#include "image/image.h"
#include "store/format/color_profile.h"
#include "store/format/embedded.h"

namespace wellspring::store {
namespace {

constexpr size_t most_picture_bytes = size_t(512) << 20;

// Reads a JPEG of four inks.
Piece read_cmyk_jpeg(std::span<const uint8_t> bytes, const Embedded& embedded,
                     const ColorProfile* profile, const std::string& file) {
  image::ImageCodes codes = image::decode_cmyk_jpeg(bytes, file);
  const int wide = codes.width, high = codes.height;
  if (wide != embedded.width || high != embedded.height)
    throw LoadError(file, "", "picture tells two sizes");
  std::vector<uint8_t>& inks = codes.codes8;
  if (embedded.is_inverted)
    for (uint8_t& ink : inks) ink = uint8_t(255 - ink);
  Piece piece = make_piece(wide, high);
  convert_cmyk(profile, inks.data(), piece.bytes.data(), inks.size() / 4);
  for (size_t i = 3; i < piece.bytes.size(); i += 4) piece.bytes[i] = 255;
  return piece;
}

}  // namespace

std::shared_ptr<const PicturePyramid> load_plain_picture(const std::string& file,
                                                         int64_t most_texels) {
  const auto bytes = read_file<std::vector<uint8_t>>(file, most_picture_bytes);
  const Embedded embedded = find_embedded(bytes);
  if (embedded.width > 0 && embedded.height > 0 &&
      (embedded.width > most_texels / embedded.height ||
       std::max(embedded.width, embedded.height) > image::largest_side))
    fail_as_too_large(file, embedded.width, embedded.height);
  const ColorKind kind = embedded.channels == 1   ? ColorKind::grey
                         : embedded.channels == 4 ? ColorKind::cmyk
                                                  : ColorKind::rgb;
  const std::shared_ptr<const ColorProfile> profile = make_color_profile(embedded.profile, kind);
  if (kind == ColorKind::cmyk)
    return make_pyramid(
        turn(read_cmyk_jpeg(bytes, embedded, profile.get(), file), embedded.orientation));
  Piece piece = to_piece(image::decode_codes(bytes, most_texels, file));
  if (profile) profile->convert(piece.bytes.data(), piece.bytes.data(), piece.bytes.size() / 4);
  return make_pyramid(turn(std::move(piece), embedded.orientation));
}

}  // namespace wellspring::store
