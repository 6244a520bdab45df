// SPDX-License-Identifier: Apache-2.0
// The entry of libFuzzer, compiled once a target: WELLSPRING_FUZZ_TARGET is its function.
#include <cstdlib>

#include "base/log.h"
#include "fuzz/fuzz.h"

namespace wellspring::fuzz {
void WELLSPRING_FUZZ_TARGET(Bytes bytes);
}

// Warnings of readers would fill the disk.
extern "C" int LLVMFuzzerInitialize(int*, char***) {
  setenv("WELLSPRING_LOG", "off", 1);
  wellspring::log::start("fuzz");
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  wellspring::fuzz::WELLSPRING_FUZZ_TARGET({data, size});
  return 0;
}
