// SPDX-License-Identifier: Apache-2.0
// The records of the points of a LAS or LAZ file, byte for byte as a LAS file holds them.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "scan/las/las_header.h"

namespace wellspring::scan {

// Reads records from the first to the last. One thread at a time; chunks are decoded by all cores.
class LasRecords {
 public:
  virtual ~LasRecords() = default;
  // Returns the next records, at most so many, until the next call; empty: there are no more.
  // Throws LoadError if the file is damaged from here on.
  virtual std::span<const uint8_t> read(size_t most) = 0;
};

// A LAS or LAZ file that is taken apart.
class LasFile {
 public:
  // Throws LoadError if points cannot be read.
  explicit LasFile(const std::string& file);
  ~LasFile();
  LasFile(const LasFile&) = delete;
  LasFile& operator=(const LasFile&) = delete;

  // Says in its notices what was odd.
  const LasHeader& header() const { return header_; }
  LasRecords& records() { return *records_; }

 private:
  struct Bytes;
  std::unique_ptr<Bytes> bytes_;
  LasHeader header_;
  std::unique_ptr<LasRecords> records_;
};

}  // namespace wellspring::scan
