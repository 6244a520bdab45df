// SPDX-License-Identifier: Apache-2.0
// What a kiosk has learned of the objects that visitors may hold.
#include "fuzz/fuzz.h"
#include "kiosk/station/station.h"
#include "kiosk/tree/tree_file.h"

namespace wellspring::fuzz {

void fuzz_station_tree(Bytes bytes) {
  const std::string file = write_file("fuzz.json", bytes);
  load([&] {
    RecognitionTree tree = load_tree(file);
    write_tree(tree);
    GrayFrame frame;
    frame.width = 64, frame.height = 48;
    frame.color_width = 32, frame.color_height = 24;
    frame.bgr.resize(3 * 32 * 24);
    for (int i = 0; i < 64 * 48; i++) frame.pixels.push_back(uint8_t(i * 37 ^ i / 64 * 91));
    try {
      kiosk::Station station(std::move(tree));
      for (int i = 0; i < 2; i++) station.look(frame);
    } catch (const std::invalid_argument&) {}  // it names a solver that there is not
  });
}

}  // namespace wellspring::fuzz
