// SPDX-License-Identifier: Apache-2.0
// JPEG by libjpeg-turbo (TurboJPEG API), one handle per thread.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "frame/frame.h"

namespace wellspring {

// quality 1..100; full_chroma: 4:4:4 instead of 4:2:0. Reuses `out`'s memory.
void encode_jpeg(const Image8& image, int quality, bool full_chroma, std::vector<uint8_t>& out);
// Throws LoadError{file,...} when the bytes are no JPEG or larger than 16384 a side.
Image8 decode_jpeg(std::span<const uint8_t> bytes, const char* file);

}  // namespace wellspring
