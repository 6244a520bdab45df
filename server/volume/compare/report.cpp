// SPDX-License-Identifier: Apache-2.0
#include "volume/compare/report.h"

#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace wellspring::volume {

namespace {

using OrderedJson = nlohmann::ordered_json;

double in_mm(double metres) { return metres * 1000; }

// Formats as printf does.
[[gnu::format(printf, 1, 2)]] std::string formatted(const char* format, ...) {
  char text[512];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  return text;
}

OrderedJson place_mm(dvec3 place) {
  return OrderedJson::array({in_mm(place.x), in_mm(place.y), in_mm(place.z)});
}
OrderedJson three(vec3 v) { return OrderedJson::array({v.x, v.y, v.z}); }

OrderedJson registration_json(const Comparison& comparison) {
  OrderedJson json;
  json["done"] = comparison.registration.has_value();
  if (!comparison.registration) return json;
  const Registration& found = *comparison.registration;
  json["start"] = found.start;
  json["iterations"] = found.iterations;
  json["mean_square_error_mm2"] = found.mean_square_error * 1e6;
  json["root_mean_square_error_mm"] = in_mm(std::sqrt(found.mean_square_error));
  json["found_share"] = found.found_share;
  OrderedJson rows = OrderedJson::array();
  for (int row = 0; row < 4; row++)
    for (int column = 0; column < 4; column++) rows.push_back(found.to_volume[column][row]);
  json["to_volume_rows_m"] = rows;
  return json;
}

OrderedJson summary_json(const DeviationSummary& summary) {
  OrderedJson json;
  json["points"] = summary.points;
  json["found"] = summary.found;
  json["not_found_share"] = summary.not_found_share;
  json["min_mm"] = in_mm(summary.least);
  json["max_mm"] = in_mm(summary.greatest);
  json["mean_mm"] = in_mm(summary.mean);
  json["mean_absolute_mm"] = in_mm(summary.mean_absolute);
  json["rms_mm"] = in_mm(summary.root_mean_square);
  json["standard_deviation_mm"] = in_mm(summary.deviation);
  json["mean_uncertainty_mm"] = in_mm(summary.mean_uncertainty);
  json["max_uncertainty_mm"] = in_mm(summary.greatest_uncertainty);
  json["mean_normal_angle_deg"] = glm::degrees(summary.mean_normal_angle);
  json["percentiles"] = OrderedJson::array();
  for (const auto& one : summary.percentiles)
    json["percentiles"].push_back(
        OrderedJson{{"percent", one.percent}, {"distance_mm", in_mm(one.distance)}});
  json["histogram"] = {{"from_mm", in_mm(summary.least)}, {"to_mm", in_mm(summary.greatest)}};
  json["histogram"]["shares"] = summary.histogram;
  return json;
}

OrderedJson scale_json(const ColorScale& scale) {
  OrderedJson json{{"shows", scale.shown == Shown::distance ? "distance" : "normal angle"},
                   {"unit", scale.unit},
                   {"low", scale.low},
                   {"high", scale.high}};
  json["ticks"] = OrderedJson::array();
  for (const ColorTick& tick : scale.ticks) {
    OrderedJson one{{"value", tick.value}, {"position", tick.position}};
    one["linear_rgb"] = three(scale_color(scale, tick.value));
    json["ticks"].push_back(one);
  }
  return json;
}

OrderedJson profile_json(const RayProfile& profile) {
  OrderedJson json{{"found", profile.found}, {"surface_mm", 0}};
  json["threshold_per_mm"] = profile.threshold / 1000;
  if (profile.found) {
    json["boundary_mm"] = in_mm(profile.boundary);
    json["distance_mm"] = in_mm(profile.distance);
  }
  json["place_mm"] = json["slope_per_mm"] = OrderedJson::array();
  for (double place : profile.places) json["place_mm"].push_back(in_mm(place));
  for (double slope : profile.slopes) json["slope_per_mm"].push_back(slope / 1000);
  return json;
}

OrderedJson plot_json(const BoxPlot& plot) {
  OrderedJson json;
  json["position_mm"] = place_mm(plot.position);
  json["normal"] = three(plot.normal);
  json["diameter_mm"] = in_mm(plot.diameter);
  json["points"] = plot.count;
  json["found"] = plot.found;
  if (plot.found == 0) return json;
  json["min_mm"] = in_mm(plot.least);
  json["lower_quartile_mm"] = in_mm(plot.lower_quartile);
  json["median_mm"] = in_mm(plot.median);
  json["upper_quartile_mm"] = in_mm(plot.upper_quartile);
  json["max_mm"] = in_mm(plot.greatest);
  json["mean_mm"] = in_mm(plot.mean);
  json["standard_deviation_mm"] = in_mm(plot.deviation);
  json["mean_uncertainty_mm"] = in_mm(plot.uncertainty);
  return json;
}

OrderedJson glyph_json(const DistanceGlyph& glyph) {
  static constexpr const char* sides[] = {"none", "inside", "outside"};
  OrderedJson json;
  json["position_mm"] = place_mm(glyph.position);
  json["normal"] = three(glyph.normal);
  json["arrow_mm"] = in_mm(glyph.arrow);
  json["disc_diameter_mm"] = in_mm(glyph.disc_diameter);
  json["side"] = sides[int(glyph.side)];
  json["disc_linear_rgb"] = three(glyph.disc_color);
  return json;
}

}  // namespace

std::string report_text(const Comparison& comparison) {
  const DeviationSummary& summary = comparison.summary;
  std::string text =
      "surface  " + comparison.mesh +
      formatted(": %zu triangles, %zu vertices", comparison.triangles, comparison.vertices);
  if (comparison.flat_triangles > 0)
    text += formatted(", %zu without an area, which measure nothing", comparison.flat_triangles);
  text += "\nvolume   " + comparison.volume +
          formatted(": %d x %d x %d samples, %.4g mm\n", comparison.grid.x, comparison.grid.y,
                    comparison.grid.z, in_mm(comparison.voxel));
  if (const auto& found = comparison.registration)
    text += formatted("placed   from %s, %d iterations, root mean square %.4f mm\n",
                      found->start.c_str(), found->iterations,
                      in_mm(std::sqrt(found->mean_square_error)));
  else text += "placed   as the frames are\n";
  text += formatted("searched %zu points, %.4g mm to either side, slope above %.4g per mm\n",
                    summary.points, in_mm(comparison.settings.reach * comparison.voxel),
                    comparison.threshold / 1000);
  text += formatted("not found on %.2f %% of the surface\n", summary.not_found_share * 100);
  if (summary.found == 0) return text;
  text += formatted("distance %.4f to %.4f mm (+: material is missing), mean %.4f, rms %.4f mm\n",
                    in_mm(summary.least), in_mm(summary.greatest), in_mm(summary.mean),
                    in_mm(summary.root_mean_square));
  for (const auto& one : summary.percentiles)
    text +=
        formatted("  %2.0f %% of the surface below %9.4f mm\n", one.percent, in_mm(one.distance));
  text += formatted("uncertainty %.4f mm, at most %.4f mm; normals differ by %.2f degrees\n",
                    in_mm(summary.mean_uncertainty), in_mm(summary.greatest_uncertainty),
                    glm::degrees(summary.mean_normal_angle));
  return text;
}

std::string report_json(const Comparison& comparison) {
  OrderedJson json;
  json["mesh"] = {{"file", comparison.mesh},
                  {"triangles", comparison.triangles},
                  {"triangles_without_area", comparison.flat_triangles},
                  {"vertices", comparison.vertices}};
  json["volume"] = {{"file", comparison.volume}, {"voxel_mm", in_mm(comparison.voxel)}};
  json["volume"]["samples"] =
      OrderedJson::array({comparison.grid.x, comparison.grid.y, comparison.grid.z});
  json["search"] = {{"reach_voxels", comparison.settings.reach},
                    {"ray_spacing_deg", glm::degrees(comparison.settings.ray_spacing)}};
  json["search"]["threshold_per_mm"] = comparison.threshold / 1000;  // null if there is no slope
  json["registration"] = registration_json(comparison);
  json["deviation"] = summary_json(comparison.summary);
  json["color_scale"] = scale_json(comparison.scale);
  if (comparison.profile) json["ray_profile"] = profile_json(*comparison.profile);
  for (const BoxPlot& plot : comparison.plots) json["box_plots"].push_back(plot_json(plot));
  for (const DistanceGlyph& glyph : comparison.glyphs) json["glyphs"].push_back(glyph_json(glyph));
  return json.dump(2, ' ', false, OrderedJson::error_handler_t::replace) + "\n";
}

std::string report_csv(const Comparison& comparison) {
  std::string text =
      "x_mm,y_mm,z_mm,area_mm2,found,distance_mm,uncertainty_mm,normal_angle_deg,cone_base_mm\n";
  for (size_t i = 0; i < comparison.points.size(); i++) {
    const SurfacePoint& point = comparison.points[i];
    const Deviation& one = comparison.deviations[i];
    text += formatted("%.9g,%.9g,%.9g,%.6g,%d,", in_mm(point.position.x), in_mm(point.position.y),
                      in_mm(point.position.z), point.area * 1e6, int(one.found));
    if (one.found)
      text += formatted("%.6g,%.6g,%.6g,", in_mm(one.distance), in_mm(one.uncertainty),
                        glm::degrees(double(one.normal_angle)));
    else text += ",,,";
    text += formatted("%.6g\n", in_mm(one.cone_base));
  }
  return text;
}

}  // namespace wellspring::volume
