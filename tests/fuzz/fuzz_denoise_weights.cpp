// SPDX-License-Identifier: Apache-2.0
// Weights of the learned reconstruction.
#include "denoise/weights.h"
#include "fuzz/fuzz.h"

namespace wellspring::fuzz {

void fuzz_denoise_weights(Bytes bytes) {
  load([&] {
    for (const auto& [name, tensor] : read_weights(std::as_bytes(bytes), "fuzz.tza"))
      require(tensor.values.size() * 2 <= bytes.size(), "a tensor is no larger than its file");
  });
}

}  // namespace wellspring::fuzz
