// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>

#include "show/exhibit/pieces/piece_choices.h"
#include "show/http/still.h"
#include "show/lens/lens.h"
#include "wire/limits.h"

namespace wellspring::show {
namespace {

constexpr int max_still_side = 3840;
constexpr double min_still_seconds = 0.1, max_still_seconds = 3600;
constexpr double min_still_fov = 0.02, max_still_fov = 3;  // radians, vertical

// Returns `count` numbers with a character between, each in [low, high]; otherwise none.
std::vector<double> read_numbers(const std::string& text, char between, size_t count, double low,
                                 double high) {
  std::vector<double> values;
  const char *at = text.data(), *end = at + text.size();
  for (;;) {
    double value = 0;
    auto [next, error] = std::from_chars(at, end, value);
    if (error != std::errc() || !(value >= low && value <= high)) return {};
    values.push_back(value);
    if (next == end && values.size() == count) return values;
    if (next == end || *next != between) return {};
    at = next + 1;
  }
}

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
    std::vector<double> values = read_numbers(read, ',', count, low, high);
    if (!values.empty()) return values;
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

// Reads how a piece is seen out of "map", "1850" or "valley", "paint", "xray", "curtain", "0.5" or,
// of a volume, "falcon", "inside", "", "", "", "90", "0;0;0", "1;1;0.5". Returns none if it is
// wrong.
static std::optional<PieceOrder> read_piece(std::vector<std::string> parts) {
  if (parts.size() > 8) return {};
  parts.resize(8);
  PieceOrder order{.name = parts[0], .layer = parts[1], .over = parts[2]};
  const auto by = std::ranges::find(piece_blends, parts[3].empty() ? "none" : parts[3]);
  if (by == std::end(piece_blends)) return {};
  order.by = PieceBlend(by - std::begin(piece_blends));
  // Reads as many numbers as are there, if they are.
  auto read = [&](size_t part, size_t count, double most, auto... to) {
    if (parts[part].empty()) return true;
    const double least = part == 5 ? -most : 0;
    const std::vector<double> values = read_numbers(parts[part], ';', count, least, most);
    size_t i = 0;
    if (!values.empty()) ((*to = std::remove_pointer_t<decltype(to)>(values[i++])), ...);
    return !values.empty();
  };
  if (!read(4, 1, 1, &order.share) || !read(5, 1, 720, &order.turn) ||
      !read(6, 3, 1, &order.low.x, &order.low.y, &order.low.z) ||
      !read(7, 3, 1, &order.high.x, &order.high.y, &order.high.z))
    return {};
  return order;
}

// Reads what is seen of pieces; several have commas between.
static void read_pieces(const Exhibit& exhibit, QueryReader& fields, StillJob& job) {
  auto split = [](const std::string& text, char at) {
    std::vector<std::string> parts(1);
    for (const char c : text)
      if (c == at) parts.emplace_back();
      else parts.back() += c;
    return parts;
  };
  auto take = [&](const std::string& wrong) {
    if (!wrong.empty()) fields.refuse(404, "unknown_piece", wrong);
  };
  if (const std::string text = fields.text("pieces"); !text.empty())
    for (const std::string& one : split(text, ',')) {
      const std::optional<PieceOrder> order = read_piece(split(one, ':'));
      if (order) take(choose_piece(exhibit, *order, job.pieces));
      else
        fields.refuse(400, "bad_parameter",
                      "pieces: must be PIECE:LAYER:OVER:BY:SHARE:TURN:LOW:HIGH, BY none, curtain, "
                      "fade or difference, SHARE 0 to 1, TURN degrees, LOW and HIGH as 0;0;0.5, of "
                      "which the end may be left out");
    }
  const std::vector<double> glass = fields.numbers("lens", 4, 0, 64);
  if (glass.empty()) return;
  LensOrder& lens = job.lens;
  lens.at = vec2(std::min(glass[0], 1.0), std::min(glass[1], 1.0));
  lens.radius = float(std::clamp(glass[2], 0.02, 0.5)), lens.zoom = float(glass[3]);
  std::optional<float> depth;
  fields.number("lens_depth", 0, 1000, depth);
  lens.depth = depth.value_or(0);
  if (const std::string text = fields.text("lens_layer"); !text.empty()) {
    std::vector<std::string> parts = split(text, ':');
    parts.resize(3);
    lens.name = parts[0], lens.layer = parts[1], lens.difference = parts[2] == "difference";
  }
  PieceChoices choices;
  take(look_through(exhibit, lens, choices));
}

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
  read_pieces(exhibit, fields, job);
  return asked;
}

}  // namespace wellspring::show
