// SPDX-License-Identifier: Apache-2.0
// What fuzz targets share. A target is a function fuzz_NAME(Bytes) that gives any bytes to a reader
// of foreign bytes and returns; what it lets through (an exception that is no answer, a broken
// rule, a sanitizer's report) is a find.
#pragma once
#include <cstdint>
#include <fstream>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "base/load_error.h"
#include "unit/folder.h"

namespace wellspring::fuzz {

using Bytes = std::span<const uint8_t>;

inline std::string text_of(Bytes bytes) { return {bytes.begin(), bytes.end()}; }

// The bytes up to the next `end`, which are taken off; all where there is none.
inline Bytes take_until(Bytes& bytes, uint8_t end) {
  size_t size = 0;
  while (size < bytes.size() && bytes[size] != end) size++;
  const Bytes taken = bytes.first(size);
  bytes = bytes.subspan(size < bytes.size() ? size + 1 : size);
  return taken;
}

// Checks a rule that a reader keeps for everything that it accepts.
inline void require(bool holds, const char* rule) {
  if (!holds) throw std::logic_error(rule);
}

// Runs a reader; a LoadError that says what is wrong is an answer, too.
template <class Read>
void load(const Read& read) {
  try {
    read();
  } catch (const LoadError& error) {
    require(!error.what_.empty(), "an error says what is wrong");
  }
}

// A folder of this process, for readers that open files by themselves.
inline const test::Folder& folder() {
  static const test::Folder made;
  return made;
}
inline std::string write_file(const std::string& name, Bytes bytes) {
  std::ofstream out(folder().path / name, std::ios::binary);
  out.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
  out.close();
  return folder().file(name);
}

}  // namespace wellspring::fuzz
