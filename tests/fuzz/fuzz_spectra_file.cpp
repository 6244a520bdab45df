// SPDX-License-Identifier: Apache-2.0
// Files of measured spectra. The first byte chooses the file's kind, and what it holds.
#include <cmath>

#include "fuzz/fuzz.h"
#include "spectrum/read/spectra_file.h"

namespace wellspring::fuzz {

void fuzz_spectra_file(Bytes bytes) {
  using namespace spectrum;
  if (bytes.empty()) return;
  const SpectraChoice choice{bytes[0] & 1 ? Quantity::power : Quantity::reflectance};
  load([&] {
    const SpectraFile read =
        read_spectra_text(bytes[0] & 2 ? "a.json" : "a.csv", text_of(bytes.subspan(1)), choice);
    require(!read.spectra.empty(), "a file that is accepted has a spectrum");
    for (const NamedSpectrum& one : read.spectra) {
      require(one.table.nm.size() == one.table.value.size() && one.table.nm.size() >= 3,
              "a table has values for its wavelengths");
      for (size_t i = 1; i < one.table.nm.size(); i++)
        require(one.table.nm[i] > one.table.nm[i - 1], "wavelengths rise");
      for (const double value : one.spectrum)
        require(value >= 0 && std::isfinite(value) &&
                    (choice.quantity == Quantity::power || value <= 1),
                "reflectances lie in 0 to 1, power is not negative");
    }
  });
}

}  // namespace wellspring::fuzz
