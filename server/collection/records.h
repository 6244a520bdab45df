// SPDX-License-Identifier: Apache-2.0
// Holds all that a museum tells of its objects, whatever file it was in.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/vec.h"

namespace wellspring::collection {

inline constexpr size_t most_records = 100'000;
inline constexpr size_t most_terms = 64;     // a record has
inline constexpr size_t most_swatches = 16;  // a record has
inline constexpr size_t most_text = 300;     // bytes; longer ones are cut

enum class TermKind : uint8_t { subject, material };

// A word by which objects are described; the same in both kinds is two terms.
struct Term {
  TermKind kind = TermKind::subject;
  std::string name;
};

struct Swatch {
  dvec3 lab{0};  // CIE L*, a*, b* beside D65
  double weight = 1;
  std::string code;  // "#rrggbb", for browsers
};

struct Record {
  std::string id, title, maker, date;
  std::string link, picture;  // addresses, https or http
  std::optional<double> year;
  std::vector<Swatch> palette;
  std::vector<uint32_t> terms;  // into Records::terms, each once
};

// Tells what was left out, or put right.
struct RecordNote {
  std::string where, what;
};

struct Records {
  std::vector<Record> all;
  std::vector<Term> terms;
  std::vector<RecordNote> notes;
};

}  // namespace wellspring::collection
