// SPDX-License-Identifier: Apache-2.0
#include "show/watch/folder_watch.h"

#include <utility>

namespace wellspring::show {

namespace fs = std::filesystem;

FolderWatch::FolderWatch(std::string folder, double still)
    : folder_(std::move(folder)), still_(still), known_(look(folder_)), last_(known_) {}

FolderWatch::Files FolderWatch::look(const std::string& folder) {
  Files files;
  std::error_code error;  // what goes while it is looked at is not there
  fs::recursive_directory_iterator at(folder, error), end;
  while (!error && at != end) {
    const std::string name = at->path().filename().string();
    const bool hidden = name.starts_with('.'), folder_itself = at->is_directory(error);
    if (hidden && folder_itself) at.disable_recursion_pending();
    if (!hidden && !folder_itself && !name.ends_with('~')) {
      const auto time = at->last_write_time(error);
      const auto size = at->file_size(error);
      if (!error) files[at->path().string()] = {time, size};
    }
    error.clear();
    at.increment(error);
  }
  return files;
}

bool FolderWatch::changed(double now) {
  Files files = look(folder_);
  if (files != last_) {
    last_ = std::move(files);
    moved_at_ = now;
  }
  if (last_ == known_ || now - moved_at_ < still_) return false;
  known_ = last_;
  return true;
}

bool FolderWatch::changed() {
  last_ = look(folder_);
  return std::exchange(known_, last_) != last_;
}

}  // namespace wellspring::show
