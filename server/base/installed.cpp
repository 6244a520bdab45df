// SPDX-License-Identifier: Apache-2.0
#include "base/installed.h"

#include <filesystem>

namespace wellspring {
namespace {

namespace fs = std::filesystem;

fs::path prefix() {
  std::error_code ec;
  const fs::path folder = fs::read_symlink("/proc/self/exe", ec).parent_path();
  fs::path found;
  if (folder.filename() == "bin") found = folder.parent_path();
  else if (folder.filename() == "wellspring" && folder.parent_path().filename() == "libexec")
    found = folder.parent_path().parent_path();
  return fs::is_directory(found / "share" / "wellspring", ec) ? found : fs::path();
}

}  // namespace

std::string installed_share(const std::string& name) {
  const fs::path root = prefix();
  std::error_code ec;
  const fs::path place = root / "share" / "wellspring" / name;
  return !root.empty() && fs::exists(place, ec) ? place.string() : "";
}

std::string installed_config(const std::string& name) {
  const fs::path root = prefix();
  if (root.empty()) return "";
  const fs::path above = root.filename() == "usr" ? root.parent_path() : root;
  return (above / "etc" / "wellspring" / name).string();
}

}  // namespace wellspring
