// SPDX-License-Identifier: Apache-2.0
// Speed against error out of a report of the benchmark; and files that are none.
#include "show/status/status.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/layers.h"
#include "unit/folder.h"

namespace wellspring::test {
namespace {

using nlohmann::json;

json read(const std::string& file) { return json::parse(read_speeds(file)); }

TEST(Speeds, ArePointsOfTheReportOfErrorOverTime) {
  test::Folder folder;
  auto result = [](const char* report, const char* name, double value) {
    return json{{"report", report},    {"name", name}, {"value", value},      {"scene", "castle"},
                {"technique", "path"}, {"spp", 4},     {"cpu_seconds", 0.75}, {"seconds", 0.4}};
  };
  const json report = {{"run", {{"date", "2026-11-01"}, {"commit", "abc"}}},
                       {"machine", {{"cpu", "A processor"}, {"cores", 2}}},
                       {"results",
                        {result("light.error", "light.path.flip", 0.25),
                         result("light.error", "light.path.rmse", 0.5),
                         result("cache.warp", "cache.warp.flip", 0.1)}}};
  const json speeds = read(folder.write("last.json", report.dump()));
  EXPECT_EQ(speeds["date"], "2026-11-01");
  EXPECT_EQ(speeds["cores"], 2);
  EXPECT_EQ(speeds["points"], json::array({{{"technique", "path"},
                                            {"scene", "castle"},
                                            {"spp", 4},
                                            {"seconds", 0.75},
                                            {"flip", 0.25}}}));
}

TEST(Speeds, SayWhyThereAreNone) {
  test::Folder folder;
  auto problem = [&](const std::string& file) { return read(file).value("problem", ""); };
  EXPECT_NE(problem("").find("--bench"), std::string::npos);
  EXPECT_NE(problem(folder.file("none.json")).find("wellspring bench"), std::string::npos);
  int number = 0;
  for (const char* wrong : {"{", "[]", R"({"results":3})", R"({"results":[3]})",
                            R"({"results":[{"report":"light.error","name":7}]})"}) {
    const std::string file = folder.write(std::to_string(number++), wrong);
    EXPECT_NE(problem(file).find(file), std::string::npos) << wrong;
  }
}

}  // namespace
}  // namespace wellspring::test
