// SPDX-License-Identifier: Apache-2.0
#include "gltf/find_file.h"

#include <algorithm>

#include "base/unicode.h"

namespace wellspring::gltf {

namespace fs = std::filesystem;

namespace {

constexpr size_t most_entries = 20'000;  // of a folder, that are compared

bool is_ascii(const std::string& text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return (c & 0x80) == 0; });
}

// The entry of a folder whose name is the same by Unicode; of several the first.
std::optional<fs::path> find_alike(const fs::path& folder, const std::string& name) {
  if (is_ascii(name)) return {};
  const std::string wanted = nfc(name);
  std::optional<fs::path> found;
  std::error_code ec;
  size_t looked_at = 0;
  for (fs::directory_iterator at(folder, ec), end; !ec && at != end; at.increment(ec)) {
    if (++looked_at > most_entries) break;
    const fs::path entry = at->path();
    if (nfc(entry.filename().string()) == wanted && (!found || entry < *found)) found = entry;
  }
  return found;
}

}  // namespace

std::optional<fs::path> find_file(const fs::path& folder, const fs::path& relative) {
  fs::path path = folder;
  std::error_code ec;
  for (const fs::path& part : relative) {
    if (part.empty() || part == ".") continue;
    if (fs::exists(path / part, ec)) {
      path /= part;
      continue;
    }
    const std::optional<fs::path> alike = find_alike(path, part.string());
    if (!alike) return {};
    path = *alike;
  }
  return path;
}

std::vector<std::string> list_files(const fs::path& folder, size_t most) {
  std::vector<std::string> names;
  std::error_code ec;
  for (fs::recursive_directory_iterator at(folder, ec), end; !ec && at != end; at.increment(ec)) {
    if (names.size() == most) break;
    if (at->is_regular_file(ec)) names.push_back(at->path().lexically_relative(folder).string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

bool lies_in(const fs::path& path, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first ==
         folder.end();
}

}  // namespace wellspring::gltf
