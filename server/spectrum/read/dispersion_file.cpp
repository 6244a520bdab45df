// SPDX-License-Identifier: Apache-2.0
#include "spectrum/read/dispersion_file.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/core.h>
#include <sstream>
#include <yaml-cpp/yaml.h>

#include "base/load_error.h"
#include "base/read_file.h"

namespace wellspring::spectrum {
namespace {

constexpr size_t most_dispersion_bytes = 1 << 20, most_entries = 64, most_coefficients = 64;
constexpr double nm_of_um = 1000;

// Knows the file, to say where something is wrong.
class DispersionReader {
 public:
  explicit DispersionReader(const std::string& file) : file_(file) {}

  Dispersion read(const YAML::Node& root) {
    if (!root.IsMap()) fail(root, "this is no file of refractiveindex.info: there is no DATA");
    const YAML::Node data = root["DATA"];
    if (!data || !data.IsSequence()) fail(root, "there is no list DATA");
    if (data.size() > most_entries) fail(data, "DATA has more than 64 entries");
    made_.name = std::filesystem::path(file_).stem().string();
    made_.source = text_of(root["REFERENCES"]);
    for (const YAML::Node& entry : data) read_entry(entry);
    if (!has_index_) fail(data, "no entry of DATA has an index of refraction");
    return std::move(made_);
  }

 private:
  [[noreturn]] void fail(const YAML::Node& node, const std::string& what) const {
    const int line = node.IsDefined() ? node.Mark().line : -1;
    throw LoadError(file_, line < 0 ? "" : "line " + std::to_string(line + 1), what);
  }
  static std::string text_of(const YAML::Node& node) {
    return node.IsDefined() && node.IsScalar() ? node.Scalar() : std::string();
  }

  std::vector<double> numbers(const YAML::Node& node, std::string_view text) const {
    std::vector<double> all;
    std::istringstream words{std::string(text)};
    for (std::string word; words >> word;) {
      char* end = nullptr;
      const double number = std::strtod(word.c_str(), &end);
      if (*end != 0 || !std::isfinite(number))
        fail(node, "'" + word.substr(0, 40) + "' is no number");
      all.push_back(number);
    }
    return all;
  }

  void read_entry(const YAML::Node& entry) {
    if (!entry.IsMap()) fail(entry, "an entry of DATA has no fields");
    const std::string type = text_of(entry["type"]);
    if (type.starts_with("formula ")) read_formula(entry, type);
    else if (type == "tabulated n") read_table(entry, &made_.index, nullptr);
    else if (type == "tabulated k") read_table(entry, nullptr, &made_.extinction);
    else if (type == "tabulated nk") read_table(entry, &made_.index, &made_.extinction);
    else fail(entry, "'" + type.substr(0, 40) + "' is no known type of data");
  }

  void take_index(const YAML::Node& entry) {
    if (has_index_) fail(entry, "there is a second index of refraction");
    has_index_ = true;
  }

  void read_formula(const YAML::Node& entry, const std::string& type) {
    take_index(entry);
    const std::string number = type.substr(8);
    if (number.size() != 1 || number[0] < '1' || number[0] > '9')
      fail(entry, "there is no formula " + number.substr(0, 40));
    made_.formula = number[0] - '0';
    made_.coefficients = numbers(entry["coefficients"], text_of(entry["coefficients"]));
    if (made_.coefficients.empty() || made_.coefficients.size() > most_coefficients)
      fail(entry, "a formula has 1 to 64 coefficients");
    const char* field = entry["wavelength_range"] ? "wavelength_range" : "range";
    const std::vector<double> range = numbers(entry[field], text_of(entry[field]));
    if (range.size() != 2 || !(range[0] > 0 && range[1] > range[0]))
      fail(entry, "wavelength_range is not two wavelengths, the shorter one first");
    set_range(entry, range[0], range[1]);
  }

  void set_range(const YAML::Node& entry, double low_um, double high_um) {
    made_.low_nm = low_um * nm_of_um, made_.high_nm = high_um * nm_of_um;
    if (!(made_.low_nm < 780 && made_.high_nm > 380))
      fail(entry, "the index is known from " + std::to_string(int(made_.low_nm)) + " to " +
                      std::to_string(int(made_.high_nm)) + " nm only, none of which is seen");
  }

  static constexpr size_t most_notes = 20;
  void note(const std::string& what) {
    if (made_.notes.size() < most_notes) made_.notes.push_back(what);
  }

  struct Row {
    double um, index, extinction;
  };

  // Returns the lines of a table, whose wavelengths rise; lines that stand elsewhere are moved.
  std::vector<Row> read_rows(const YAML::Node& entry, bool has_index, bool has_extinction) {
    const size_t columns = has_index && has_extinction ? 3 : 2;
    const YAML::Node data = entry["data"];
    const std::vector<double> all = numbers(data, text_of(data));
    if (all.empty() || all.size() % columns != 0)
      fail(entry, "a table has lines of " + std::to_string(columns) + " numbers");
    std::vector<Row> rows;
    std::vector<double> negative;
    for (size_t i = 0; i < all.size(); i += columns) {
      Row row{all[i], has_index ? all[i + 1] : 0, has_extinction ? all[i + columns - 1] : 0};
      if (!(row.um > 0 && row.um < 1e6)) fail(entry, "a wavelength is 0, below it or too long");
      if (row.index < 0 || std::max(row.index, row.extinction) > 1e6)
        fail(entry, "an index is below 0, or a value too large");
      if (row.extinction < 0) negative.push_back(row.um), row.extinction = 0;
      if (!rows.empty() && row.um <= rows.back().um)
        note(fmt::format("the line of {:g} micrometres is out of order; it was moved", row.um));
      rows.push_back(row);
    }
    if (!negative.empty())
      note(fmt::format(
          "the extinction is below 0 at {} wavelengths from {:g} micrometres; taken for "
          "0",
          negative.size(), negative.front()));
    std::ranges::stable_sort(rows, {}, &Row::um);
    // The first of several lines for one wavelength is taken.
    const auto same = [](const Row& x, const Row& y) { return x.um == y.um; };
    rows.erase(std::unique(rows.begin(), rows.end(), same), rows.end());
    return rows;
  }

  // Reads lines of a wavelength and values: the index, the extinction or both.
  void read_table(const YAML::Node& entry, SpectrumTable* index, SpectrumTable* extinction) {
    if (index) take_index(entry);
    if (extinction && !extinction->nm.empty()) fail(entry, "there is a second extinction");
    const std::vector<Row> rows = read_rows(entry, index, extinction);
    for (const Row& row : rows) {
      if (index) index->nm.push_back(row.um * nm_of_um), index->value.push_back(row.index);
      if (extinction)
        extinction->nm.push_back(row.um * nm_of_um), extinction->value.push_back(row.extinction);
    }
    if (index) set_range(entry, rows.front().um, rows.back().um);
  }

  const std::string& file_;
  Dispersion made_;
  bool has_index_ = false;
};

}  // namespace

Dispersion read_dispersion_text(const std::string& file, const std::string& text) {
  try {
    return DispersionReader(file).read(YAML::Load(text));
  } catch (const YAML::Exception& error) {
    throw LoadError(file, error.mark.is_null() ? "" : "line " + std::to_string(error.mark.line + 1),
                    error.msg);
  }
}

Dispersion read_dispersion(const std::string& file) {
  return read_dispersion_text(file,
                              read_file(file, most_dispersion_bytes, FileKind::regular_or_pipe));
}

}  // namespace wellspring::spectrum
