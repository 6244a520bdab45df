// SPDX-License-Identifier: Apache-2.0
#include "store/painting/painting_path.h"

#include <cairo.h>

#include <charconv>
#include <cmath>
#include <memory>

#include "base/rng.h"

namespace wellspring::store {

namespace {

constexpr double most_coordinate = 1e4;
constexpr int curve_corners = 6;  // straight parts of a curve

// Appends smooth curves through `through`, whose first point is the current one.
void add_smooth_curve(PaintPath& path, const std::vector<dvec2>& through, bool closes) {
  const int count = int(through.size());
  const auto at = [&](int i) {
    if (closes) return through[size_t((i + count) % count)];
    return through[size_t(std::clamp(i, 0, count - 1))];
  };
  for (int i = 0; i + (closes ? 0 : 1) < count; i++) {
    path.steps.push_back('C');
    path.points.push_back(at(i) + (at(i + 1) - at(i - 1)) / 6.0);
    path.points.push_back(at(i + 1) - (at(i + 2) - at(i)) / 6.0);
    path.points.push_back(at(i + 1));
  }
}

// Reads a path's letters and numbers one after another.
struct PathText {
  const char *at, *end;
  void skip() {
    while (at < end && (*at == ' ' || *at == ',' || *at == '\n' || *at == '\t')) at++;
  }
  char letter() {
    skip();
    return at < end && *at >= 'A' && *at <= 'Z' ? *at++ : 0;
  }
  bool has_number() {
    skip();
    return at < end && !(*at >= 'A' && *at <= 'Z');
  }
  bool number(double& to) {
    skip();
    const auto [next, error] = std::from_chars(at, end, to);
    if (error != std::errc() || !(std::abs(to) <= most_coordinate)) return false;
    at = next;
    return true;
  }
  bool point(dvec2& to) { return number(to.x) && number(to.y); }
};

using ScratchCairo = std::unique_ptr<cairo_t, decltype(&cairo_destroy)>;

ScratchCairo make_scratch() {
  // Image surfaces drop letters that lie far outside.
  cairo_surface_t* surface = cairo_recording_surface_create(CAIRO_CONTENT_ALPHA, nullptr);
  ScratchCairo cairo(cairo_create(surface), &cairo_destroy);
  cairo_surface_destroy(surface);
  return cairo;
}

}  // namespace

std::string read_paint_path(const std::string& text, PaintPath& path) {
  PathText in{text.data(), text.data() + text.size()};
  dvec2 current(0);
  while (const char letter = in.letter()) {
    if (path.empty() && letter != 'M') return "a path begins with M";
    if (letter == 'Z') {
      path.steps.push_back('Z');
    } else if (letter == 'R') {
      std::vector<dvec2> through{current};
      for (dvec2 p; in.has_number(); through.push_back(p))
        if (!in.point(p)) return "R takes points of two numbers each";
        else if (through.size() > size_t(most_path_points)) break;
      in.skip();
      // A curve from the part's beginning to its end closes smoothly, too.
      const bool whole = path.steps.back() == 'M' && in.at < in.end && *in.at == 'Z';
      add_smooth_curve(path, through, whole);
      current = through.back();
    } else if (letter == 'M' || letter == 'L' || letter == 'C') {
      const int count = letter == 'C' ? 3 : 1;
      do {
        for (int i = 0; i < count; i++) {
          if (!in.point(current)) return std::string(1, letter) + " takes points of two numbers";
          path.points.push_back(current);
        }
        path.steps.push_back(
            letter == 'M' && path.steps.size() && path.steps.back() == 'M' ? 'L' : letter);
      } while (in.has_number() && path.points.size() <= size_t(most_path_points));
    } else {
      return std::string("a path has no letter ") + letter + "; M, L, C, R and Z are known";
    }
    if (path.points.size() > size_t(most_path_points))
      return "has more than " + std::to_string(most_path_points) + " points";
  }
  in.skip();
  if (in.at != in.end) return "a path has letters and numbers only";
  return path.empty() ? "a path has points" : "";
}

PaintPath ellipse_path(dvec2 middle, dvec2 radii, double turn) {
  constexpr double k = 0.5522847498;
  const dvec2 x = radii.x * dvec2(std::cos(turn), std::sin(turn)),
              y = radii.y * dvec2(-std::sin(turn), std::cos(turn));
  const auto at = [&](double a, double b) { return middle + a * x + b * y; };
  return {{'M', 'C', 'C', 'C', 'C', 'Z'},
          {at(1, 0), at(1, k), at(k, 1), at(0, 1), at(-k, 1), at(-1, k), at(-1, 0), at(-1, -k),
           at(-k, -1), at(0, -1), at(k, -1), at(1, -k), at(1, 0)}};
}

namespace {

constexpr double drawn_size = 256;  // at which hinting plays no part

// Opens a drawing in which letters are written at that size.
ScratchCairo open_lettering(const PaintLettering& lettering) {
  ScratchCairo cairo = make_scratch();
  cairo_font_options_t* options = cairo_font_options_create();
  cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
  cairo_set_font_options(cairo.get(), options);
  cairo_font_options_destroy(options);
  const char* family = lettering.family == "script" ? "Z003"
                       : lettering.family == "sans" ? "sans-serif"
                                                    : "serif";
  cairo_select_font_face(cairo.get(), family,
                         lettering.slanted ? CAIRO_FONT_SLANT_ITALIC : CAIRO_FONT_SLANT_NORMAL,
                         lettering.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(cairo.get(), drawn_size);
  return cairo;
}

}  // namespace

double letter_width(const PaintLettering& lettering) {
  const ScratchCairo cairo = open_lettering(lettering);
  cairo_text_extents_t extents;
  cairo_text_extents(cairo.get(), lettering.text.c_str(), &extents);
  return extents.x_advance * lettering.size / drawn_size;
}

PaintPath letter_path(const PaintLettering& lettering) {
  const ScratchCairo cairo = open_lettering(lettering);
  cairo_text_extents_t extents;
  cairo_text_extents(cairo.get(), lettering.text.c_str(), &extents);
  cairo_text_path(cairo.get(), lettering.text.c_str());
  const double scale = lettering.size / drawn_size;
  const dvec2 x = scale * dvec2(std::cos(lettering.turn), std::sin(lettering.turn)),
              y = scale * dvec2(-std::sin(lettering.turn), std::cos(lettering.turn));
  const double begin = -lettering.align * extents.x_advance;
  PaintPath path;
  cairo_path_t* drawn = cairo_copy_path(cairo.get());
  for (int i = 0; i < drawn->num_data; i += drawn->data[i].header.length) {
    const cairo_path_data_t* data = drawn->data + i;
    path.steps.push_back("MLCZ"[data->header.type]);
    for (int k = 1; k < data->header.length; k++)
      path.points.push_back(lettering.at + (data[k].point.x + begin) * x + data[k].point.y * y);
  }
  cairo_path_destroy(drawn);
  return path;
}

PaintPath wobbled_path(const PaintPath& path, double amount, double period, uint64_t seed) {
  if (!(amount > 0) || !(period > 0)) return path;
  constexpr int most_parts = 24;
  PaintPath drawn;
  size_t next = 0;
  dvec2 current(0), begin(0);
  int count = 0;
  const auto moved = [&](dvec2 p) {
    count++;
    return p + amount * dvec2(paint_chance(seed, count, 0, 0) - 0.5,
                              paint_chance(seed, count, 0, 1) - 0.5);
  };
  const auto line_to = [&](dvec2 to) {
    const int parts = int(std::clamp(glm::length(to - current) / period, 1.0, double(most_parts)));
    for (int i = 1; i <= parts; i++) {
      drawn.steps.push_back('L');
      drawn.points.push_back(moved(glm::mix(current, to, double(i) / parts)));
    }
    current = to;
  };
  for (char step : path.steps) {
    if (step == 'M') {
      begin = current = path.points[next++];
      drawn.steps.push_back('M');
      drawn.points.push_back(moved(current));
    } else if (step == 'L') {
      line_to(path.points[next++]);
    } else if (step == 'C') {
      drawn.steps.push_back('C');
      for (int i = 0; i < 3; i++) drawn.points.push_back(moved(path.points[next++]));
      current = path.points[next - 1];
    } else {
      line_to(begin);
    }
  }
  return drawn;
}

std::vector<dvec2> flatten_path(const PaintPath& path) {
  std::vector<dvec2> corners;
  size_t next = 0;
  for (char step : path.steps) {
    if (step == 'M' || step == 'L') corners.push_back(path.points[next++]);
    if (step != 'C') continue;
    const dvec2 a = corners.back(), *p = &path.points[next];
    for (int i = 1; i <= curve_corners; i++) {
      const double t = double(i) / curve_corners, s = 1 - t;
      corners.push_back(s * s * s * a + 3 * s * s * t * p[0] + 3 * s * t * t * p[1] +
                        t * t * t * p[2]);
    }
    next += 3;
  }
  return corners;
}

bool is_within(const std::vector<dvec2>& corners, dvec2 point) {
  bool within = false;
  for (size_t i = 0, k = corners.size() - 1; i < corners.size(); k = i++) {
    const dvec2 a = corners[i], b = corners[k];
    if ((a.y > point.y) != (b.y > point.y) &&
        point.x < (b.x - a.x) * (point.y - a.y) / (b.y - a.y) + a.x)
      within = !within;
  }
  return within;
}

}  // namespace wellspring::store
