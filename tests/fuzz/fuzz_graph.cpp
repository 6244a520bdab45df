// SPDX-License-Identifier: Apache-2.0
// Graphs of networks: the graph, NUL, the bytes of its weights. Those that can be read become
// networks, which run once.
#include "fuzz/fuzz.h"
#include "kiosk/network/graph/graph_network.h"

namespace wellspring::fuzz {

void fuzz_graph(Bytes bytes) {
  const std::string file = write_file("net.json", take_until(bytes, 0));
  write_file("net.bin", bytes);
  load([&] { open_graph(file); });
}

}  // namespace wellspring::fuzz
