// SPDX-License-Identifier: Apache-2.0
// What somebody may have meant who wrote a name that is not there.
#pragma once
#include <span>
#include <string>
#include <string_view>

namespace wellspring {

// "; did you mean 'x'?" with the nearest of `known` by edits (insertions, deletions, changed and
// swapped letters; case counts a little), or "" where none is near: at most a third of the letters.
// Of equally near ones the first.
std::string did_you_mean(std::string_view name, std::span<const std::string> known);

// "a, b, c": all of them, or the first `most` and how many more.
std::string list_names(std::span<const std::string> known, size_t most = 20);

}  // namespace wellspring
