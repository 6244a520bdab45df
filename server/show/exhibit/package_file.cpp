// SPDX-License-Identifier: Apache-2.0
#include "show/exhibit/package_file.h"

#include <algorithm>
#include <filesystem>

#include "gltf/find_file.h"
#include "base/near_name.h"

namespace wellspring::show {

namespace fs = std::filesystem;

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
  const fs::path path = find_file(folder, relative).value_or(fs::path(folder) / relative);
  fs::path real = fs::weakly_canonical(path, ec), root = fs::weakly_canonical(folder, ec);
  if (ec || !lies_in(real, root)) {
    fields.problem(field, "'" + name + "' leaves the package's folder");
    return "";
  }
  if (!fs::is_regular_file(path, ec)) {
    fields.problem(field, "there is no file '" + name + "' in the package" +
                              did_you_mean(name, list_files(root)));
    return "";
  }
  return path.string();
}

}  // namespace wellspring::show
