// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string_view>
#include <turbojpeg.h>

#include "base/load_error.h"
#include "image/image.h"

namespace wellspring::image {
namespace {

struct CloseHandle {
  void operator()(void* handle) const { tjDestroy(handle); }
};
using Handle = std::unique_ptr<void, CloseHandle>;

template <class Picture>
Picture decode(std::span<const uint8_t> bytes, int64_t most_pixels, const std::string& file,
               std::vector<uint8_t> Picture::*texels, int format, bool shows_wrong) {
  const Handle handle(tjInitDecompress());
  const auto fail = [&](const char* where) {
    throw LoadError(file, where,
                    std::string("picture cannot be decoded: ") + tjGetErrorStr2(handle.get()));
  };
  Picture image;
  int chroma = 0, colors = 0;
  if (!handle || tjDecompressHeader3(handle.get(), bytes.data(), bytes.size(), &image.width,
                                     &image.height, &chroma, &colors) != 0)
    fail("JPEG header");
  check_size(image.width, image.height, most_pixels, file);
  (image.*texels).resize(size_t(image.width) * size_t(image.height) * size_t(tjPixelSize[format]));
  if (tjDecompress2(handle.get(), bytes.data(), bytes.size(), (image.*texels).data(), image.width,
                    0, image.height, format,
                    TJFLAG_LIMITSCANS | (shows_wrong ? 0 : TJFLAG_STOPONWARNING)) == 0)
    return image;
  const std::string_view told = tjGetErrorStr2(handle.get());
  const bool is_warning = tjGetErrorCode(handle.get()) == TJERR_WARNING;
  if (!shows_wrong || !is_warning || told.find("remature end") != told.npos) fail("JPEG data");
  return image;
}

}  // namespace

Image8 decode_jpeg(std::span<const uint8_t> bytes, const std::string& file) {
  return decode(bytes, int64_t(largest_side) * largest_side, file, &Image8::rgb, TJPF_RGB, false);
}
ImageCodes decode_jpeg_codes(std::span<const uint8_t> bytes, int64_t most_pixels,
                             const std::string& file) {
  return decode(bytes, most_pixels, file, &ImageCodes::codes8, TJPF_RGBA, true);
}

ImageCodes decode_cmyk_jpeg(std::span<const uint8_t> bytes, const std::string& file) {
  return decode(bytes, int64_t(largest_side) * largest_side, file, &ImageCodes::codes8, TJPF_CMYK,
                true);
}

void encode_jpeg(const Image8& image, int quality, bool full_chroma, std::vector<uint8_t>& out,
                 size_t skip) {
  encode_jpeg(image, {0, 0, image.width, image.height}, quality, full_chroma, out, skip);
}

void encode_jpeg(const Image8& image, const ImagePart& part, int quality, bool full_chroma,
                 std::vector<uint8_t>& out, size_t skip) {
  if (part.width < 1 || part.height < 1 || part.width > largest_side ||
      part.height > largest_side || part.x < 0 || part.y < 0 || part.x + part.width > image.width ||
      part.y + part.height > image.height ||
      image.rgb.size() != size_t(image.width) * size_t(image.height) * 3)
    throw std::invalid_argument("encode_jpeg: no picture of a size JPEG can hold");
  thread_local Handle handle{tjInitCompress()};
  int chroma = full_chroma ? TJSAMP_444 : TJSAMP_420;
  unsigned long size = tjBufSize(part.width, part.height, chroma);
  // This is several times what most pictures need, but the system gives no memory until it is
  // written.
  auto room = std::make_unique_for_overwrite<unsigned char[]>(size);
  unsigned char* bytes = room.get();
  const uint8_t* first = &image.rgb[(size_t(part.y) * size_t(image.width) + size_t(part.x)) * 3];
  if (!handle ||
      tjCompress2(handle.get(), first, part.width, image.width * 3, part.height, TJPF_RGB, &bytes,
                  &size, chroma, std::clamp(quality, 1, 100), TJFLAG_NOREALLOC) != 0)
    throw std::runtime_error(std::string("encode_jpeg: ") + tjGetErrorStr2(handle.get()));
  out.resize(skip);
  out.reserve(skip + size);
  out.insert(out.end(), bytes, bytes + size);
}

void add_jpeg_comment(const std::string& comment, std::vector<uint8_t>& jpeg) {
  constexpr size_t most = 65533, begin = 2;  // begin: length of the file's beginning, SOI
  const size_t size = std::min(comment.size(), most) + 2;
  std::vector<uint8_t> segment = {0xff, 0xfe, uint8_t(size >> 8), uint8_t(size)};
  segment.insert(segment.end(), comment.begin(), comment.begin() + ptrdiff_t(size - 2));
  jpeg.insert(jpeg.begin() + begin, segment.begin(), segment.end());
}

}  // namespace wellspring::image
