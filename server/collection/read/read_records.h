// SPDX-License-Identifier: Apache-2.0
// Reads a collection that strangers keep: a table (.csv, .tsv), JSON (an array, or an object that
// has one), a record a line (.jsonl, .ndjson), or a folder of JSON files. Records of JSON are flat,
// Linked Art's (JSON-LD) or Tate's; each says by itself which. Wrong text is refused, or put right
// and noted with its line.
#pragma once
#include <string>
#include <string_view>

#include "collection/read/field_names.h"
#include "collection/records.h"

namespace wellspring::collection {

// Throws LoadError if nothing can be used, if a named field is nowhere, and for more than
// most_records.
Records read_records(const std::string& path, const FieldNames& names = {});
// Reads the text of a file whose name says what kind it is.
Records read_records_text(const std::string& file, std::string_view text,
                          const FieldNames& names = {});

}  // namespace wellspring::collection
