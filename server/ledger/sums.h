// SPDX-License-Identifier: Apache-2.0
// What a museum's director reads: how much of what there was on a day. Sums and nothing else: no
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
  int64_t day = 0;   // since 1970-01-01, of the local calendar
  std::string what;  // "visits", "dwell_seconds" ...
  std::string key;   // the exhibit's id, and of what of it: "castle/well"
  auto operator<=>(const SumKey&) const = default;
};
using Sums = std::map<SumKey, double>;

void add(Sums& to, const Sums& more);

// "2026-05-31"
std::string day_text(int64_t day);
// Empty: is no such day.
std::optional<int64_t> parse_day(std::string_view text);

// RFC 4180, with a first line of names: day,what,key,value. Values have at most one decimal. A text
// that a spreadsheet would take for a formula begins with '.
std::string write_csv(const Sums& sums);

// The file of a ledger: a table of day, what, key and value, in write-ahead mode. It is opened for
// each use, so that it may be copied, moved or mended while servers run.

// Adds to what stands there, in one transaction; makes file and folder. A damaged file is renamed
// to FILE.damaged-YYYYMMDD-HHMMSS, logged, and begun anew. Throws std::runtime_error where it
// cannot be written, or is locked for longer than `patience` milliseconds: then nothing is.
void add_to_file(const std::string& file, const Sums& sums, int patience);

// Nothing, where there is no file. Throws std::runtime_error where it cannot be read.
Sums read_from_file(const std::string& file, int64_t from, int64_t to, int patience);

}  // namespace wellspring::ledger
