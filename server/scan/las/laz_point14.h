// SPDX-License-Identifier: Apache-2.0
// Decodes items of chunks whose points lie in layers, beginning with the one that holds the place:
// each attribute is a stream of its own, and one that never changes has none (point formats 6 to
// 10). Models are kept by the scanner's channel, of which there are four.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "scan/las/laz_items.h"

namespace wellspring::scan {

using LazLayer = std::span<const uint8_t>;

class LayeredItem {
 public:
  virtual ~LayeredItem() = default;
  // Writes the next point's bytes. The item with the place sets the channel by which those behind
  // it choose their models.
  virtual void read(uint8_t* item, uint32_t& channel) = 0;
  virtual bool is_damaged() const = 0;
};

// A layer's stream, if its attribute ever changes.
struct OptionalStream {
  bool is_there = false;
  ArithmeticDecoder decoder;

  OptionalStream() = default;
  explicit OptionalStream(LazLayer layer) : is_there(!layer.empty()) {
    if (is_there) decoder = ArithmeticDecoder(layer);
  }
  bool is_damaged() const { return is_there && decoder.is_damaged(); }
};

inline constexpr size_t point14_layers = 9;

// Sets the channel to that of the chunk's first point. Borrows the layers' bytes.
std::unique_ptr<LayeredItem> make_point14(const LazItem& item, const uint8_t* first,
                                          std::span<const LazLayer> layers, uint32_t& channel);

}  // namespace wellspring::scan
