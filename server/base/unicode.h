// SPDX-License-Identifier: Apache-2.0
// Names that look the same are the same: "é" may be one letter, or "e" and an accent, as disks and
// exporters of some systems write it.
#pragma once
#include <span>
#include <string>
#include <string_view>

namespace wellspring {

// Unicode's normalisation form C (UAX #15), by which names are compared. What is no UTF-8 stays.
std::string nfc(std::string_view text);

// What somebody may have meant who wrote a name that is not there.

// "; did you mean 'x'?" with the nearest of `known` by edits (insertions, deletions, changed and
// swapped letters; case counts a little), or "" where none is near: at most a third of the letters.
// Of equally near ones the first.
std::string did_you_mean(std::string_view name, std::span<const std::string> known);

// "a, b, c": all of them, or the first `most` and how many more.
std::string list_names(std::span<const std::string> known, size_t most = 20);

}  // namespace wellspring
