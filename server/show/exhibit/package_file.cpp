// SPDX-License-Identifier: Apache-2.0
#include "show/exhibit/package_file.h"

#include <algorithm>
#include <filesystem>

#include "base/near_name.h"

namespace wellspring {

namespace fs = std::filesystem;

namespace {

constexpr size_t most_files = 2000;  // of a package, that are looked through

// Their names as exhibit.json would give them, in alphabetical order.
std::vector<std::string> files_below(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code ec;
  for (fs::recursive_directory_iterator at(folder, ec), end; !ec && at != end; at.increment(ec)) {
    if (names.size() == most_files) break;
    if (at->is_regular_file(ec)) names.push_back(at->path().lexically_relative(folder).string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace

std::string package_file(Fields& fields, const char* field, const std::string& folder,
                         const std::string& name) {
  if (name.empty()) return "";
  fs::path relative(name);
  bool escapes = relative.is_absolute() || std::any_of(relative.begin(), relative.end(),
                                                       [](const fs::path& p) { return p == ".."; });
  if (escapes) {
    fields.problem(field, "'" + name + "' leaves the package's folder");
    return "";
  }
  std::error_code ec;
  fs::path path = fs::path(folder) / relative;
  fs::path real = fs::weakly_canonical(path, ec), root = fs::weakly_canonical(folder, ec);
  auto mismatch = std::mismatch(root.begin(), root.end(), real.begin(), real.end());
  if (ec || mismatch.first != root.end()) {
    fields.problem(field, "'" + name + "' leaves the package's folder");
    return "";
  }
  if (!fs::is_regular_file(path, ec)) {
    fields.problem(field, "there is no file '" + name + "' in the package" +
                              did_you_mean(name, files_below(root)));
    return "";
  }
  return path.string();
}

}  // namespace wellspring
