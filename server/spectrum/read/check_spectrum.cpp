// SPDX-License-Identifier: Apache-2.0
#include "spectrum/read/check_spectrum.h"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>

#include "base/load_error.h"

namespace wellspring::spectrum {
namespace {

constexpr double seen_low = 380, seen_high = 780;  // nm: light that is seen
constexpr double core_low = 400, core_high = 700;  // nm: light that counts; instruments are good
constexpr double must_begin = 430,
                 must_end = 670;          // nm: a spectrum has to reach from here to there
constexpr double widest_gap = 50;         // nm that a straight line may bridge
constexpr double most_reflectance = 1.2;  // a white that was measured against a duller white
constexpr double largest_fraction = 3;    // the brightest of a typical spectrum, if not per cent
constexpr double noise_told = 0.02;

bool is_core(double nm) { return nm >= core_low && nm <= core_high; }

std::string line_of(int line) { return line > 0 ? fmt::format("line {}", line) : std::string(); }

struct Range {
  double low = INFINITY, high = -INFINITY;
  void add(double value) { low = std::min(low, value), high = std::max(high, value); }
  bool is_seen(double scale) const { return low * scale < seen_high && high * scale > seen_low; }
};

void settle_wavelengths(const std::string& file, WavelengthUnit chosen, RawSpectra& spectra) {
  Range range;
  int line = 0;
  for (const RawSpectrum& one : spectra.all)
    for (const RawSample& sample : one.samples)
      range.add(sample.wavelength), line = line == 0 ? sample.line : line;
  const bool are_nm = range.is_seen(1), are_um = range.is_seen(1000);
  if (!are_nm && !are_um)
    throw LoadError(
        file, line_of(line),
        fmt::format("wavelengths from {:g} to {:g} are neither nanometres nor "
                    "micrometres of light that is seen (\xc3\xa5ngstr\xc3\xb6ms? wave numbers?)",
                    range.low, range.high));
  WavelengthUnit& unit = spectra.wavelengths;
  const bool is_chosen = chosen != WavelengthUnit::detect;
  if (is_chosen) unit = chosen;
  const WavelengthUnit found = are_nm ? WavelengthUnit::nanometres : WavelengthUnit::micrometres;
  if (unit != WavelengthUnit::detect && unit != found)
    throw LoadError(
        file, line_of(line),
        fmt::format(
            "{} {}, but wavelengths from {:g} to {:g} are {}",
            is_chosen ? "the command line says" : fmt::format("'{}' says", spectra.declared),
            found == WavelengthUnit::nanometres ? "micrometres" : "nanometres", range.low,
            range.high, found == WavelengthUnit::nanometres ? "nanometres" : "micrometres"));
  unit = found;
}

// Returns the brightest value of a typical spectrum: the median, so that one that is wrong does
// not decide for all.
double typical_brightest(const RawSpectra& spectra) {
  const double scale = spectra.wavelengths == WavelengthUnit::micrometres ? 1000 : 1;
  std::vector<double> brightest;
  for (const RawSpectrum& one : spectra.all) {
    std::vector<double> values;
    for (const RawSample& sample : one.samples)
      if (is_core(sample.wavelength * scale) && std::isfinite(sample.value))
        values.push_back(sample.value);
    if (values.empty()) continue;
    const auto high = values.begin() + ptrdiff_t(values.size() * 19 / 20);
    std::ranges::nth_element(values, high);
    brightest.push_back(*high);
  }
  if (brightest.empty()) return 0;
  const auto middle = brightest.begin() + ptrdiff_t(brightest.size() / 2);
  std::ranges::nth_element(brightest, middle);
  return *middle;
}

void settle_values(const std::string& file, ValueUnit chosen, RawSpectra& spectra) {
  ValueUnit& unit = spectra.values;
  if (chosen != ValueUnit::detect) unit = chosen;
  const double brightest = typical_brightest(spectra);
  if (unit == ValueUnit::fractions && brightest > largest_fraction)
    throw LoadError(file, "",
                    fmt::format("reflectances are said to be fractions, but values of "
                                "{:g} are per cent",
                                brightest));
  if (unit == ValueUnit::detect)
    unit = brightest > largest_fraction ? ValueUnit::per_cent : ValueUnit::fractions;
}

// Collects what is found in one spectrum.
class Notes {
 public:
  Notes(const RawSpectrum& raw, std::vector<SpectraNote>& notes) : raw_(raw), notes_(notes) {}
  void tell(int line, const std::string& what) { add(line, what, false); }
  // Says why the spectrum is left out.
  std::nullopt_t leave_out(int line, const std::string& why) {
    return add(line, why, true), std::nullopt;
  }

 private:
  void add(int line, const std::string& what, bool is_left_out) {
    const std::string place = line_of(line);
    notes_.push_back({(place.empty() ? "" : place + ": ") + raw_.name, what, is_left_out});
  }
  const RawSpectrum& raw_;
  std::vector<SpectraNote>& notes_;
};

bool repeats_wavelengths(const RawSpectrum& raw) {
  return std::ranges::all_of(raw.samples,
                             [](const RawSample& s) { return s.wavelength == s.value; });
}

// Sorts samples, drops what is missing, and takes the mean of what was measured twice.
std::vector<RawSample> put_in_order(const RawSpectrum& raw, Notes& notes) {
  std::vector<RawSample> samples;
  int first_missing = 0;
  for (const RawSample& one : raw.samples)
    if (std::isfinite(one.value)) samples.push_back(one);
    else if (first_missing == 0) first_missing = one.line;
  if (samples.size() < raw.samples.size())
    notes.tell(first_missing,
               fmt::format("{} values are missing", raw.samples.size() - samples.size()));
  const auto shorter = [](const RawSample& a, const RawSample& b) {
    return a.wavelength < b.wavelength;
  };
  const auto longer = [&](const RawSample& a, const RawSample& b) { return shorter(b, a); };
  if (std::ranges::is_sorted(samples, longer)) std::ranges::reverse(samples);
  if (const auto out = std::ranges::is_sorted_until(samples, shorter); out != samples.end()) {
    notes.tell(out->line, "wavelengths are in no order; they were sorted");
    std::ranges::stable_sort(samples, shorter);
  }
  std::vector<RawSample> single;
  size_t equal = 1;  // samples at the last wavelength
  for (const RawSample& one : samples) {
    if (single.empty() || one.wavelength != single.back().wavelength) {
      single.push_back(one), equal = 1;
      continue;
    }
    if (one.value != single.back().value)
      notes.tell(one.line,
                 fmt::format("{:g} nm was measured twice; the mean is taken", one.wavelength));
    equal++;
    single.back().value += (one.value - single.back().value) / double(equal);
  }
  return single;
}

// Says whether the samples reach over the light that counts without a wide gap.
bool check_reach(const std::vector<RawSample>& samples, Notes& notes) {
  if (samples.size() < 3)
    return notes.leave_out(0, "there are fewer than three values; left out"), false;
  const double begin = samples.front().wavelength, end = samples.back().wavelength;
  if (begin > must_begin || end < must_end) {
    notes.leave_out(samples.front().line,
                    fmt::format("reaches from {:g} to {:g} nm only; left out", begin, end));
    return false;
  }
  if (begin > core_low || end < core_high)
    notes.tell(0,
               fmt::format("reaches from {:g} to {:g} nm only; beyond, the last values are taken",
                           begin, end));
  std::vector<double> steps;
  for (size_t i = 1; i < samples.size(); i++)
    steps.push_back(samples[i].wavelength - samples[i - 1].wavelength);
  std::vector<double> sorted = steps;
  std::ranges::nth_element(sorted, sorted.begin() + ptrdiff_t(sorted.size() / 2));
  const double told = std::max(10.0, 3 * sorted[sorted.size() / 2]);
  for (size_t i = 0; i < steps.size(); i++) {
    const double low = samples[i].wavelength, high = samples[i + 1].wavelength;
    if (steps[i] <= told || high < seen_low || low > seen_high) continue;
    const std::string gap = fmt::format("nothing was measured between {:g} and {:g} nm", low, high);
    if (steps[i] > widest_gap && high > core_low && low < core_high)
      return notes.leave_out(samples[i + 1].line, gap + "; left out"), false;
    notes.tell(samples[i + 1].line, gap + "; a straight line is taken");
  }
  return true;
}

// Returns how far single values are from the straight line through their neighbours, in the root of
// the mean square, freed of what the line itself adds.
double noise_of(const SpectrumTable& table) {
  double sum = 0;
  size_t count = 0;
  for (size_t i = 1; i + 1 < table.nm.size(); i++) {
    if (!is_core(table.nm[i]) || table.nm[i + 1] - table.nm[i - 1] > 5) continue;
    const double off = table.value[i] - 0.5 * (table.value[i - 1] + table.value[i + 1]);
    sum += off * off, count++;
  }
  return count < 20 ? 0 : std::sqrt(sum / double(count) / 1.5);
}

// Makes negative values 0, and names them where they are seen.
void raise_negatives(Spectrum& spectrum, Notes& notes) {
  Range where, value;
  for (size_t i = 0; i < spectrum_size; i++) {
    if (spectrum[i] >= 0) continue;
    if (nm_of(i) >= seen_low && nm_of(i) <= seen_high) where.add(nm_of(i)), value.add(spectrum[i]);
    spectrum[i] = 0;
  }
  if (where.low <= where.high)
    notes.tell(0, fmt::format("is below zero between {:g} and {:g} nm, down to {:.3g}; taken for 0",
                              where.low, where.high, value.low));
}

// Cuts reflectances to 1; false: there is more light than can be.
bool lower_excess(Spectrum& spectrum, Notes& notes) {
  double most = 1, at = 0;
  for (size_t i = 0; i < spectrum_size; i++)
    if (is_core(nm_of(i)) && spectrum[i] > most) most = spectrum[i], at = nm_of(i);
  if (most > most_reflectance) {
    notes.leave_out(0, fmt::format("sends back {:.2f} times the light that falls on it at {:g} nm: "
                                   "this is fluorescence (or another unit), which a reflectance "
                                   "cannot say; left out",
                                   most, at));
    return false;
  }
  if (most > 1)
    notes.tell(0, fmt::format("is {:.3f} at {:g} nm, more than all light; taken for 1", most, at));
  for (double& value : spectrum) value = std::min(value, 1.0);
  return true;
}

double core_sum(const Spectrum& spectrum) {
  double sum = 0;
  for (size_t i = 0; i < spectrum_size; i++)
    if (is_core(nm_of(i))) sum += spectrum[i];
  return sum;
}

}  // namespace

void settle_units(const std::string& file, const SpectraChoice& choice, RawSpectra& spectra) {
  settle_wavelengths(file, choice.wavelengths, spectra);
  if (choice.quantity == Quantity::reflectance) settle_values(file, choice.values, spectra);
}

std::optional<NamedSpectrum> check_spectrum(const RawSpectrum& raw, const RawSpectra& units,
                                            Quantity quantity, std::vector<SpectraNote>& into) {
  Notes notes(raw, into);
  if (repeats_wavelengths(raw)) return notes.leave_out(0, "repeats the wavelengths; left out");
  RawSpectrum scaled = raw;
  for (RawSample& one : scaled.samples) {
    if (units.wavelengths == WavelengthUnit::micrometres) one.wavelength *= 1000;
    if (quantity == Quantity::reflectance && units.values == ValueUnit::per_cent) one.value /= 100;
  }
  const std::vector<RawSample> samples = put_in_order(scaled, notes);
  if (!check_reach(samples, notes)) return {};
  NamedSpectrum made{raw.name, raw.source, {}, {}};
  for (const RawSample& one : samples)
    made.table.nm.push_back(one.wavelength), made.table.value.push_back(one.value);
  made.spectrum = resample(made.table);
  if (quantity == Quantity::reflectance)
    if (const double noise = noise_of(made.table); noise > noise_told)
      notes.tell(
          0,
          fmt::format("single values are noisy, by {:.3f}; each nanometre's mean is taken", noise));
  raise_negatives(made.spectrum, notes);
  if (quantity == Quantity::reflectance && !lower_excess(made.spectrum, notes)) return {};
  if (quantity == Quantity::power && !(core_sum(made.spectrum) > 0))
    return notes.leave_out(0, "has no light that is seen; left out");
  return made;
}

}  // namespace wellspring::spectrum
