// SPDX-License-Identifier: Apache-2.0
#include "base/keyed_file.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <mutex>

#include "base/load_error.h"
#include "base/log.h"
#include "base/rng.h"
#include "base/write_file.h"

namespace wellspring {
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
  if (head.format != format) {  // of another version, or of nobody
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
