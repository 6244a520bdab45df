// SPDX-License-Identifier: Apache-2.0
#include "spectrum/lamps.h"

#include <charconv>
#include <cmath>

#include "spectrum/tables.h"

namespace wellspring::spectrum {
namespace {

constexpr double middle_nm = 560;
constexpr double planck_c2 = 1.4388e-2;         // metre kelvin, as CIE 15 rounds it
constexpr double old_to_new = 1.4388 / 1.4380;  // D65 was named when this constant was smaller

// Returns the power of a blackbody, of a second constant c2 in nanometre kelvin.
double planck(double nm, double kelvin, double c2) {
  return std::pow(middle_nm / nm, 5) * std::expm1(c2 / (kelvin * middle_nm)) /
         std::expm1(c2 / (kelvin * nm));
}

Spectrum planck_spectrum(double kelvin, double c2) {
  Spectrum power;
  for (size_t i = 0; i < spectrum_size; i++) power[i] = planck(nm_of(i), kelvin, c2);
  return power;
}

double round_to_thousandths(double x) { return std::round(x * 1000) / 1000; }

struct NamedTemperature {
  const char *name, *about;
  double kelvin;
};
constexpr NamedTemperature glowing[] = {
    {"candle", "candle, blackbody of 1930 K", 1930},
    {"bulb-1900", "carbon filament of 1900, blackbody of 2100 K", 2100},
    {"halogen", "halogen bulb, blackbody of 3000 K", 3000},
};
constexpr NamedTemperature days[] = {
    {"D50", "CIE D50, daylight at the horizon", 5000 * old_to_new},
    {"D55", "CIE D55, daylight of the forenoon", 5500 * old_to_new},
    {"D65", "CIE D65, mean daylight at noon", 6500 * old_to_new},
    {"D75", "CIE D75, light of the northern sky", 7500 * old_to_new},
    {"north-light", "light of the northern sky, CIE D75", 7500 * old_to_new},
};

struct NamedLines {
  const char *name, *about, *lines;
};
constexpr NamedLines discharges[] = {
    {"sodium", "sodium at low pressure: the lines D1 and D2", "588.995*2+589.592"},
};

// Reads "589.0*2+589.6".
std::optional<Spectrum> read_lines(const std::string& text) {
  Spectrum power = even_spectrum(0);
  const char *at = text.data(), *end = at + text.size();
  while (true) {
    double nm = 0, amount = 1;
    auto read = std::from_chars(at, end, nm);
    if (read.ec != std::errc()) return {};
    if (read.ptr < end && *read.ptr == '*') {
      read = std::from_chars(read.ptr + 1, end, amount);
      if (read.ec != std::errc()) return {};
    }
    if (!(nm >= 380 && nm <= 780 && amount > 0 && amount <= 1e9)) return {};
    add_line(nm, amount, power);
    if (read.ptr == end) return power;
    if (*read.ptr != '+') return {};
    at = read.ptr + 1;
  }
}

// Reads the kelvins of "2856K".
std::optional<double> read_kelvin(std::string_view text) {
  double kelvin = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), kelvin);
  const bool is_kelvin =
      error == std::errc() && std::string_view(end, text.data() + text.size()) == "K";
  return is_kelvin ? std::optional(kelvin) : std::nullopt;
}

const StandardTables& illuminants() {
  static const StandardTables made = read_standard(illuminant_csv());
  return made;
}

std::string kind_of(const std::string& name) {
  if (name.starts_with("FL")) return "fluorescent lamp";
  if (name == "HP1" || name == "HP2") return "sodium lamp of high pressure";
  if (name.starts_with("HP")) return "metal halide lamp";
  return "lamp of light-emitting diodes";
}

}  // namespace

Spectrum blackbody(double kelvin) { return planck_spectrum(kelvin, planck_c2 * 1e9); }

Spectrum daylight(double kelvin) {
  static const StandardTables components = read_standard(daylight_csv());
  static const Spectrum s0 = resample(components[0].second), s1 = resample(components[1].second),
                        s2 = resample(components[2].second);
  const double t = 1000 / kelvin;
  const double x = kelvin <= 7000 ? 0.244063 + t * (0.09911 + t * (2.9678 - t * 4.6070))
                                  : 0.237040 + t * (0.24748 + t * (1.9018 - t * 2.0064));
  const double y = -3 * x * x + 2.87 * x - 0.275;
  const double m = 0.0241 + 0.2562 * x - 0.7341 * y;
  const double m1 = round_to_thousandths((-1.3515 - 1.7703 * x + 5.9114 * y) / m);
  const double m2 = round_to_thousandths((0.0300 - 31.4424 * x + 30.0717 * y) / m);
  Spectrum power;
  const size_t middle = size_t(middle_nm) - size_t(first_nm);
  const double scale = 1 / (s0[middle] + m1 * s1[middle] + m2 * s2[middle]);
  for (size_t i = 0; i < spectrum_size; i++) power[i] = scale * (s0[i] + m1 * s1[i] + m2 * s2[i]);
  return power;
}

std::optional<LampSpectrum> find_lamp(const std::string& name) {
  if (name == "E") return LampSpectrum{name, "equal power at all wavelengths", even_spectrum(1)};
  if (name == "A")  // its own constants: CIE 15:2018, 4.1.1
    return LampSpectrum{name, "CIE A, incandescent bulb of 2856 K", planck_spectrum(2848, 1.435e7)};
  for (const NamedTemperature& one : glowing)
    if (name == one.name) return LampSpectrum{name, one.about, blackbody(one.kelvin)};
  for (const NamedTemperature& one : days)
    if (name == one.name) return LampSpectrum{name, one.about, daylight(one.kelvin)};
  for (const NamedLines& one : discharges)
    if (name == one.name) return LampSpectrum{name, one.about, *read_lines(one.lines)};
  for (const auto& [own, table] : illuminants())
    if (name == own)
      return LampSpectrum{name, "CIE " + name + ", " + kind_of(name), resample(table)};
  if (const auto kelvin = read_kelvin(name); kelvin && *kelvin >= 1000 && *kelvin <= 25000)
    return LampSpectrum{name, "blackbody", blackbody(*kelvin)};
  if (name.starts_with("D"))
    if (const auto kelvin = read_kelvin(std::string_view(name).substr(1));
        kelvin && *kelvin >= 4000 && *kelvin <= 25000)
      return LampSpectrum{name, "daylight", daylight(*kelvin)};
  if (auto lines = read_lines(name)) return LampSpectrum{name, "spectral lines", *lines};
  return {};
}

std::vector<std::string> lamp_names() {
  std::vector<std::string> names{"E", "A"};
  for (const NamedTemperature& one : days) names.push_back(one.name);
  for (const NamedTemperature& one : glowing) names.push_back(one.name);
  for (const NamedLines& one : discharges) names.push_back(one.name);
  for (const auto& one : illuminants()) names.push_back(one.first);
  return names;
}

}  // namespace wellspring::spectrum
