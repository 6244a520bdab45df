// SPDX-License-Identifier: Apache-2.0
// Reads spectra that strangers have measured, of reflectances or of lamps: tables of text (.csv,
// .tsv, .txt) and JSON. Nothing that is wrong is passed over in silence: it is refused, or put
// right and named.
//
// A table has wavelengths in one column (named so, else the first), and in each other column a
// spectrum; or words in some columns, one column of wavelengths and one of values, so that rows of
// equal words are a spectrum. JSON is {"spectra": [{"name", "nm": [..], "values": [..],
// "source"}]}, or a list with {"type": "wavelengths", "values": [..]} and {"name", "reflectance":
// [..]}.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "spectrum/measured.h"

namespace wellspring::spectrum {

struct SpectraFile {
  std::vector<NamedSpectrum> spectra;
  std::vector<SpectraNote> notes;
};

// Throws LoadError if nothing in the file can be used.
SpectraFile read_spectra(const std::string& file, const SpectraChoice& choice = {});
// Reads the text of a file whose name says what kind it is.
SpectraFile read_spectra_text(const std::string& file, std::string_view text,
                              const SpectraChoice& choice = {});

}  // namespace wellspring::spectrum
