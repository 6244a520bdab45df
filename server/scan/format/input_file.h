// SPDX-License-Identifier: Apache-2.0
// Reads a regular file of any size in order, through a buffer of bounded size.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/layers.h"

namespace wellspring::scan {

class InputFile {
 public:
  // Throws LoadError if it cannot be read, or is no regular file.
  explicit InputFile(const std::string& path);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  const std::string& path() const { return path_; }
  uint64_t size() const { return size_; }
  uint64_t place() const { return buffer_place_ + next_; }  // the next byte stands there
  uint64_t rest() const { return size_ - place(); }

  // Goes to a place, at most to the end.
  void go_to(uint64_t place);
  // Returns bytes from here on without passing them: at least so many unless the file ends. They
  // stay valid until the next call.
  std::string_view peek(size_t least);
  // Passes bytes that peek() showed.
  void pass(size_t count) { next_ += count; }
  // Returns the next bytes and passes them. Throws LoadError if the file ends before.
  std::string_view take(size_t count);
  void take_to(void* to, size_t count);

  [[noreturn]] void fail(const std::string& where, const std::string& what) const;

 private:
  size_t read_at(char* to, size_t count, uint64_t place) const;
  std::string path_;
  int descriptor_ = -1;
  uint64_t size_ = 0;
  std::vector<char> buffer_;
  uint64_t buffer_place_ = 0;  // the buffer's first byte stands there in the file
  size_t next_ = 0, end_ = 0;  // in the buffer
};

// Lines of a text file, with or without '\r'. A line longer than `longest_line` is refused.
class InputLines {
 public:
  static constexpr size_t longest_line = size_t(1) << 20;
  explicit InputLines(InputFile& file) : file_(&file) {}
  // Gives the next line, without its end; false: there are no more. It stays valid until the next
  // call.
  bool next(std::string_view& line);
  uint64_t number() const { return number_; }  // the line has this number, from 1
  std::string where() const { return "line " + std::to_string(number_); }
  void count_from(uint64_t number) { number_ = number; }

 private:
  InputFile* file_;
  uint64_t number_ = 0;
};

// A number of any type at a place in memory, in the machine's byte order or the other one.
template <class Value>
Value number_at(const char* from, bool is_swapped = false) {
  char bytes[sizeof(Value)];
  for (size_t i = 0; i < sizeof(Value); i++)
    bytes[i] = from[is_swapped ? sizeof(Value) - 1 - i : i];
  Value value;
  __builtin_memcpy(&value, bytes, sizeof value);
  return value;
}

}  // namespace wellspring::scan
