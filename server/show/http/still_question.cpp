// SPDX-License-Identifier: Apache-2.0
#include "show/http/still_question.h"

#include <charconv>
#include <cmath>
#include <optional>
#include <vector>

#include "wire/limits.h"

namespace wellspring::show {

namespace {

constexpr int max_still_side = 3840;
constexpr double min_still_seconds = 0.1, max_still_seconds = 3600;
constexpr double min_still_fov = 0.02, max_still_fov = 3;  // radians, vertical

// Reads fields until one is wrong; that one it names.
struct QueryReader {
  const std::map<std::string, std::string>& query;
  StillQuestion& asked;

  // Empty: not there, or wrong, or an earlier one was.
  std::string text(const char* name) const {
    auto found = query.find(name);
    return asked.status != 200 || found == query.end() ? "" : found->second;
  }
  void refuse(int status, const std::string& code, const std::string& problem) {
    asked.status = status, asked.code = code, asked.problem = problem;
  }
  void whole(const char* name, int low, int high, int& value) {
    const std::string read = text(name);
    if (read.empty()) return;
    int number = 0;
    auto [end, error] = std::from_chars(read.data(), read.data() + read.size(), number);
    if (error == std::errc() && end == read.data() + read.size() && number >= low && number <= high)
      value = number;
    else
      refuse(400, "bad_parameter",
             std::string(name) + ": must be a whole number from " + std::to_string(low) + " to " +
                 std::to_string(high));
  }
  // `count` numbers with commas between, each in [low, high]; none where the field is not there.
  std::vector<double> numbers(const char* name, size_t count, double low, double high) {
    const std::string read = text(name);
    if (read.empty()) return {};
    std::vector<double> values;
    const char *at = read.data(), *end = at + read.size();
    for (;;) {
      double value = 0;
      auto [next, error] = std::from_chars(at, end, value);
      if (error != std::errc() || !(value >= low && value <= high)) break;
      values.push_back(value);
      if (next == end && values.size() == count) return values;
      if (next == end || *next != ',') break;
      at = next + 1;
    }
    char range[64];
    std::snprintf(range, sizeof(range), " from %g to %g", low, high);
    const std::string what =
        count == 1 ? "a number" : std::to_string(count) + " numbers with commas between, each";
    refuse(400, "bad_parameter", std::string(name) + ": must be " + what + range);
    return {};
  }
  void number(const char* name, double low, double high, std::optional<float>& value) {
    const std::vector<double> read = numbers(name, 1, low, high);
    if (!read.empty()) value = float(read[0]);
  }
};

}  // namespace

StillQuestion read_still_question(const Exhibit& exhibit,
                                  const std::map<std::string, std::string>& query) {
  StillQuestion asked;
  StillJob& job = asked.job;
  QueryReader fields{query, asked};
  job.viewpoint = exhibit.start;
  if (const std::string name = fields.text("viewpoint"); !name.empty()) {
    job.viewpoint = find_viewpoint(exhibit, name);
    if (job.viewpoint < 0)
      fields.refuse(404, "unknown_viewpoint", "there is no viewpoint '" + name + "'");
  }
  fields.whole("width", 1, max_still_side, job.width);
  fields.whole("height", 1, max_still_side, job.height);
  fields.whole("spp", 1, max_still_spp, job.spp);
  if (const auto read = fields.numbers("seconds", 1, min_still_seconds, max_still_seconds);
      !read.empty())
    job.seconds = read[0];
  int denoise = 1;
  fields.whole("denoise", 0, 1, denoise);
  job.denoise = denoise == 1;
  const std::vector<double> position =
      fields.numbers("position", 3, -max_coordinate, max_coordinate);
  if (!position.empty()) job.position = dvec3(position[0], position[1], position[2]);
  fields.number("yaw", -max_angle, max_angle, job.yaw);
  fields.number("pitch", -max_angle, max_angle, job.pitch);
  fields.number("roll", -max_angle, max_angle, job.roll);
  fields.number("fov", min_still_fov, max_still_fov, job.fov);
  return asked;
}

}  // namespace wellspring::show
