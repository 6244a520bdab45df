// SPDX-License-Identifier: Apache-2.0
// A text that claims to be sealed by this server.
#include "fuzz/fuzz.h"
#include "wire/tokens.h"

namespace wellspring::fuzz {

void fuzz_sealed(Bytes bytes) {
  static const Seal seal;
  require(!seal.open(text_of(bytes)), "nothing opens that was not closed");
  require(seal.open(seal.close(text_of(bytes))) == text_of(bytes), "what was closed opens");
}

}  // namespace wellspring::fuzz
