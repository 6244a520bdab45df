// SPDX-License-Identifier: Apache-2.0
// Figures in glTF and VRM.
#include "avatar/load/gltf_figure.h"
#include "fuzz/shown_figure.h"

namespace wellspring::fuzz {

void fuzz_gltf_figure(Bytes bytes) {
  const std::string file = write_file("fuzz.glb", bytes);
  load([&] { show_figure(character_from_gltf(file)); });
}

}  // namespace wellspring::fuzz
