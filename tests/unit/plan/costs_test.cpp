// SPDX-License-Identifier: Apache-2.0
#include "plan/costs.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "base/load_error.h"

namespace wellspring::test {
namespace {

using nlohmann::json;

json row(const std::string& name, const json& value, int width = 0) {
  json one = {{"name", "load.plan.cost." + name}, {"value", value}};
  if (width > 0) one["width"] = width, one["height"] = width / 2;
  return one;
}

json whole_report() {
  json rows = json::array({{{"name", "cache.warp.ms"}, {"value", 3}},
                           row("cores", 4),
                           row("serial", 0.25),
                           row("tick", 1e-3),
                           row("tick_visitor", 1e-4),
                           row("samples", 1e5),
                           row("wide_rate", 0.8),
                           row("server_memory", 1e9)});
  for (const char* name : {"draw", "warp", "encode_keyframe", "encode_picture", "keyframe_bytes",
                           "picture_bytes", "visitor_memory"})
    for (const int width : {640, 320}) rows.push_back(row(name, width / 100.0, width));
  return {{"results", rows}};
}

std::string refusal(const json& report) {
  try {
    read_costs(report, "costs.json");
  } catch (const LoadError& error) {
    return error.what();
  }
  return "";
}

TEST(PlanCosts, RowsBecomeCosts) {
  const Costs costs = read_costs(whole_report(), "costs.json");
  EXPECT_EQ(costs.cores, 4);
  EXPECT_EQ(costs.serial, 0.25);
  EXPECT_DOUBLE_EQ(costs.draw.at(640 * 320), 6.4);
  EXPECT_DOUBLE_EQ(costs.draw.at(320 * 160), 3.2);
  EXPECT_DOUBLE_EQ(costs.draw.at((640 * 320 + 320 * 160) / 2), 4.8);
}

TEST(PlanCosts, TheLastOfARowCounts) {
  json report = whole_report();
  report["results"].push_back(row("samples", 7e4));
  report["results"].push_back(row("draw", 1, 320));
  const Costs costs = read_costs(report, "costs.json");
  EXPECT_EQ(costs.samples, 7e4);
  EXPECT_DOUBLE_EQ(costs.draw.at(320 * 160), 1);
}

TEST(PlanCosts, ALineGoesOnBeyondItsPointsButNotBelowZero) {
  const CostCurve curve({{200, 3}, {100, 1}});
  EXPECT_DOUBLE_EQ(curve.at(300), 5);
  EXPECT_DOUBLE_EQ(curve.at(10), 0);
  EXPECT_DOUBLE_EQ(CostCurve({{5, 2}}).at(1e9), 2);
  EXPECT_DOUBLE_EQ(CostCurve().at(4), 0);
}

TEST(PlanCosts, WhatIsMissingOrWrongIsNamed) {
  json report = whole_report();
  report["results"].erase(3);
  EXPECT_NE(refusal(report).find("costs.json: /results: there is no row load.plan.cost.tick;"),
            std::string::npos)
      << refusal(report);
  for (const json& bad : {json(-1), json("2"), json(), json(1e300)}) {
    report = whole_report();
    report["results"][5]["value"] = bad;
    EXPECT_NE(refusal(report).find("costs.json: /results/5/value: has to be a number from"),
              std::string::npos)
        << bad;
  }
  report = whole_report();
  report["results"].push_back(row("draw", 1));
  EXPECT_NE(refusal(report).find("/width"), std::string::npos);
  for (const json& bad : {json(), json(3), json::array(), json{{"results", 3}}, json::object()})
    EXPECT_NE(refusal(bad).find("is no report of ./wellspring bench --json"), std::string::npos);
  report = whole_report();
  report["results"].push_back(3);  // no row at all
  report["results"].push_back(json{{"name", 5}});
  EXPECT_EQ(refusal(report), "");
  EXPECT_THROW(load_costs("/nowhere/costs.json"), LoadError);
}

}  // namespace
}  // namespace wellspring::test
