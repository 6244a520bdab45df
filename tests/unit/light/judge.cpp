// SPDX-License-Identifier: Apache-2.0
#include "unit/light/judge.h"

#include <boost/math/distributions/students_t.hpp>

namespace wellspring::test {

Verdict judge(const Comparison& c, size_t family_size) {
  Verdict v;
  if (c.expected == 0 && c.error == 0) {  // darkness is exact
    v.refuted = c.estimate.mean != 0;
    return v;
  }
  double alone = 1 - std::pow(1 - family_significance, 1.0 / double(family_size));
  boost::math::students_t_distribution<double> student(c.degrees);
  double error = std::hypot(c.error, rounding * std::abs(c.expected));
  v.limit = quantile(complement(student, alone / 2));
  v.t = (c.estimate.mean - c.expected) / error;
  v.refuted = !(std::abs(v.t) <= v.limit);  // NaN is refuted
  v.detectable = (v.limit + quantile(student, power_to_find_it)) * error / std::abs(c.expected);
  v.weak = !(v.detectable <= bias_to_find);
  return v;
}

void expect_family(const Family& family, double find) {
  ASSERT_FALSE(family.comparisons.empty());
  for (const Comparison& c : family.comparisons) {
    Verdict v = judge(c, family.comparisons.size());
    EXPECT_FALSE(v.refuted) << c.what << ": " << c.estimate.mean << " +- " << c.error
                            << ", expected " << c.expected << ", t = " << v.t << " beyond "
                            << v.limit;
    EXPECT_LE(v.detectable, find) << c.what << ": too noisy to find that bias";
  }
}

}  // namespace wellspring::test
