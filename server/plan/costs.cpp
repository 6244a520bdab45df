// SPDX-License-Identifier: Apache-2.0
#include "plan/costs.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/load_error.h"
#include "base/read_file.h"

namespace wellspring::plan {

namespace {

using nlohmann::json;
constexpr size_t most_bytes = size_t(64) << 20;
const std::string prefix = "load.plan.cost.";

class Rows {
 public:
  Rows(const std::string& file, const json& results) : file_(file), results_(results) {}
  // Returns the one value of that name.
  double value(const std::string& name, double low, double high) const {
    const auto found = find(name, low, high);
    return found.back().second;
  }
  CostCurve curve(const std::string& name, double low, double high) const {
    std::vector<std::pair<double, double>> points;
    for (const auto& [row, cost] : find(name, low, high)) {
      const double width = side(row, "width"), height = side(row, "height");
      std::erase_if(points, [&](const auto& one) { return one.first == width * height; });
      points.emplace_back(width * height, cost);
    }
    return CostCurve(std::move(points));
  }

 private:
  std::vector<std::pair<size_t, double>> find(const std::string& name, double low,
                                              double high) const {
    std::vector<std::pair<size_t, double>> found;
    for (size_t i = 0; i < results_.size(); i++) {
      const json& one = results_[i];
      if (!one.is_object() || one.value("name", json()) != prefix + name) continue;
      found.emplace_back(i, number(i, "value", low, high));
    }
    if (found.empty())
      throw LoadError(file_, "/results",
                      "there is no row " + prefix + name +
                          "; ./wellspring bench --only load.plan --json FILE measures it");
    return found;
  }
  double side(size_t row, const char* name) const { return number(row, name, 1, 65536); }
  double number(size_t row, const char* name, double low, double high) const {
    const json& one = results_[row];
    const double value =
        one.contains(name) && one[name].is_number() ? one[name].get<double>() : std::nan("");
    if (!(value >= low && value <= high)) {
      char limits[80];
      std::snprintf(limits, sizeof limits, "has to be a number from %g to %g", low, high);
      throw LoadError(file_, "/results/" + std::to_string(row) + "/" + name, limits);
    }
    return value;
  }
  const std::string& file_;
  const json& results_;
};

}  // namespace

CostCurve::CostCurve(std::vector<std::pair<double, double>> points) : points_(std::move(points)) {
  std::ranges::sort(points_);
}

double CostCurve::at(double pixels) const {
  if (points_.empty()) return 0;
  if (points_.size() == 1) return points_[0].second;
  size_t to = 1;
  while (to + 1 < points_.size() && points_[to].first < pixels) to++;
  const auto [x0, y0] = points_[to - 1];
  const auto [x1, y1] = points_[to];
  return std::max(y0 + (y1 - y0) * (pixels - x0) / (x1 - x0), 0.0);
}

Costs load_costs(const std::string& file) {
  const std::string text = read_file(file, most_bytes, FileKind::regular_or_pipe);
  return read_costs(json::parse(text, nullptr, false), file);
}

Costs read_costs(const json& report, const std::string& file) {
  if (!report.is_object() || !report.contains("results") || !report["results"].is_array())
    throw LoadError(file, "", "is no report of ./wellspring bench --json");
  const Rows rows(file, report["results"]);
  constexpr double gigabyte = 1e9, terabyte = 1e12;
  auto in_seconds = [&](const char* name) { return rows.curve(name, 1e-9, 60); };
  Costs costs;
  costs.cores = rows.value("cores", 1, 4096);
  costs.draw = in_seconds("draw");
  costs.warp = in_seconds("warp");
  costs.encode_keyframe = in_seconds("encode_keyframe");
  costs.encode_picture = in_seconds("encode_picture");
  costs.keyframe_bytes = rows.curve("keyframe_bytes", 1, gigabyte);
  costs.picture_bytes = rows.curve("picture_bytes", 1, gigabyte);
  costs.visitor_memory = rows.curve("visitor_memory", 1, terabyte);
  costs.server_memory = rows.value("server_memory", 1, terabyte);
  costs.serial = rows.value("serial", 0, 1);
  costs.tick = rows.value("tick", 0, 60);
  costs.tick_visitor = rows.value("tick_visitor", 0, 60);
  costs.samples = rows.value("samples", 1, 1e12);
  costs.wide_rate = rows.value("wide_rate", 0, 1000);
  return costs;
}

}  // namespace wellspring::plan
