// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>

#include "base/load_error.h"
#include "spectrum/read/raw_spectra.h"
#include "spectrum/read/text_table.h"

namespace wellspring::spectrum {
namespace {

constexpr double largest_number = 1e12;

std::string lower(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
  return text;
}

bool has(const std::string& text, std::initializer_list<const char*> parts) {
  return std::ranges::any_of(
      parts, [&](const char* part) { return text.find(part) != std::string::npos; });
}

// Returns whether a word of the text, between all that is no letter, is one of these.
bool has_word(const std::string& text, std::initializer_list<std::string_view> words) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c & 0x80); };
  for (size_t i = 0; i < text.size();) {
    size_t end = i;
    while (end < text.size() && is_letter(text[end])) end++;
    if (std::ranges::find(words, std::string_view(text).substr(i, end - i)) != words.end())
      return true;
    i = std::max(end, i + 1);
  }
  return false;
}

bool names_wavelength(const std::string& name) {
  const std::string text = lower(name);
  return has(text, {"wavelength", "lambda", "wellen", "longueur", "\xce\xbb"}) ||
         has_word(text, {"nm", "um", "wl"});
}

// Finds units in names: "wavelength_nm", "lambda (um)", "reflectance %".
void read_units(const std::string& wavelength, const std::string& value, RawSpectra& spectra) {
  const std::string of_wave = lower(wavelength), of_value = lower(value);
  if (has_word(of_wave, {"nm"}) || has(of_wave, {"nanomet"}))
    spectra.wavelengths = WavelengthUnit::nanometres;
  else if (has_word(of_wave, {"um", "\xc2\xb5m", "\xce\xbcm"}) || has(of_wave, {"micro"}))
    spectra.wavelengths = WavelengthUnit::micrometres;
  spectra.declared = wavelength;
  if (has(of_value, {"%", "percent", "per cent"})) spectra.values = ValueUnit::per_cent;
}

// Says which columns hold words rather than numbers.
std::vector<bool> columns_of_words(const TextTable& table) {
  std::vector<bool> are_words(table.rows.empty() ? 0 : table.rows[0].cells.size(), false);
  double number = 0;
  for (size_t i = 0; i < are_words.size(); i++)
    are_words[i] = std::ranges::all_of(table.rows, [&](const TextRow& row) {
      return read_cell(row.cells[i], number) == CellKind::word;
    });
  return are_words;
}

std::string name_of(const TextTable& table, size_t column) {
  return table.names.empty() || table.names[column].empty() ? "column " + std::to_string(column + 1)
                                                            : table.names[column];
}

double number_in(const std::string& file, const TextTable& table, const TextRow& row,
                 size_t column) {
  double number = NAN;
  switch (read_cell(row.cells[column], number)) {
    case CellKind::number:
      if (std::abs(number) <= largest_number) return number;
      break;
    case CellKind::missing: return NAN;
    case CellKind::word: break;
  }
  throw LoadError(file, "line " + std::to_string(row.line),
                  name_of(table, column) + ": '" + row.cells[column].substr(0, 40) +
                      "' is no number up to 1e12");
}

double wavelength_in(const std::string& file, const TextTable& table, const TextRow& row,
                     size_t column) {
  const double number = number_in(file, table, row, column);
  if (std::isnan(number))
    throw LoadError(file, "line " + std::to_string(row.line), "the wavelength is missing");
  return number;
}

// Rows of equal words are one spectrum.
void read_long(const std::string& file, const TextTable& table, const std::vector<bool>& are_words,
               size_t wave, size_t value, RawSpectra& spectra) {
  std::map<std::string, size_t> known;
  for (const TextRow& row : table.rows) {
    std::string name;
    for (size_t i = 0; i < row.cells.size(); i++)
      if (are_words[i]) name += (name.empty() ? "" : " ") + row.cells[i];
    const auto [at, is_new] = known.emplace(name, spectra.all.size());
    if (is_new) spectra.all.push_back({name, "", {}});
    if (known.size() > most_spectra)
      throw LoadError(file, "line " + std::to_string(row.line), "there are more than 4096 spectra");
    spectra.all[at->second].samples.push_back(
        {wavelength_in(file, table, row, wave), number_in(file, table, row, value), row.line});
  }
}

void read_wide(const std::string& file, const TextTable& table, size_t wave, RawSpectra& spectra) {
  const size_t columns = table.rows[0].cells.size();
  for (size_t i = 0; i < columns; i++)
    if (i != wave) spectra.all.push_back({name_of(table, i), "", {}});
  for (const TextRow& row : table.rows) {
    const double wavelength = wavelength_in(file, table, row, wave);
    size_t to = 0;
    for (size_t i = 0; i < columns; i++)
      if (i != wave)
        spectra.all[to++].samples.push_back({wavelength, number_in(file, table, row, i), row.line});
  }
}

}  // namespace

RawSpectra read_raw_table(const std::string& file, std::string_view text) {
  const TextTable table = read_text_table(file, text);
  if (table.rows.empty()) throw LoadError(file, "", "there are no numbers in this table");
  const std::vector<bool> are_words = columns_of_words(table);
  const size_t columns = are_words.size();
  size_t wave = columns;
  for (size_t i = 0; i < columns && wave == columns; i++)
    if (!are_words[i] && !table.names.empty() && names_wavelength(table.names[i])) wave = i;
  for (size_t i = 0; i < columns && wave == columns; i++)
    if (!are_words[i]) wave = i;
  size_t values = 0, value = columns;
  for (size_t i = 0; i < columns; i++)
    if (!are_words[i] && i != wave) values++, value = i;
  if (wave == columns || values == 0)
    throw LoadError(file, "line " + std::to_string(table.rows[0].line),
                    "there is no column of wavelengths with one of values beside it");
  RawSpectra spectra;
  read_units(name_of(table, wave), name_of(table, value), spectra);
  const bool is_long = std::ranges::count(are_words, true) > 0;
  if (is_long && values > 1)
    throw LoadError(file, "line " + std::to_string(table.rows[0].line),
                    "words stand beside " + std::to_string(values) + " columns of values, not one");
  if (is_long) read_long(file, table, are_words, wave, value, spectra);
  else read_wide(file, table, wave, spectra);
  return spectra;
}

}  // namespace wellspring::spectrum
