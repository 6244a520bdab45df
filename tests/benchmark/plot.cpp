// SPDX-License-Identifier: Apache-2.0
#include "plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <stdexcept>

namespace wellspring::test {
namespace {

constexpr double plot_width = 920, plot_height = 540;
constexpr double left = 84, right = 250, top = 72, bottom = 64;

// Okabe and Ito 2008: told apart by every kind of colour vision, on white.
constexpr const char* colors[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                  "#e69f00", "#56b4e9", "#000000", "#8a7a00"};
constexpr int marks = 4;

std::string number(double value, const char* format = "%.2f") {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string escaped(const std::string& text) {
  std::string out;
  for (char c : text)
    if (c == '<') out += "&lt;";
    else if (c == '>') out += "&gt;";
    else if (c == '&') out += "&amp;";
    else out += c;
  return out;
}

// A logarithmic axis over [low, high], from `begin` to `end` in the picture.
struct Axis {
  double low = 1, high = 10, begin = 0, end = 1;
  double at(double value) const {
    return begin + (std::log10(value) - std::log10(low)) / (std::log10(high) - std::log10(low)) *
                       (end - begin);
  }
};

bool drawn(const std::pair<double, double>& p) {
  return std::isfinite(p.first) && std::isfinite(p.second) && p.first > 0 && p.second > 0;
}

// Round ends, with a little air: 1, 2 or 5 times a power of ten.
double round_down(double value) {
  double decade = std::pow(10, std::floor(std::log10(value))), digit = value / decade;
  return decade * (digit >= 5 ? 5 : digit >= 2 ? 2 : 1);
}
double round_up(double value) {
  double decade = std::pow(10, std::floor(std::log10(value))), digit = value / decade;
  return decade * (digit <= 1 ? 1 : digit <= 2 ? 2 : digit <= 5 ? 5 : 10);
}

Axis make_axis(const Plot& plot, bool vertical, double begin, double end) {
  double low = 1e300, high = 0;
  for (const Curve& curve : plot.curves)
    for (const auto& p : curve.points)
      if (drawn(p)) {
        low = std::min(low, vertical ? p.second : p.first);
        high = std::max(high, vertical ? p.second : p.first);
      }
  if (vertical && plot.level > 0) {
    low = std::min(low, plot.level);
    high = std::max(high, plot.level);
  }
  if (!(high > 0)) low = 1, high = 10;
  low = round_down(low / 1.05);
  high = round_up(high * 1.05);
  return {low, std::max(high, low * 10), begin, end};
}

// 0.001, 20, 1000; powers of ten beyond.
std::string tick_label(double value) {
  if (value >= 0.000999 && value < 9999.5) return number(value, "%g");
  double exponent = std::round(std::log10(value)), digit = value / std::pow(10, exponent);
  std::string power = "10<tspan dy=\"-5\" font-size=\"9\">" + number(exponent, "%.0f") + "</tspan>";
  return std::abs(digit - 1) < 1e-6 ? power : number(digit, "%g") + "\u00b7" + power;
}

std::string line(double x0, double y0, double x1, double y1, const char* style) {
  return "<line x1=\"" + number(x0) + "\" y1=\"" + number(y0) + "\" x2=\"" + number(x1) +
         "\" y2=\"" + number(y1) + "\" " + style + "/>\n";
}
std::string text(double x, double y, const std::string& content, const std::string& style) {
  return "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\" " + style + ">" + content +
         "</text>\n";
}

std::string draw_axis(const Axis& axis, bool vertical) {
  std::string out;
  bool sparse = std::log10(axis.high / axis.low) > 2.5;  // then only decades are labelled
  for (double decade = std::pow(10, std::floor(std::log10(axis.low) + 1e-9));
       decade <= axis.high * 1.0001; decade *= 10)
    for (int digit = 1; digit < 10; digit++) {
      double value = decade * digit;
      if (value < axis.low * 0.9999 || value > axis.high * 1.0001) continue;
      double at = axis.at(value);
      const char* style = digit == 1 ? "stroke=\"#c8c8c8\"" : "stroke=\"#ececec\"";
      out += vertical ? line(left, at, plot_width - right, at, style)
                      : line(at, top, at, plot_height - bottom, style);
      if (digit != 1 && (sparse || (digit != 2 && digit != 5))) continue;
      out += vertical
                 ? text(left - 8, at + 4, tick_label(value), "text-anchor=\"end\"")
                 : text(at, plot_height - bottom + 18, tick_label(value), "text-anchor=\"middle\"");
    }
  return out;
}

std::string mark(int kind, double x, double y, const char* color) {
  std::string fill = std::string("fill=\"") + color + "\"";
  auto polygon = [&](std::initializer_list<std::pair<double, double>> corners) {
    std::string points;
    for (auto [dx, dy] : corners) points += number(x + dx) + "," + number(y + dy) + " ";
    return "<polygon points=\"" + points + "\" " + fill + "/>\n";
  };
  switch (kind % marks) {
    case 1: return polygon({{-3.6, -3.6}, {3.6, -3.6}, {3.6, 3.6}, {-3.6, 3.6}});
    case 2: return polygon({{0, -4.8}, {4.4, 3.2}, {-4.4, 3.2}});
    case 3: return polygon({{0, -5}, {5, 0}, {0, 5}, {-5, 0}});
    default:
      return "<circle cx=\"" + number(x) + "\" cy=\"" + number(y) + "\" r=\"3.8\" " + fill + "/>\n";
  }
}

// Names beside the curves' ends, moved apart where they would touch.
struct Label {
  double wanted, y;
  size_t curve;
};
void spread(std::vector<Label>& labels) {
  constexpr double apart = 17;
  std::sort(labels.begin(), labels.end(),
            [](const Label& a, const Label& b) { return a.wanted < b.wanted; });
  double highest = top + 6;
  for (Label& label : labels) {
    label.y = std::max(label.wanted, highest);
    highest = label.y + apart;
  }
  double lowest = plot_height - bottom;
  for (size_t i = labels.size(); i-- > 0;) {
    labels[i].y = std::min(labels[i].y, lowest);
    lowest = labels[i].y - apart;
  }
}

}  // namespace

std::string make_svg(const Plot& plot) {
  Axis x = make_axis(plot, false, left, plot_width - right);
  Axis y = make_axis(plot, true, plot_height - bottom, top);
  std::string out = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " +
                    number(plot_width, "%.0f") + " " + number(plot_height, "%.0f") + "\" width=\"" +
                    number(plot_width, "%.0f") + "\" height=\"" + number(plot_height, "%.0f") +
                    "\" font-family=\"DejaVu Sans, Helvetica, Arial, sans-serif\" "
                    "font-size=\"12\" fill=\"#222\">\n"
                    "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n";
  out += text(left, 30, escaped(plot.title), "font-size=\"18\" font-weight=\"bold\"");
  out += text(left, 52, escaped(plot.subtitle), "fill=\"#555\"");
  out += draw_axis(x, false) + draw_axis(y, true);
  out += "<rect x=\"" + number(left) + "\" y=\"" + number(top) + "\" width=\"" +
         number(plot_width - left - right) + "\" height=\"" + number(plot_height - top - bottom) +
         "\" fill=\"none\" stroke=\"#888\"/>\n";
  out += text((left + plot_width - right) / 2, plot_height - 18, escaped(plot.x_label),
              "text-anchor=\"middle\" font-size=\"13\"");
  out += text(0, 0, escaped(plot.y_label),
              "text-anchor=\"middle\" font-size=\"13\" transform=\"translate(22," +
                  number((top + plot_height - bottom) / 2) + ") rotate(-90)\"");
  if (plot.level > 0) {
    out += line(left, y.at(plot.level), plot_width - right, y.at(plot.level),
                "stroke=\"#555\" stroke-dasharray=\"6 4\"");
    out += text(left + 8, y.at(plot.level) - 6, escaped(plot.level_name), "fill=\"#555\"");
  }
  std::vector<Label> labels;
  for (size_t i = 0; i < plot.curves.size(); i++) {
    const char* color = colors[i % std::size(colors)];
    std::string points, dots;
    double last = 0;
    for (const auto& p : plot.curves[i].points)
      if (drawn(p)) {
        double px = x.at(p.first), py = last = y.at(p.second);
        points += number(px) + "," + number(py) + " ";
        dots += mark(int(i), px, py, color);
      }
    if (points.empty()) continue;
    out += "<polyline points=\"" + points + "\" fill=\"none\" stroke=\"" + color +
           "\" stroke-width=\"2\" stroke-linejoin=\"round\"/>\n" + dots;
    labels.push_back({last, last, i});
  }
  spread(labels);
  for (const Label& label : labels) {
    const char* color = colors[label.curve % std::size(colors)];
    out += mark(int(label.curve), plot_width - right + 16, label.y, color);
    out += text(plot_width - right + 28, label.y + 4, escaped(plot.curves[label.curve].name),
                std::string("fill=\"") + color + "\" font-weight=\"bold\"");
  }
  return out + "</svg>\n";
}

void save_svg(const std::string& file, const Plot& plot) {
  std::ofstream out(file);
  out << make_svg(plot);
  if (!out.flush()) throw std::runtime_error(file + ": cannot be written");
}

}  // namespace wellspring::test
