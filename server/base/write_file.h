// SPDX-License-Identifier: Apache-2.0
// Files that others may read at any time.
#pragma once
#include <cstdint>
#include <span>
#include <string>

namespace wellspring {

// The whole file or none of it: written beside its place, then renamed over it. Throws LoadError.
void write_file(const std::string& path, std::span<const char> bytes);

// Files that killed programs had half written, in a folder and those below it. They are taken away,
// unless somebody writes them or has begun them within a minute; this says how much that was.
struct Unfinished {
  size_t files = 0;
  uint64_t bytes = 0;
};
Unfinished remove_unfinished(const std::string& folder);

}  // namespace wellspring
