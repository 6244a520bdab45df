// SPDX-License-Identifier: Apache-2.0
// Writes files that others may read at any time.
#pragma once
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace wellspring {

// Writes the whole file or none of it: beside its place, then renamed over it. Pipes and devices
// are written to. Throws LoadError.
void write_file(const std::string& path, std::span<const char> bytes);
inline void write_file(const std::string& path, std::span<const uint8_t> bytes) {
  write_file(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

// Counts the files that killed programs had half written, in a folder and those below it.
// remove_unfinished() removes them, unless somebody writes them or has changed them within a
// minute.
struct Unfinished {
  size_t files = 0;
  uint64_t bytes = 0;
};
Unfinished remove_unfinished(const std::string& folder);

// Keeps values on disk from one start to the next: a file names its format and its key (from what
// it was made), and is read as a whole or not at all. Files are for one processor: numbers lie as
// in memory.

// Both take the same list of fields: PutBytes appends them, TakeBytes reads them.
struct PutBytes {
  std::string bytes;
  template <class T>
  void value(const T& v) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes.append(reinterpret_cast<const char*>(&v), sizeof v);
  }
  template <class T>
  void array(const std::vector<T>& v) {
    static_assert(std::is_trivially_copyable_v<T>);
    value(uint64_t(v.size()));
    bytes.append(reinterpret_cast<const char*>(v.data()), v.size() * sizeof(T));
  }
};
struct TakeBytes {
  static constexpr uint64_t most_items = 1 << 28;  // most items of one array
  const std::string& bytes;
  size_t at = 0;
  bool good = true;
  void copy(void* to, size_t size) {
    good = good && size <= bytes.size() - at;
    if (!good || size == 0) return;
    std::memcpy(to, bytes.data() + at, size);
    at += size;
  }
  template <class T>
  void value(T& v) {
    copy(&v, sizeof v);
  }
  template <class T>
  void array(std::vector<T>& v) {
    uint64_t count = 0;
    value(count);
    good = good && count <= most_items && count * sizeof(T) <= bytes.size() - at;
    if (!good) return;
    v.resize(size_t(count));
    copy(v.data(), v.size() * sizeof(T));
  }
  bool complete() const { return good && at == bytes.size(); }
};

// The result of reading a file.
enum class KeyedFile : uint8_t { read, missing, damaged, another_key };
inline constexpr uint64_t any_key = 0;
// Reads a file and never throws. Sets `bytes` if it was read. Names a damaged file in the log.
KeyedFile read_keyed(const std::string& file, uint64_t format, uint64_t key, std::string& bytes);
std::vector<std::string> damaged_files();  // those that this process has met since it began
// Replaces the file as a whole, and makes its folder. False: the file cannot be written.
bool write_keyed(const std::string& file, uint64_t format, uint64_t key, const std::string& bytes);

}  // namespace wellspring
