// SPDX-License-Identifier: Apache-2.0
#include "base/write_file.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <sys/file.h>
#include <unistd.h>

#include "base/load_error.h"
#include "base/log.h"
#include "base/rng.h"

namespace wellspring {
namespace {

namespace fs = std::filesystem;

constexpr const char* mark = ".part";  // followed by process id, '-' and a number
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

// Returns whether somebody writes the file: writers hold a lock on it.
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
  std::error_code none;
  const bool in_place = fs::is_other(path, none);
  const std::string temporary =
      in_place ? path : path + mark + std::to_string(getpid()) + "-" + std::to_string(count++);
  FILE* file = std::fopen(temporary.c_str(), "wb");
  if (!file) throw LoadError(path, "", std::string("cannot be written: ") + std::strerror(errno));
  if (!in_place) flock(fileno(file), LOCK_EX | LOCK_NB);  // see is_written()
  bool good = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
  int reason = errno;
  if (std::fclose(file) != 0 && good) good = false, reason = errno;
  if (!in_place && good && std::rename(temporary.c_str(), path.c_str()) != 0)
    good = false, reason = errno;
  if (good) return;
  if (!in_place) std::remove(temporary.c_str());
  throw LoadError(path, "", std::string("cannot be written: ") + std::strerror(reason));
}

namespace {

uint64_t checksum(const std::string& bytes) {
  uint64_t sum = bytes.size();
  for (size_t i = 0; i < bytes.size(); i += 8) {
    uint64_t word = 0;
    std::memcpy(&word, bytes.data() + i, std::min<size_t>(8, bytes.size() - i));
    sum = mix64(sum ^ word);
  }
  return sum;
}

struct Head {
  uint64_t format = 0, key = 0, checksum = 0;
};

std::mutex damaged_mutex;
std::vector<std::string> damaged;

KeyedFile note_damage(const std::string& file) {
  std::lock_guard lock(damaged_mutex);
  if (std::ranges::find(damaged, file) == damaged.end()) {
    log::warn("{}: is damaged; what it kept is computed anew", file);
    damaged.push_back(file);
  }
  return KeyedFile::damaged;
}

}  // namespace

KeyedFile read_keyed(const std::string& file, uint64_t format, uint64_t key, std::string& bytes) {
  std::error_code none;
  const auto size = std::filesystem::file_size(file, none);
  if (none) return KeyedFile::missing;
  std::ifstream in(file, std::ios::binary);
  Head head;
  if (!in || size < sizeof head || size > (uint64_t(1) << 34)) return note_damage(file);
  in.read(reinterpret_cast<char*>(&head), sizeof head);
  if (head.format != format) {  // the file is of another version, or of another program
    log::info("{}: is of another format; what it kept is computed anew", file);
    return KeyedFile::damaged;
  }
  if (key != any_key && head.key != key) return KeyedFile::another_key;
  std::string read(size_t(size) - sizeof head, '\0');
  if (!in.read(read.data(), std::streamsize(read.size())) || checksum(read) != head.checksum)
    return note_damage(file);
  bytes = std::move(read);
  return KeyedFile::read;
}

std::vector<std::string> damaged_files() {
  std::lock_guard lock(damaged_mutex);
  return damaged;
}

bool write_keyed(const std::string& file, uint64_t format, uint64_t key, const std::string& bytes) {
  const Head head{format, key, checksum(bytes)};
  std::string whole(reinterpret_cast<const char*>(&head), sizeof head);
  whole += bytes;
  std::error_code code;
  std::filesystem::create_directories(std::filesystem::path(file).parent_path(), code);
  try {
    write_file(file, whole);
  } catch (const LoadError&) {
    return false;
  }
  return true;
}

}  // namespace wellspring
