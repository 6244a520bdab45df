// SPDX-License-Identifier: Apache-2.0
// Files that an import works on: on a disk, or of memory alone.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "base/layers.h"

namespace wellspring::scan {

// A file that is read and written at places; any thread. Copies share it. All throw LoadError.
class DataFile {
 public:
  DataFile() = default;
  // Opens a file, and makes it if it is not there.
  static DataFile open(const std::string& path);
  static DataFile open_to_read(const std::string& path);
  static DataFile in_memory(const std::string& name);

  void write_at(uint64_t to, const void* from, size_t count) const;
  void read_at(uint64_t from, void* to, size_t count) const;
  uint64_t size() const;
  void cut(uint64_t size) const;  // no byte lies beyond afterwards
  void sync() const;              // returns when the disk has it
  // Maps all of it to be read.
  std::shared_ptr<const std::byte> map() const;
  bool lock() const;  // false: another process holds its lock

 private:
  [[noreturn]] void fail(const char* what) const;
  std::string path_;
  std::shared_ptr<const int> descriptor_;
};

// Says where the files of an import lie: in a folder, or, if its name is empty, in memory.
class WorkPlace {
 public:
  explicit WorkPlace(std::string folder) : folder_(std::move(folder)) {}
  bool is_memory() const { return folder_.empty(); }
  std::string path(const std::string& name) const { return folder_ + "/" + name; }
  DataFile open(const std::string& name) const;
  void remove(const std::string& name) const;

 private:
  std::string folder_;
};

}  // namespace wellspring::scan
