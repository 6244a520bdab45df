// SPDX-License-Identifier: Apache-2.0
// Reads a collection that strangers keep: a table (.csv, .tsv), JSON (an array, or an object that
// has one), a record a line (.jsonl, .ndjson), or a folder of JSON files. Records of JSON are flat,
// Linked Art's (JSON-LD) or Tate's; each says by itself which. What is wrong is refused, or put
// right and noted with its line.
#pragma once
#include <string>
#include <string_view>

#include "collection/records.h"

namespace wellspring::collection {

inline constexpr size_t most_collection_bytes = size_t(256) << 20;
inline constexpr size_t most_record_bytes = size_t(1) << 20;  // a line of a file of lines

// Names the columns of a table, or the members of flat JSON; an empty name is found by the usual
// ones. Others that a file has are not read.
struct FieldNames {
  std::string id, title, maker, date, subjects, materials, colors, link, picture;
};

// Throws LoadError if nothing can be used, if a named field is nowhere, and for more than
// most_records.
Records read_records(const std::string& path, const FieldNames& names = {});
// Reads the text of a file whose name says what kind it is.
Records read_records_text(const std::string& file, std::string_view text,
                          const FieldNames& names = {});

}  // namespace wellspring::collection
