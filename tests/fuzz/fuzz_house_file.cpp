// SPDX-License-Identifier: Apache-2.0
// The hours and kiosks of a house.
#include "fuzz/fuzz.h"
#include "show/house/house.h"
#include "unit/show/tiny_exhibit.h"

namespace wellspring::fuzz {

void fuzz_house_file(Bytes bytes) {
  static const Exhibit tiny = make_tiny_exhibit();
  Exhibit exhibit = tiny;
  std::vector<Problem> problems;
  const HouseSettings house = read_house(write_file("fuzz.json", bytes), exhibit, problems);
  for (int minute : {0, 9 * 60, 24 * 60 - 1}) house_at(house, {20'000, minute});
}

}  // namespace wellspring::fuzz
