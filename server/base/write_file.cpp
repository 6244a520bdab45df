// SPDX-License-Identifier: Apache-2.0
#include "base/write_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <chrono>
#include <cstring>
#include <filesystem>

#include "base/load_error.h"

namespace wellspring {
namespace {

namespace fs = std::filesystem;

constexpr const char* mark = ".part";  // then the process and a number
constexpr auto just_begun = std::chrono::minutes(1);

bool is_unfinished(const std::string& name) {
  const size_t at = name.rfind(mark);
  if (at == name.npos || at == 0) return false;
  const std::string rest = name.substr(at + std::strlen(mark));
  const size_t dash = rest.find('-');
  const auto is_number = [](const std::string& text) {
    return !text.empty() && text.find_first_not_of("0123456789") == text.npos;
  };
  return dash != rest.npos && is_number(rest.substr(0, dash)) && is_number(rest.substr(dash + 1));
}

// Whoever writes a file holds a lock on it.
bool is_written(const fs::path& path) {
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return true;
  const bool is_free = flock(file, LOCK_EX | LOCK_NB) == 0;
  close(file);
  return !is_free;
}

}  // namespace

Unfinished remove_unfinished(const std::string& folder) {
  Unfinished removed;
  std::error_code ec;
  const auto now = fs::file_time_type::clock::now();
  for (fs::recursive_directory_iterator next(folder, ec), end; !ec && next != end;
       next.increment(ec)) {
    std::error_code none;
    const fs::path path = next->path();
    if (!is_unfinished(path.filename().string()) || !next->is_regular_file(none)) continue;
    const uint64_t bytes = next->file_size(none);
    if (now - next->last_write_time(none) < just_begun || is_written(path)) continue;
    if (!none && fs::remove(path, none)) removed.files++, removed.bytes += bytes;
  }
  return removed;
}

void write_file(const std::string& path, std::span<const char> bytes) {
  static std::atomic<unsigned> count{0};
  std::string temporary = path + mark + std::to_string(getpid()) + "-" + std::to_string(count++);
  FILE* file = std::fopen(temporary.c_str(), "wb");
  if (!file) throw LoadError(path, "", std::string("cannot be written: ") + std::strerror(errno));
  flock(fileno(file), LOCK_EX | LOCK_NB);  // see is_written()
  bool good = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
  int reason = errno;
  if (std::fclose(file) != 0 && good) good = false, reason = errno;
  if (good && std::rename(temporary.c_str(), path.c_str()) != 0) good = false, reason = errno;
  if (!good) {
    std::remove(temporary.c_str());
    throw LoadError(path, "", std::string("cannot be written: ") + std::strerror(reason));
  }
}

}  // namespace wellspring
