// SPDX-License-Identifier: Apache-2.0
// Curves on two logarithmic axes as a self-contained SVG picture, made to be read on paper and on
// screen: title, units, decades, one colour and one mark for each curve, its name at its end.
#pragma once
#include <string>
#include <utility>
#include <vector>

namespace wellspring::test {

struct Curve {
  std::string name;
  std::vector<std::pair<double, double>> points;  // drawn where both are finite and positive
};

struct Plot {
  std::string title, subtitle, x_label, y_label;
  std::vector<Curve> curves;
  // A line across at this y, with its name; 0: none.
  double level = 0;
  std::string level_name;
};

std::string make_svg(const Plot& plot);
// Throws std::runtime_error when the file cannot be written.
void save_svg(const std::string& file, const Plot& plot);

}  // namespace wellspring::test
