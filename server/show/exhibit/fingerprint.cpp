// SPDX-License-Identifier: Apache-2.0
#include "show/exhibit/fingerprint.h"

#include <algorithm>
#include <filesystem>
#include <vector>

#include "base/rng.h"

namespace wellspring {
namespace {

namespace fs = std::filesystem;

std::string describe(const fs::path& path, const std::string& name) {
  std::error_code none;
  auto size = fs::file_size(path, none);
  auto time = fs::last_write_time(path, none).time_since_epoch().count();
  return name + " " + std::to_string(size) + " " + std::to_string(time) + "\n";
}

}  // namespace

uint64_t exhibit_fingerprint(const std::string& folder) {
  std::error_code none;
  std::vector<std::string> lines = {describe(fs::read_symlink("/proc/self/exe", none), "")};
  fs::recursive_directory_iterator file(folder, none), end;
  for (; !none && file != end; file.increment(none))
    if (file->is_regular_file(none))
      lines.push_back(describe(file->path(), file->path().lexically_relative(folder).string()));
  std::sort(lines.begin(), lines.end());
  uint64_t sum = lines.size();
  for (const std::string& line : lines)
    for (char c : line) sum = mix64(sum ^ uint8_t(c));
  return sum;
}

}  // namespace wellspring
