// SPDX-License-Identifier: Apache-2.0
#include "spectrum/read/spectra_file.h"

#include <algorithm>
#include <filesystem>
#include <map>

#include "base/load_error.h"
#include "base/read_file.h"
#include "spectrum/read/check_spectrum.h"

namespace wellspring::spectrum {
namespace {

constexpr size_t most_bytes = size_t(32) << 20;

// Spectra of one name are told apart by numbers.
void number_equal_names(std::vector<NamedSpectrum>& spectra) {
  std::map<std::string, int> seen;
  for (NamedSpectrum& one : spectra)
    if (const int count = ++seen[one.name]; count > 1)
      one.name += " (" + std::to_string(count) + ")";
}

}  // namespace

SpectraFile read_spectra_text(const std::string& file, std::string_view text,
                              const SpectraChoice& choice) {
  const std::string kind = std::filesystem::path(file).extension().string();
  const bool is_json = kind == ".json";
  if (!is_json && kind != ".csv" && kind != ".tsv" && kind != ".txt")
    throw LoadError(file, "", "is no .csv, .tsv, .txt or .json");
  RawSpectra raw = is_json ? read_raw_json(file, text) : read_raw_table(file, text);
  if (raw.all.empty()) throw LoadError(file, "", "there is no spectrum in this file");
  settle_units(file, choice, raw);
  SpectraFile read;
  for (const RawSpectrum& one : raw.all)
    if (auto good = check_spectrum(one, raw, choice.quantity, read.notes)) {
      if (good->source.empty()) good->source = std::filesystem::path(file).filename().string();
      read.spectra.push_back(std::move(*good));
    }
  if (read.spectra.empty()) throw LoadError(file, read.notes.back().where, read.notes.back().what);
  number_equal_names(read.spectra);
  return read;
}

SpectraFile read_spectra(const std::string& file, const SpectraChoice& choice) {
  return read_spectra_text(file, read_file(file, most_bytes, FileKind::regular_or_pipe), choice);
}

}  // namespace wellspring::spectrum
