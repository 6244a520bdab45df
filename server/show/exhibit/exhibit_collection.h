// SPDX-License-Identifier: Apache-2.0
// Reads the collection of a package, which visitors browse as a map, out of its exhibit.json: see
// content/README.md.
#pragma once
#include <map>

#include "collection/collection.h"
#include "show/exhibit/exhibit.h"
#include "show/exhibit/json_fields.h"

namespace wellspring::show {

struct ExhibitCollection {
  LocalText title;
  Collection collection;
  std::map<int, int> points;  // record -> index into Exhibit::points: "take me there"
};

// Reads "collection". Call when the exhibit's objects are there.
void read_collection(Exhibit& exhibit, FieldReader& root);

}  // namespace wellspring::show
