// SPDX-License-Identifier: Apache-2.0
#include "base/layers.h"
#include "wire/prometheus.h"

#include <gtest/gtest.h>

namespace wellspring::test {
namespace {

TEST(Prometheus, AFamilyHasItsCommentsOnceAndItsKindByItsName) {
  std::string text;
  begin_metric(text, "doors", "Doors by kind");
  add_sample(text, "doors", {{"kind", "in"}}, 3);
  add_sample(text, "doors", {{"kind", "out"}, {"name", "a"}}, 2.5);
  add_metric(text, "visits_total", "Visits begun", uint64_t(12345678901));
  EXPECT_EQ(text,
            "# HELP wellspring_doors Doors by kind\n# TYPE wellspring_doors gauge\n"
            "wellspring_doors{kind=\"in\"} 3\nwellspring_doors{kind=\"out\",name=\"a\"} 2.5\n"
            "# HELP wellspring_visits_total Visits begun\n"
            "# TYPE wellspring_visits_total counter\nwellspring_visits_total 12345678901\n");
}

TEST(Prometheus, LabelsCannotEndTheirLine) {
  std::string text;
  add_sample(text, "x", {{"a", "\"} 1\n# \\"}, {"b", ""}}, true);
  EXPECT_EQ(text, "wellspring_x{a=\"'} 1'# '\"} 1\n");
  add_sample(text = {}, "x", {{"b", ""}}, false);
  EXPECT_EQ(text, "wellspring_x 0\n");
}

TEST(Prometheus, NumbersAreAsShortAsTheirTypeAllows) {
  EXPECT_EQ(MetricValue(0.1f).text, "0.1");
  EXPECT_EQ(MetricValue(0.1).text, "0.1");
  EXPECT_EQ(MetricValue(size_t(3)).text, "3");
  EXPECT_EQ(MetricValue(1e7).text, "10000000");
  EXPECT_EQ(MetricValue(-100000.0f).text, "-100000");
  EXPECT_EQ(MetricValue(1e300).text, "1e+300");
}

}  // namespace
}  // namespace wellspring::test
