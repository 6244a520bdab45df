// SPDX-License-Identifier: Apache-2.0
// JPEG by libjpeg-turbo (TurboJPEG API), one handle per thread.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "frame/frame.h"
#include "frame/tiles.h"

namespace wellspring::frame {

// quality 1..100; full_chroma: 4:4:4 instead of 4:2:0. Overwrites what follows the first `skip`
// bytes of `out`, which is grown to hold them; nothing but `out` is kept afterwards.
void encode_jpeg(const Image8& image, int quality, bool full_chroma, std::vector<uint8_t>& out,
                 size_t skip = 0);
// Likewise of a part of the picture, which must lie within it.
void encode_jpeg(const Image8& image, const ImagePart& part, int quality, bool full_chroma,
                 std::vector<uint8_t>& out, size_t skip = 0);
// A comment of at most 65533 bytes (longer ones are cut) behind the beginning of a JPEG file.
void add_jpeg_comment(const std::string& comment, std::vector<uint8_t>& jpeg);
// Throws LoadError{file,...} when the bytes are no JPEG or larger than 16384 a side.
Image8 decode_jpeg(std::span<const uint8_t> bytes, const char* file);

}  // namespace wellspring::frame
