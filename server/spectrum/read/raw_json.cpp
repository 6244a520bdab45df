// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "base/load_error.h"
#include "json/fields.h"
#include "spectrum/read/raw_spectra.h"

namespace wellspring::spectrum {
namespace {

constexpr size_t most_samples = 100'000;
constexpr double largest = 1e12;

// Reads a list of numbers; null is a value that is missing.
std::vector<double> read_numbers(const JsonValue& list) {
  std::vector<double> numbers;
  for (const JsonValue& one : list.list(1, most_samples, "numbers")) {
    double number = NAN;
    if (!one.value().is_null()) one.number(-largest, largest, number);
    numbers.push_back(number);
  }
  return numbers;
}

std::vector<double> take_numbers(FieldReader& fields, const char* name) {
  const auto list = fields.take(name, Need::required);
  return list ? read_numbers(*list) : std::vector<double>{};
}

void add_spectrum(FieldReader& fields, std::string name, std::string source,
                  const std::vector<double>& nm, const std::vector<double>& values,
                  RawSpectra& spectra) {
  if (nm.size() != values.size()) {
    fields.fail("there are " + std::to_string(values.size()) + " values for " +
                std::to_string(nm.size()) + " wavelengths");
    return;
  }
  RawSpectrum one{std::move(name), std::move(source), {}};
  for (size_t i = 0; i < nm.size(); i++) one.samples.push_back({nm[i], values[i], 0});
  spectra.all.push_back(std::move(one));
}

// Reads {"spectra": [{"name", "nm", "values", "unit", "source"}]}.
void read_named(const JsonValue& value, RawSpectra& spectra) {
  FieldReader file(value);
  file.choice("unit", {"", "fraction", "percent"}, spectra.values,
              "what values count in; without it found by their size");
  spectra.declared = "unit";
  std::string source;
  file.text("source", source, "who measured these, and where they are from", Need::optional, 2000);
  file.parts(
      "spectra", most_spectra, "the spectra",
      [&](FieldReader& fields) {
        std::string name, own;
        fields.text("name", name, "its name", Need::required);
        fields.text("source", own, "who measured it", Need::optional, 2000);
        const std::vector<double> nm = take_numbers(fields, "nm"),
                                  values = take_numbers(fields, "values");
        add_spectrum(fields, name, own.empty() ? source : own, nm, values, spectra);
      },
      Need::required);
  file.finish();
}

// Reads a list in which one entry has the wavelengths of all others.
void read_list(const JsonValue& value, RawSpectra& spectra) {
  std::vector<double> nm;
  for (const JsonValue& one : value.list(1, most_spectra, "spectra")) {
    FieldReader fields(one);
    std::string type, name;
    fields.text("type", type);
    if (type == "wavelengths") {
      nm = take_numbers(fields, "values");
      continue;
    }
    fields.text("name", name, "", Need::required);
    const std::vector<double> values = take_numbers(fields, "reflectance");
    if (nm.empty()) fields.fail("no wavelengths stand before this spectrum");
    else add_spectrum(fields, name, "", nm, values, spectra);
  }
}

}  // namespace

RawSpectra read_raw_json(const std::string& file, std::string_view text) {
  const nlohmann::json parsed = parse_json_file(file, text);
  Faults faults(file, false, text);
  const JsonValue value(parsed, faults);
  RawSpectra spectra;
  if (parsed.is_array()) read_list(value, spectra);
  else read_named(value, spectra);
  return spectra;
}

}  // namespace wellspring::spectrum
