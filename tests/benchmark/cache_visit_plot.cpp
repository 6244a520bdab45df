// SPDX-License-Identifier: Apache-2.0
#include "cache_visit_plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <map>

#include "base/load_error.h"

namespace wellspring::test {
namespace {

// Told apart by colour-blind readers too (Okabe and Ito's palette), and by the marks.
constexpr const char* colours[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                   "#e69f00", "#56b4e9", "#222222"};

struct Curve {
  std::string name;
  size_t colour = 0;
  bool baseline = false;  // dashed
  std::vector<dvec2> points;
};

struct Panel {
  double left = 0, top = 0, width = 0, height = 0;  // the plotted area, pixels
  dvec2 low{0}, high{1};                            // its corners in data
  double x(double v) const { return left + width * (v - low.x) / (high.x - low.x); }
  double y(double v) const { return top + height * (high.y - v) / (high.y - low.y); }
};

std::string format(const char* pattern, auto... values) {
  char text[512];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

std::string write(double x, double y, const char* anchor, int size, const std::string& text) {
  return format("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\" font-size=\"%d\">", x, y, anchor,
                size) +
         text + "</text>\n";
}

std::string open_svg(int width, int height) {
  return format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" viewBox=\"0 0 %d "
      "%d\" font-family=\"sans-serif\" fill=\"#222\">\n<rect width=\"100%%\" "
      "height=\"100%%\" fill=\"white\"/>\n",
      width, height, width, height);
}

// A step of 1, 2 or 5 times a power of ten that divides the span into about `parts`.
double nice_step(double span, int parts) {
  double raw = span / parts, power = std::pow(10, std::floor(std::log10(raw)));
  for (double factor : {1.0, 2.0, 5.0})
    if (factor * power >= raw) return factor * power;
  return 10 * power;
}

std::string draw_frame(const Panel& p, double x_step, double y_step, bool x_labels,
                       const std::function<std::string(double)>& x_label) {
  std::string svg;
  for (double v = p.low.y; v <= p.high.y + 1e-9; v += y_step) {
    svg += format("<line x1=\"%.1f\" x2=\"%.1f\" y1=\"%.1f\" y2=\"%.1f\" stroke=\"#ddd\"/>\n",
                  p.left, p.left + p.width, p.y(v), p.y(v));
    svg += write(p.left - 6, p.y(v) + 4, "end", 12, format("%g", std::round(v * 1e6) / 1e6));
  }
  for (double v = p.low.x; v <= p.high.x + 1e-9; v += x_step) {
    svg += format("<line x1=\"%.1f\" x2=\"%.1f\" y1=\"%.1f\" y2=\"%.1f\" stroke=\"#888\"/>\n",
                  p.x(v), p.x(v), p.top + p.height, p.top + p.height + 4);
    if (x_labels) svg += write(p.x(v), p.top + p.height + 18, "middle", 12, x_label(v));
  }
  return svg + format(
                   "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" fill=\"none\" "
                   "stroke=\"#888\"/>\n",
                   p.left, p.top, p.width, p.height);
}

std::string draw_mark(double x, double y, size_t kind) {
  const char* colour = colours[kind % std::size(colours)];
  if (kind % 2 == 0)
    return format("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3.5\" fill=\"%s\"/>\n", x, y, colour);
  return format("<rect x=\"%.1f\" y=\"%.1f\" width=\"6\" height=\"6\" fill=\"%s\"/>\n", x - 3,
                y - 3, colour);
}

std::string stroke_of(const Curve& curve) {
  return format(
      "stroke=\"%s\"%s", colours[curve.colour % std::size(colours)],
      curve.baseline ? " stroke-width=\"1.5\" stroke-dasharray=\"5 3\"" : " stroke-width=\"2\"");
}

std::string draw_curve(const Panel& p, const Curve& curve) {
  std::string svg = "<polyline fill=\"none\" " + stroke_of(curve) + " points=\"";
  for (dvec2 v : curve.points) svg += format("%.1f,%.1f ", p.x(v.x), p.y(v.y));
  svg += "\"/>\n";
  for (dvec2 v : curve.points) svg += draw_mark(p.x(v.x), p.y(v.y), curve.colour);
  return svg;
}

std::string draw_legend(const std::vector<Curve>& curves, double x, double y, double advance) {
  std::string svg;
  for (const Curve& curve : curves) {
    svg +=
        format("<line x1=\"%.1f\" x2=\"%.1f\" y1=\"%.1f\" y2=\"%.1f\" ", x, x + 24, y - 4, y - 4) +
        stroke_of(curve) + "/>\n";
    svg += draw_mark(x + 12, y - 4, curve.colour) + write(x + 30, y, "start", 13, curve.name);
    x += advance;
  }
  return svg;
}

void save(const std::string& file, const std::string& svg) {
  std::ofstream out(file);
  out << svg << "</svg>\n";
  if (!out.flush()) throw LoadError(file, "", "cannot be written");
}

double largest_y(const std::vector<Curve>& curves) {
  double largest = 0;
  for (const Curve& curve : curves)
    for (dvec2 v : curve.points) largest = std::max(largest, v.y);
  return largest;
}

// Makes a curve for each method that was run; a method has its colour, whichever others were run.
std::vector<Curve> empty_curves(const VisitResult& result) {
  std::vector<Curve> curves;
  size_t colour = 0;
  for (const VisitMethodEntry& entry : visit_methods()) {
    auto same = [&](const VisitRun& run) { return run.method == entry.name; };
    if (std::any_of(result.runs.begin(), result.runs.end(), same))
      curves.push_back({entry.name, colour, entry.baseline, {}});
    colour++;
  }
  return curves;
}

double legend_advance(double width, size_t curves) {
  return std::min(width / double(std::max<size_t>(curves, 1)), 160.0);
}

}  // namespace

void save_budget_plot(const std::string& file, const VisitResult& result,
                      const std::vector<int>& mismatches) {
  std::vector<Curve> curves = empty_curves(result);
  for (Curve& curve : curves)
    for (int mismatch : mismatches)
      curve.points.push_back(
          {-std::log2(double(mismatch)), mean_flip(result, curve.name, mismatch)});
  auto [few, many] = std::minmax_element(mismatches.begin(), mismatches.end());
  Panel panel{70, 60, 600, 320};
  panel.low = {-std::log2(double(*many)), 0};
  double step = nice_step(largest_y(curves), 6);
  panel.high = {-std::log2(double(*few)), step * std::ceil(largest_y(curves) / step)};
  std::string svg = open_svg(760, 450);
  svg += write(70, 24, "start", 16, "Error as the visitor has it, mean over all traces");
  svg += draw_frame(panel, 1, step, true,
                    [](double v) { return "1/" + format("%.0f", std::exp2(-v)); });
  for (const Curve& curve : curves) svg += draw_curve(panel, curve);
  svg += draw_legend(curves, 80, 48, legend_advance(660, curves.size()));
  svg += write(370, 430, "middle", 13, "samples a frame over pixels (60 frames a second)");
  svg += "<g transform=\"translate(18 220) rotate(-90)\">" +
         write(0, 0, "middle", 13, "mean FLIP against the converged wanted view") + "</g>\n";
  save(file, svg);
}

void save_time_plot(const std::string& file, const VisitResult& result, int mismatch) {
  std::vector<std::string> traces;
  std::map<std::string, std::vector<Curve>> diagrams;
  for (const VisitRun& run : result.runs) {
    if (run.mismatch != mismatch) continue;
    if (!diagrams.contains(run.trace)) {
      traces.push_back(run.trace);
      diagrams[run.trace] = empty_curves(result);
    }
    for (Curve& curve : diagrams[run.trace])
      if (curve.name == run.method)
        for (const VisitInstant& instant : run.instants)
          curve.points.push_back({instant.time, instant.flip});
  }
  if (traces.empty()) return;
  constexpr int across = 2, width = 380, height = 190;
  int down = (int(traces.size()) + across - 1) / across;
  double top = 0;
  for (const auto& [name, curves] : diagrams) top = std::max(top, largest_y(curves));
  double step = nice_step(top, 4);
  std::string svg = open_svg(across * width + 40, down * height + 100);
  svg += write(50, 24, "start", 16,
               format("FLIP over time, %d pixels for every sample a frame", mismatch));
  std::vector<Curve> names = empty_curves(result);
  svg += draw_legend(names, 60, 48, legend_advance(740, names.size()));
  for (size_t i = 0; i < traces.size(); i++) {
    const std::vector<Curve>& curves = diagrams[traces[i]];
    double last = 0;
    for (const Curve& curve : curves)
      for (dvec2 v : curve.points) last = std::max(last, v.x);
    Panel panel{60.0 + width * double(i % across), 84.0 + height * double(i / across), width - 60.0,
                height - 62.0};
    panel.high = {std::ceil(last), step * std::ceil(top / step)};
    svg += write(panel.left + 4, panel.top - 6, "start", 13, traces[i]);
    svg += draw_frame(panel, 1, step, true, [](double v) { return format("%g s", v); });
    for (const Curve& curve : curves) svg += draw_curve(panel, curve);
  }
  save(file, svg);
}

}  // namespace wellspring::test
