// SPDX-License-Identifier: Apache-2.0
// Unpacks LZF (Marc Lehmann's LibLZF), with which PCD files are compressed.
#pragma once
#include <string>
#include <string_view>

#include "base/layers.h"

namespace wellspring::scan {

// Unpacks exactly `size` bytes; false: the data are damaged, or are of another size.
bool unpack_lzf(std::string_view packed, size_t size, std::string& bytes);

}  // namespace wellspring::scan
