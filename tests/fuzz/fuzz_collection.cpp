// SPDX-License-Identifier: Apache-2.0
// Files of collections, and the map of those that are accepted. The first byte chooses the kind.
#include <cmath>

#include "collection/level.h"
#include "collection/read/read_records.h"
#include "fuzz/fuzz.h"

namespace wellspring::fuzz {

void fuzz_collection(Bytes bytes) {
  using namespace collection;
  if (bytes.empty()) return;
  constexpr const char* names[] = {"a.csv", "a.json", "a.jsonl"};
  load([&] {
    Records records = read_records_text(names[bytes[0] % 3], text_of(bytes.subspan(1)));
    require(!records.all.empty(), "a collection that is accepted has records");
    for (const Record& record : records.all) {
      require(!record.id.empty() && !record.title.empty(), "a record has an id and a title");
      require(record.terms.size() <= most_terms, "a record has few terms");
      for (const uint32_t term : record.terms)
        require(term < records.terms.size(), "terms are known");
    }
    if (records.all.size() > 40) return;  // their maps would take long
    const Collection made = make_collection(std::move(records));
    const MapLevel level = make_first_level(made);
    require(std::isfinite(level.layout.stress), "a map has a stress");
    const auto next = take_step(made, level, {level.shown[0], 1, {}});
    require(next && !next->region.empty(), "a circle holds its own middle");
  });
}

}  // namespace wellspring::fuzz
