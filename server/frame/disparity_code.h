// SPDX-License-Identifier: Apache-2.0
// Codes the disparities (1 / depth) of a picture in few bytes, for displays that reproject it. On a
// plane they are linear in the picture, and rooms are made of planes: every row is cut into runs
// that lie on one plane each, mostly those that the row above has, and mostly ending where they end
// there. The little that is then left to say is deflated. Disparities are in whole units; decoded
// ones are off by at most worst_units of them.
//
// Numbers are little-endian. The bytes: u32 runs, u32 planes, u32 values, u32 long lengths, then a
// zlib stream of arrays, one after the other, each of numbers of 16 bits as all their low bytes,
// then all their high bytes: u8 kind of each run; u8 length of each run; u16 long lengths; of
// planes u16 at their first pixel, s16 slopes across and down, in units / 256; u16 values. Kind of
// a run, by what the row above has over its first pixel: 0 the plane that is there; 1 the plane of
// the run after it; 2 the plane of the run before the last one in this row; 3 the next plane, which
// begins here; 4 no plane, its pixels are the next values. Length of kind 0 and 1: how much farther
// it ends than that run above, zigzag (0, -1, 1, -2 ...), else pixels less one; 255: the next long
// length says so. If there is no such run, or it has no plane, kinds 0 to 2 are an error.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace wellspring::frame {

inline constexpr float worst_units = 2.5f;
inline constexpr int most_disparity = 65535;  // units; nearer places count as that

// Appends the code to `out`. `unit`: disparity of one unit, above 0.
void encode_disparity(std::span<const float> disparity, int width, int height, float unit,
                      std::vector<uint8_t>& out);
// Returns false if the bytes are no picture of that size; `disparity` is then of no use. Takes no
// more memory than such a picture needs, whatever the bytes say.
bool decode_disparity(std::span<const uint8_t> bytes, int width, int height, float unit,
                      std::vector<float>& disparity);

}  // namespace wellspring::frame
