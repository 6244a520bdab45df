// SPDX-License-Identifier: Apache-2.0
// Finishes the items of a painting while it is read.
#pragma once
#include "store/painting/painting.h"

namespace wellspring::store {

// Works out what follows from the rest of an item: bounds, cost, region, and by drawing it small,
// its mean colour. Its symbols are finished before.
void finish_item(PaintItem& item, const Painting& painting);

}  // namespace wellspring::store
