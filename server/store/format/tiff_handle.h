// SPDX-License-Identifier: Apache-2.0
// Reads a TIFF by libtiff, as one thread does.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "store/format/tiff_page.h"

struct tiff;  // libtiff calls it TIFF

namespace wellspring::store {

// Holds libtiff's state of one reader. Its errors and warnings come here and nowhere else.
struct TiffHandle {
  int descriptor = -1;              // borrowed
  uint64_t size = 0, position = 0;  // bytes
  uint64_t page = 0;                // offset of the page that is chosen; 0: none
  std::string problem;              // the first since it was cleared
  ::tiff* tiff = nullptr;

  // `most_bytes`: that libtiff takes at once. Throws LoadError of `file` unless it is a TIFF.
  TiffHandle(const std::string& file, int descriptor, uint64_t size, int64_t most_bytes);
  ~TiffHandle();
  TiffHandle(const TiffHandle&) = delete;
  TiffHandle& operator=(const TiffHandle&) = delete;

  // Goes to a page; false: it cannot be read.
  bool choose(const TiffPage& wanted);
  // Returns a field of the page that is chosen; Number: uint16_t or uint32_t, as the tag has it.
  template <class Number>
  Number field(uint32_t tag, Number otherwise = 0) const;
  // Reads one block of a channel, or of all.
  bool read_codes(const TiffPage& from, int column, int row, int channel,
                  std::vector<uint8_t>& bytes);
  // Lets libtiff convert a block.
  bool read_any(const TiffPage& from, int column, int row, Piece& block);
};

}  // namespace wellspring::store
