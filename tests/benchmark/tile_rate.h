// SPDX-License-Identifier: Apache-2.0
// Asks a picture server for tiles at random places of the grid, on several connections at once, and
// runs iipimage beside us for comparison (Debian: iipimage-server, lighttpd).
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/child.h"
#include "large_picture_room.h"

namespace wellspring::test {

struct TileRate {
  double tiles_a_second = 0;
  std::vector<double> times;  // milliseconds from a question to all of its answer
  size_t refused = 0;         // answers that are no picture
};
// Asks for as many tiles of a LargePictureRoom's picture as come in so many seconds, each
// connection for the next when one is there. `picture`: its address before the region (IIIF Image
// API). Throws std::runtime_error if nobody listens.
TileRate ask_for_tiles(uint16_t port, const std::string& picture, int connections, double seconds);

// Serves the pictures of a folder by iipimage, behind lighttpd, with a process for each core.
class IipServer {
 public:
  explicit IipServer(const std::string& folder);
  uint16_t port() const { return port_; }  // 0: a program is missing or does not answer
  std::string address(const std::string& file) const { return "/iip?IIIF=/" + file; }

 private:
  OwnFolder own_;
  uint16_t port_ = 0;
  std::vector<std::unique_ptr<Child>> workers_;
  std::optional<Child> front_;
};

}  // namespace wellspring::test
