// SPDX-License-Identifier: Apache-2.0
// Reads trained weights in the format of Intel Open Image Denoise (.tza): named tensors, here
// always as 32-bit floats. Numbers are little-endian: u16 0x41D7, u8 major 2, u8 minor, u64 offset
// of the table; the table: u32 count, then of each tensor u16 length and name, u8 dimensions n, n
// times u32 size, n characters of layout, a character of type (h: half, f: float), u64 offset of
// its data.
#pragma once
#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace wellspring::denoise {

struct Tensor {
  std::vector<int> sizes;  // oihw: outputs, inputs, rows, columns; x: one size
  std::vector<float> values;
};

using Weights = std::map<std::string, Tensor>;

// Reads the weights of a file. `path` is only for messages. No number of the file is trusted:
// throws LoadError naming the byte. Memory is bounded by the file's size. NaN and infinity are
// refused.
Weights read_weights(std::span<const std::byte> file, const std::string& path);
Weights load_weights(const std::string& path);

}  // namespace wellspring::denoise
