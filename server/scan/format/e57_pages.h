// SPDX-License-Identifier: Apache-2.0
// Reads the pages of E57 files (ASTM E2807-11, section 7): 1,024 bytes each, of which the last four
// are a CRC-32C of the others. Every page that is read is verified.
#pragma once
#include <cstdint>
#include <string>

#include "scan/format/input_file.h"

namespace wellspring::scan {

// Returns the CRC-32C (Castagnoli, RFC 3720 appendix B.4) of bytes.
uint32_t crc_32c(const char* bytes, size_t count);

// The bytes of a file without its checksums. Places of `read` count those alone ("logical"), places
// in the file's header and text count all ("physical").
class E57Pages {
 public:
  // Throws LoadError if the file's size is not of whole pages.
  explicit E57Pages(const std::string& path);
  const InputFile& file() const { return file_; }
  uint64_t size() const { return file_.size() / page * content; }
  // Returns the logical place; throws LoadError if it is beyond the file, or within a checksum.
  uint64_t to_logical(uint64_t physical) const;
  // Reads bytes. Throws LoadError if they lie beyond the end, or a page is damaged.
  void read(uint64_t logical, char* to, uint64_t count);

  static constexpr uint64_t page = 1024, content = 1020;

 private:
  InputFile file_;
  uint64_t held_ = UINT64_MAX;  // number of the page in `bytes_`
  char bytes_[page];
};

}  // namespace wellspring::scan
