// SPDX-License-Identifier: Apache-2.0
// The parts of a record that LASzip codes by themselves ("items"), and the decoders of those that
// lie in one stream, point by point (point formats 0 to 5).
#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "scan/las/laz_coder.h"

namespace wellspring::scan {

enum class LazItemKind : uint16_t {
  bytes = 0,
  point10 = 6,
  time11 = 7,
  color12 = 8,
  wave13 = 9,
  point14 = 10,
  color14 = 11,
  color_infrared14 = 12,
  wave14 = 13,
  bytes14 = 14
};

struct LazItem {
  LazItemKind kind = LazItemKind::bytes;
  uint16_t size = 0;     // bytes of a record
  uint16_t version = 0;  // the item's coding
};

// Says whether an item lies in layers, each a stream of its own.
inline bool is_layered(const LazItem& item) { return item.kind >= LazItemKind::point14; }

// Returns why an item cannot be decoded, a sentence; empty: it can.
std::string find_fault(const LazItem& item);

// Decodes one item of a chunk's points, from the second on.
class PointwiseItem {
 public:
  virtual ~PointwiseItem() = default;
  // Writes the next point's bytes, as many as the item has.
  virtual void read(ArithmeticDecoder& decoder, uint8_t* item) = 0;
};

// `first` is the item of the chunk's first point, which is not coded.
std::unique_ptr<PointwiseItem> make_pointwise_item(const LazItem& item, const uint8_t* first);

}  // namespace wellspring::scan
