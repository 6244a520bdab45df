// SPDX-License-Identifier: Apache-2.0
// A collection that can be browsed: its records, and the set of each.
#pragma once
#include <span>
#include <vector>

#include "collection/records.h"
#include "collection/set_item.h"

namespace wellspring::collection {

inline constexpr int term_numbers = 4;  // by which a term has a place

struct Collection {
  Records records;
  Sets sets;  // in the order of the records
};

// A point of a record has its year, a colour, and a place among terms: there is one for each term,
// in the record's mean colour, and one for each colour, at the terms' mean place. Terms and colours
// together weigh the same. Years, colours and terms that are missing are the collection's mean, so
// that nothing is near for lack of them. Years far from nearly all others (Tukey 1977: "far out")
// count as the last one that is not, so that a few very old objects do not press the others
// together.
Collection make_collection(Records records);

// Returns a place for each term, so that terms which describe the same objects are near:
// correspondence analysis (Benzecri 1973), in which rare terms are drawn to the middle by an
// average one's count (as Joseph and Yu 2016 do with graphs). term_numbers numbers each.
std::vector<double> place_terms(const Records& records);

}  // namespace wellspring::collection
