// SPDX-License-Identifier: Apache-2.0
// Whether files of a folder have changed, by their sizes and times. Who saves a file writes it in
// pieces, so a change is told when all have been still for a moment.
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <utility>

namespace wellspring::show {

class FolderWatch {
 public:
  // As the files are now is how they are known.
  explicit FolderWatch(std::string folder, double still = 0.5);

  // At `now`, seconds. True once for each change, when the files have been still since `still`
  // seconds; not for one that is taken back before.
  bool changed(double now);
  // Whether they are now other than they were known, without waiting: somebody says that they are
  // complete.
  bool changed();

 private:
  // Of all files below the folder but hidden ones and editors' copies (~).
  using Files = std::map<std::string, std::pair<std::filesystem::file_time_type, std::uintmax_t>>;
  static Files look(const std::string& folder);

  std::string folder_;
  double still_, moved_at_ = 0;
  Files known_, last_;
};

}  // namespace wellspring::show
