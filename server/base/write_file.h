// SPDX-License-Identifier: Apache-2.0
// Files that others may read at any time.
#pragma once
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace wellspring {

// The whole file or none of it: written beside its place, then renamed over it. Throws LoadError.
void write_file(const std::string& path, std::span<const char> bytes);

// Files that killed programs had half written, in a folder and those below it. They are taken away,
// unless somebody writes them or has begun them within a minute; this says how much that was.
struct Unfinished {
  size_t files = 0;
  uint64_t bytes = 0;
};
Unfinished remove_unfinished(const std::string& folder);

// Values kept on disk from one start to the next: a file says of what format it is and what it was
// made of (its key), and is read as a whole or not at all. One processor's files: numbers lie as in
// memory.

// The same list of fields for both directions: PutBytes appends, TakeBytes reads.
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
  static constexpr uint64_t most_items = 1 << 28;  // of an array
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

// What became of reading a file.
enum class KeyedFile : uint8_t { read, missing, damaged, another_key };
inline constexpr uint64_t any_key = 0;
// Never throws. `bytes` is set where it was read. A damaged file is named in the log.
KeyedFile read_keyed(const std::string& file, uint64_t format, uint64_t key, std::string& bytes);
std::vector<std::string> damaged_files();  // that this process has met since it began
// Replaces the file as a whole, and makes its folder. False: it cannot be written.
bool write_keyed(const std::string& file, uint64_t format, uint64_t key, const std::string& bytes);

}  // namespace wellspring
