// SPDX-License-Identifier: Apache-2.0
#include "show/http/iiif_request.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fmt/core.h>
#include <vector>

namespace wellspring::show {
namespace {

constexpr size_t most_digits = 12;

// Is thrown, and caught, within this file.
struct BadIiifRequest {
  int status;
  std::string problem;
};
[[noreturn]] void refuse_part(const std::string& problem, int status = 400) {
  throw BadIiifRequest{status, problem};
}

std::vector<std::string_view> split_at(std::string_view text, char at) {
  std::vector<std::string_view> parts;
  for (;;) {
    const size_t end = text.find(at);
    parts.push_back(text.substr(0, end));
    if (end == text.npos) return parts;
    text.remove_prefix(end + 1);
  }
}

bool take_front(std::string_view& text, std::string_view beginning) {
  if (!text.starts_with(beginning)) return false;
  text.remove_prefix(beginning.size());
  return true;
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }

int64_t read_whole(std::string_view text, const char* what) {
  int64_t value = 0;
  if (text.empty() || text.size() > most_digits || !std::ranges::all_of(text, is_digit))
    refuse_part(fmt::format("{}: is no whole number", what));
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

// Numbers have a point at most, and no exponent (section 4.6).
double read_number(std::string_view text, const char* what) {
  double value = 0;
  const bool plain = std::ranges::all_of(text, [](char c) { return is_digit(c) || c == '.'; });
  const char* end = text.data() + text.size();
  const bool good = plain && !text.empty() && text.size() <= 2 * most_digits &&
                    std::from_chars(text.data(), end, value, std::chars_format::fixed).ptr == end;
  if (!good) refuse_part(fmt::format("{}: is no number such as 12.5", what));
  return value;
}

// Returns the largest size within a box that has the sides' ratio.
IiifSize fit_box(int64_t box_width, int64_t box_height, int64_t width, int64_t height) {
  const double scale =
      std::min(double(box_width) / double(width), double(box_height) / double(height));
  const auto side = [&](int64_t texels, int64_t most) {
    return int(std::clamp<int64_t>(std::llround(double(texels) * scale), 1, most));
  };
  return {side(width, box_width), side(height, box_height)};
}

void read_region(std::string_view text, int64_t width, int64_t height, IiifRequest& request) {
  int64_t x = 0, y = 0, wide = width, high = height;
  if (text == "square") {
    wide = high = std::min(width, height);
    x = (width - wide) / 2, y = (height - high) / 2;
  } else if (text != "full") {
    const bool is_percent = take_front(text, "pct:");
    const auto parts = split_at(text, ',');
    if (parts.size() != 4) refuse_part("region: is none of full, square, x,y,w,h and pct:x,y,w,h");
    const auto read = [&](size_t i, int64_t whole) -> int64_t {
      if (!is_percent) return read_whole(parts[i], "region");
      return std::llround(std::min(read_number(parts[i], "region"), 1e6) / 100 * double(whole));
    };
    x = read(0, width), y = read(1, height), wide = read(2, width), high = read(3, height);
    if (wide < 1 || high < 1) refuse_part("region: is empty");
    if (x >= width || y >= height) refuse_part("region: lies outside of the picture");
  }
  request.x = x, request.y = y;
  request.region_width = std::min(wide, width - x);
  request.region_height = std::min(high, height - y);
}

// Returns the side that a region has if its other side is given.
int64_t other_side(int64_t given, int64_t side, int64_t other) {
  return std::max<int64_t>(std::llround(double(other) * double(given) / double(side)), 1);
}

void read_size(std::string_view text, IiifRequest& request) {
  const int64_t region_width = request.region_width, region_height = request.region_height;
  const bool may_grow = take_front(text, "^");
  int64_t wide = 0, high = 0;
  if (text == "max") {
    const IiifSize most = may_grow
                              ? fit_box(most_iiif_side, most_iiif_side, region_width, region_height)
                              : largest_iiif_size(region_width, region_height);
    wide = most.width, high = most.height;
  } else if (take_front(text, "pct:")) {
    const double share = read_number(text, "size") / 100;
    if (!(share <= 1e6)) refuse_part("size: is too large");
    wide = std::llround(double(region_width) * share);
    high = std::llround(double(region_height) * share);
  } else {
    const bool is_box = take_front(text, "!");
    const auto parts = split_at(text, ',');
    if (parts.size() != 2 || (parts[0].empty() && parts[1].empty()) ||
        (is_box && (parts[0].empty() || parts[1].empty())))
      refuse_part("size: is none of max, w, ,h pct:n w,h and !w,h, with ^ before it or not");
    if (!parts[0].empty()) wide = read_whole(parts[0], "size");
    if (!parts[1].empty()) high = read_whole(parts[1], "size");
    if ((!parts[0].empty() && wide < 1) || (!parts[1].empty() && high < 1))
      refuse_part("size: is 0");
    if (parts[1].empty()) high = other_side(wide, region_width, region_height);
    if (parts[0].empty()) wide = other_side(high, region_height, region_width);
    if (is_box) {
      wide = std::min<int64_t>(wide, most_iiif_side);
      high = std::min<int64_t>(high, most_iiif_side);
      const IiifSize size = !may_grow && wide >= region_width && high >= region_height
                                ? IiifSize{int(region_width), int(region_height)}
                                : fit_box(wide, high, region_width, region_height);
      wide = size.width, high = size.height;
    }
  }
  if (wide < 1 || high < 1) refuse_part("size: is 0");
  if (!may_grow && (wide > region_width || high > region_height))
    refuse_part("size: is larger than the region; with ^ before it the picture is scaled up");
  if (std::max(wide, high) > most_iiif_side)
    refuse_part(fmt::format("size: is larger than {0} x {0}", most_iiif_side));
  request.width = int(wide), request.height = int(high);
}

void read_rotation(std::string_view text, IiifRequest& request) {
  request.is_mirrored = take_front(text, "!");
  const double degrees = read_number(text, "rotation");
  if (degrees > 360) refuse_part("rotation: is no angle from 0 to 360");
  const double turns = degrees / 90;
  if (turns != std::floor(turns)) refuse_part("rotation: only 0, 90, 180 and 270 are made", 501);
  request.quarter_turns = int(turns) % 4;
}

void read_quality(std::string_view text, IiifRequest& request) {
  const size_t dot = text.find('.');
  if (dot == text.npos) refuse_part("quality: is not followed by a format");
  const std::string_view quality = text.substr(0, dot), format = text.substr(dot + 1);
  if (quality == "gray") request.quality = IiifRequest::Quality::gray;
  else if (quality == "bitonal") request.quality = IiifRequest::Quality::bitonal;
  else if (quality != "default" && quality != "color")
    refuse_part("quality: is none of default, color, gray and bitonal");
  if (format == "png") request.format = IiifRequest::Format::png;
  else if (format != "jpg") refuse_part("format: is none of jpg and png");
}

std::string write_canonical(const IiifRequest& asked, int64_t width, int64_t height) {
  const int64_t wide = asked.region_width, high = asked.region_height;
  const bool is_full = wide == width && high == height;
  const auto has_size = [&](IiifSize size) {
    return asked.width == size.width && asked.height == size.height;
  };
  const bool grows = asked.width > wide || asked.height > high;
  std::string size = grows ? "^" : "";
  if (has_size(largest_iiif_size(wide, high)) ||
      (grows && has_size(fit_box(most_iiif_side, most_iiif_side, wide, high))))
    size += "max";
  else size += fmt::format("{},{}", asked.width, asked.height);
  constexpr std::array qualities = {"default", "gray", "bitonal"};
  return fmt::format("{}/{}/{}{}/{}.{}",
                     is_full ? "full" : fmt::format("{},{},{},{}", asked.x, asked.y, wide, high),
                     size, asked.is_mirrored ? "!" : "", asked.quarter_turns * 90,
                     qualities[size_t(asked.quality)],
                     asked.format == IiifRequest::Format::png ? "png" : "jpg");
}

}  // namespace

IiifSize largest_iiif_size(int64_t width, int64_t height) {
  if (std::max(width, height) <= most_iiif_side) return {int(width), int(height)};
  return fit_box(most_iiif_side, most_iiif_side, width, height);
}

IiifQuestion read_iiif_request(std::string_view text, int64_t width, int64_t height) {
  IiifQuestion question;
  IiifRequest& request = question.request;
  try {
    const auto parts = split_at(text, '/');
    if (parts.size() != 4) refuse_part("asks for no region/size/rotation/quality.format");
    read_region(parts[0], width, height, request);
    read_size(parts[1], request);
    read_rotation(parts[2], request);
    read_quality(parts[3], request);
    question.canonical = write_canonical(request, width, height);
  } catch (const BadIiifRequest& refusal) {
    question.status = refusal.status, question.problem = refusal.problem;
  }
  return question;
}

}  // namespace wellspring::show
