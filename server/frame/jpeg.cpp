// SPDX-License-Identifier: Apache-2.0
#include "frame/jpeg.h"

#include <turbojpeg.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>

#include "base/load_error.h"

namespace wellspring::frame {
namespace {

constexpr int largest_side = 16384;

struct CloseHandle {
  void operator()(void* handle) const { tjDestroy(handle); }
};
using Handle = std::unique_ptr<void, CloseHandle>;

}  // namespace

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
  // Several times what most pictures need: of memory that is not written to, the system gives none.
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
  constexpr size_t most = 65533, begin = 2;  // begin: of the file, SOI
  const size_t size = std::min(comment.size(), most) + 2;
  std::vector<uint8_t> segment = {0xff, 0xfe, uint8_t(size >> 8), uint8_t(size)};
  segment.insert(segment.end(), comment.begin(), comment.begin() + ptrdiff_t(size - 2));
  jpeg.insert(jpeg.begin() + begin, segment.begin(), segment.end());
}

Image8 decode_jpeg(std::span<const uint8_t> bytes, const char* file) {
  Handle handle(tjInitDecompress());
  if (!handle) throw LoadError(file, "", tjGetErrorStr2(nullptr));
  Image8 image;
  int chroma = 0, colorspace = 0;
  if (tjDecompressHeader3(handle.get(), bytes.data(), bytes.size(), &image.width, &image.height,
                          &chroma, &colorspace) != 0)
    throw LoadError(file, "JPEG header", tjGetErrorStr2(handle.get()));
  if (image.width < 1 || image.height < 1 || image.width > largest_side ||
      image.height > largest_side)
    throw LoadError(file, "JPEG header",
                    "picture of " + std::to_string(image.width) + "x" +
                        std::to_string(image.height) + " is larger than 16384 a side");
  image.rgb.resize(size_t(image.width) * size_t(image.height) * 3);
  if (tjDecompress2(handle.get(), bytes.data(), bytes.size(), image.rgb.data(), image.width, 0,
                    image.height, TJPF_RGB, TJFLAG_STOPONWARNING | TJFLAG_LIMITSCANS) != 0)
    throw LoadError(file, "JPEG data", tjGetErrorStr2(handle.get()));
  return image;
}

}  // namespace wellspring::frame
