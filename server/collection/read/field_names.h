// SPDX-License-Identifier: Apache-2.0
// How a file of records names what a map needs, and how large it may be.
#pragma once
#include <cstddef>
#include <string>

#include "base/layers.h"

namespace wellspring::collection {

inline constexpr size_t most_collection_bytes = size_t(256) << 20;
inline constexpr size_t most_record_bytes = size_t(1) << 20;  // a line of a file of lines

// Names the columns of a table, or the members of flat JSON; an empty name is found by the usual
// ones. Others that a file has are not read.
struct FieldNames {
  std::string id, title, maker, date, subjects, materials, colors, link, picture;
};

}  // namespace wellspring::collection
