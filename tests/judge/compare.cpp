// SPDX-License-Identifier: Apache-2.0
#include "judge/compare.h"

#include <cmath>
#include <stdexcept>

namespace wellspring::test {
namespace {

void check_sizes(const Frame& test, const Frame& reference) {
  if (test.width != reference.width || test.height != reference.height ||
      test.color.size() != reference.color.size() || test.color.empty())
    throw std::invalid_argument("compare: pictures differ in size or are empty");
}

}  // namespace

double rmse(const Frame& test, const Frame& reference) {
  check_sizes(test, reference);
  double sum = 0;
  for (size_t i = 0; i < test.color.size(); i++) {
    dvec3 d = dvec3(test.color[i]) - dvec3(reference.color[i]);
    sum += dot(d, d);
  }
  return std::sqrt(sum / (3.0 * double(test.color.size())));
}

double relative_mse(const Frame& test, const Frame& reference) {
  check_sizes(test, reference);
  double sum = 0;
  for (size_t i = 0; i < test.color.size(); i++) {
    dvec3 d = dvec3(test.color[i]) - dvec3(reference.color[i]);
    double y = luminance(reference.color[i]);
    sum += dot(d, d) / 3.0 / (y * y + 0.01);
  }
  return sum / double(test.color.size());
}

}  // namespace wellspring::test
