// SPDX-License-Identifier: Apache-2.0
// Makes names that look the same the same: "é" may be one letter, or "e" and an accent, as disks
// and exporters of some systems write it.
#pragma once
#include <span>
#include <string>
#include <string_view>

namespace wellspring {

// Returns Unicode's normalisation form C (UAX #15), by which names are compared. Text that is no
// UTF-8 stays as it is.
std::string nfc(std::string_view text);

// Guesses which name was meant by one that does not exist.

// Returns "; did you mean 'x'?" with the nearest of `known` by edits (insertions, deletions,
// changed and swapped letters; case counts a little), or "" if none is near: at most a third of the
// letters. Among equally near names the first wins.
std::string did_you_mean(std::string_view name, std::span<const std::string> known);

// Returns "a, b, c": all names, or the first `most` and how many more there are.
std::string list_names(std::span<const std::string> known, size_t most = 20);

}  // namespace wellspring
