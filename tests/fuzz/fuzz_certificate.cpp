// SPDX-License-Identifier: Apache-2.0
// Certificates and their keys.
#include "fuzz/fuzz.h"
#include "stream/certificate.h"

namespace wellspring::fuzz {

// Both files in one, a NUL between them.
void fuzz_certificate(Bytes bytes) {
  const std::string chain = write_file("fuzz.crt", take_until(bytes, 0)),
                    key = write_file("fuzz.key", bytes);
  try {
    require(Certificate(chain, key).context() != nullptr, "what was read can be used");
  } catch (const std::runtime_error& error) {
    require(std::string(error.what()).find("fuzz.") != std::string::npos, "a refusal names a file");
  }
}

}  // namespace wellspring::fuzz
