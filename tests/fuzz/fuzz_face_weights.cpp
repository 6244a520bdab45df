// SPDX-License-Identifier: Apache-2.0
// Weights of the kiosk's networks: the list of tensors, NUL, their bytes.
#include "fuzz/fuzz.h"
#include "kiosk/network/weights.h"

namespace wellspring::fuzz {

void fuzz_face_weights(Bytes bytes) {
  write_file("fuzz-weights_manifest.json", take_until(bytes, 0));
  write_file("fuzz.bin", bytes);
  load([&] { load_weight_set(folder().path.string(), "fuzz"); });
}

}  // namespace wellspring::fuzz
