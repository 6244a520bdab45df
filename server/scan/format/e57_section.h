// SPDX-License-Identifier: Apache-2.0
// Reads the points of one scan of an E57 file: a section of packets (ASTM E2807-11, section 9.3),
// each of which holds some bytes of every number's own stream.
#pragma once
#include <cstdint>
#include <vector>

#include "scan/format/e57_text.h"

namespace wellspring::scan {

class E57Section {
 public:
  // Reads the section's header. `is_wanted` says which streams are decoded. The pages and the scan
  // are borrowed. Throws LoadError, also for more points than the section has bytes for.
  E57Section(E57Pages& pages, const E57Scan& scan, const std::vector<bool>& is_wanted);
  // Decodes the next points of every wanted stream, at most so many; returns their number, 0 at the
  // end. `values` has a list for each stream. Throws LoadError.
  size_t read(size_t most, std::vector<std::vector<double>>& values);

 private:
  void read_packet();
  uint64_t available(size_t stream) const;  // whole numbers that were read
  void decode(size_t stream, size_t count, double* to);
  // The bytes of a stream that are read and not decoded yet.
  struct Pending {
    std::string bytes;
    uint64_t bit = 0;  // the next number begins there
    bool is_wanted = false;
  };
  E57Pages* pages_;
  const E57Scan* scan_;
  std::vector<Pending> pending_;
  std::string packet_;
  uint64_t next_ = 0, end_ = 0;  // logical places of the next packet, and of the section's end
  uint64_t left_ = 0;            // points that were not decoded yet
};

}  // namespace wellspring::scan
