// SPDX-License-Identifier: Apache-2.0
// Files by the names that other files give them.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace wellspring::gltf {

// Finds what a relative path means below a folder: the names as they are, else those of which
// Unicode says that they are the same (base/unicode.h). Returns nothing where there is no such file
// or folder. Does not judge "..": callers resolve it first.
std::optional<std::filesystem::path> find_file(const std::filesystem::path& folder,
                                               const std::filesystem::path& relative);

// Regular files below a folder, by their paths from there, in alphabetical order; the first `most`
// that are met.
std::vector<std::string> list_files(const std::filesystem::path& folder, size_t most = 2000);

// Whether a canonical path is the canonical folder or lies below it.
bool lies_in(const std::filesystem::path& path, const std::filesystem::path& folder);

}  // namespace wellspring::gltf
