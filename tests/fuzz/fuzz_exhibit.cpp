// SPDX-License-Identifier: Apache-2.0
// exhibit.json, in a package whose other files are right (tests/fuzz/package).
#include "fuzz/fuzz.h"
#include "show/exhibit/load/exhibit_load.h"

namespace wellspring::fuzz {

void fuzz_exhibit(Bytes bytes) {
  static const std::string package = [] {
    std::filesystem::copy(WELLSPRING_SOURCE "/tests/fuzz/package", folder().path / "room");
    return folder().file("room");
  }();
  write_file("room/exhibit.json", bytes);
  std::vector<Problem> problems;
  read_exhibit(package, problems);
  for (const Problem& problem : problems) to_string(problem);
}

}  // namespace wellspring::fuzz
