// SPDX-License-Identifier: Apache-2.0
// Files that others may read at any time.
#pragma once
#include <span>
#include <string>

namespace wellspring {

// The whole file or none of it: written beside its place, then renamed over it. Throws LoadError.
void write_file(const std::string& path, std::span<const char> bytes);

}  // namespace wellspring
