// SPDX-License-Identifier: Apache-2.0
// Holds the sums that a museum's director reads: counts and amounts of one day. They tell of no
// visitor, no address, no time of day.
#pragma once
#include <compare>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace wellspring::ledger {

struct SumKey {
  int64_t day = 0;   // days since 1970-01-01, by the local calendar
  std::string what;  // "visits", "dwell_seconds" ...
  std::string key;   // the exhibit's id, and its part that is counted: "castle/well"
  auto operator<=>(const SumKey&) const = default;
};
using Sums = std::map<SumKey, double>;

void add(Sums& to, const Sums& more);

// Writes a day as "2026-05-31".
std::string day_text(int64_t day);
// Reads such a day; empty: there is no such day.
std::optional<int64_t> parse_day(std::string_view text);

// Writes CSV (RFC 4180) with a first line of names: day,what,key,value. Values have at most one
// decimal. A text that a spreadsheet would take for a formula begins with '.
std::string write_csv(const Sums& sums);

// Reads and writes the file of a ledger: a table of day, what, key and value. The file is opened
// for each use, so that it may be copied, moved or mended while servers run.

// Adds to the sums in the file, in one transaction; makes file and folder. A damaged file is
// renamed to FILE.damaged-YYYYMMDD-HHMMSS, logged, and begun anew. Throws std::runtime_error, and
// changes nothing, if the file cannot be written, or is locked for longer than `patience`
// milliseconds.
void add_to_file(const std::string& file, const Sums& sums, int patience);

// Reads sums; none if there is no file. Throws std::runtime_error if it cannot be read.
Sums read_from_file(const std::string& file, int64_t from, int64_t to, int patience);

}  // namespace wellspring::ledger
