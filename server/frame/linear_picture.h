// SPDX-License-Identifier: Apache-2.0
// The two linear formats, to and from memory: PFM (netpbm,
// http://www.pauldebevec.com/Research/HDR/PFM/) and OpenEXR (32-bit float, ZIP). Readers take the
// colour only and throw LoadError{path,...}.
#pragma once
#include <istream>
#include <string>
#include <vector>

#include "frame/frame.h"

namespace wellspring::frame {

inline constexpr int largest_picture_side = 16384;

std::vector<char> encode_pfm(const Frame& frame);
// `path` is only for messages. A depth plane, if there, is written as channel Z.
std::vector<char> encode_exr(const Frame& frame, const std::string& path,
                             const std::string& comment = {});

Frame decode_pfm(std::istream& in, const std::string& path);
// Scan lines or tiles, half or float; channels R, G, B, or Y alone, or the first layer that has
// them.
Frame decode_exr(std::istream& in, const std::string& path);

}  // namespace wellspring::frame
