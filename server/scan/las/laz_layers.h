// SPDX-License-Identifier: Apache-2.0
// Decodes all kinds of items whose points lie in layers: colour, waves and extra bytes.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "scan/las/laz_point14.h"

namespace wellspring::scan {

// Returns how many layers an item has.
size_t layers_of(const LazItem& item);

// `first` is the item of the chunk's first point, `layers` are as many as layers_of() says. The
// channel is that of the first point; the item with the place sets it. Borrows the layers' bytes.
std::unique_ptr<LayeredItem> make_layered_item(const LazItem& item, const uint8_t* first,
                                               std::span<const LazLayer> layers, uint32_t& channel);

}  // namespace wellspring::scan
