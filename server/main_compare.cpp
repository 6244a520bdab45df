// SPDX-License-Identifier: Apache-2.0
// Runs `wellspring compare MESH VOLUME`: how a surface differs from a CT volume. Exit status: 0
// done, 1 the input is wrong, 2 the command line is wrong.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>

#include "about/version.h"
#include "base/clock.h"
#include "base/load_error.h"
#include "base/log.h"
#include "base/write_file.h"
#include "volume/compare/colored_glb.h"
#include "volume/compare/compare_surface.h"
#include "volume/compare/mesh_file.h"
#include "volume/format/open_volume.h"
#include "world/load/scene_surface.h"

using namespace wellspring;
using namespace wellspring::program;

namespace {

struct Options {
  std::string mesh, volume, pairs, json, csv, colored, show = "distance";
  double unit_mm = 0;  // 0: by the file's kind
  bool no_register = false, falling = false;
  double reach = 16, threshold_per_mm = 0, spacing_voxels = 2, range_mm = 0, range_deg = 45,
         tolerance_mm = 0, kept_share = 0.8;
  std::vector<double> profile, lens;  // x, y, z in mm; and radius, size
};

SurfaceMesh read_surface(const Options& options) {
  const bool is_print = is_mesh_file(options.mesh);
  const double unit_mm = options.unit_mm > 0 ? options.unit_mm : is_print ? 1 : 1000;
  return is_print ? read_mesh_file(options.mesh, unit_mm / 1000)
                  : read_scene_surface(options.mesh, unit_mm / 1000);
}

dvec3 metres_of(const std::vector<double>& mm) { return dvec3(mm[0], mm[1], mm[2]) / 1000.0; }

// Adds what was asked to be shown of a part.
void look_closer(const Options& options, const DensityField& field, Comparison& comparison) {
  const auto& points = comparison.points;
  if (!options.profile.empty()) {
    const dvec3 at = metres_of(options.profile);
    const auto nearest =
        std::min_element(points.begin(), points.end(), [&](const auto& a, const auto& b) {
          return glm::distance(a.position, at) < glm::distance(b.position, at);
        });
    comparison.profile =
        ray_profile(field, *nearest, comparison.deviations[size_t(nearest - points.begin())],
                    comparison.settings);
  }
  if (options.lens.empty()) return;
  const LensArea lens{metres_of(options.lens), options.lens[3] / 1000};
  const double size = options.lens[4] / 1000;
  const double tolerance =
      options.tolerance_mm > 0 ? options.tolerance_mm / 1000 : comparison.voxel / 10;
  comparison.plots = lens_plots(points, comparison.deviations, lens, size);
  comparison.glyphs = lens_glyphs(points, comparison.deviations, lens, size, tolerance);
}

void compare(const Options& options) {
  CompareSettings settings;
  settings.cone.reach = options.reach;
  settings.cone.threshold = options.threshold_per_mm * 1000;
  settings.cone.boundary = options.falling ? Boundary::falling : Boundary::any;
  settings.registers = !options.no_register;
  settings.kept_share = options.kept_share;
  settings.spacing_voxels = options.spacing_voxels;
  if (!options.pairs.empty()) settings.pairs = read_control_pairs(options.pairs);
  const double began = seconds_now();
  SurfaceMesh mesh = read_surface(options);
  const Volume volume = open_volume(options.volume);
  const DensityField field = make_density_field(volume);
  const double read = seconds_now();
  Comparison comparison = compare_surface(field, settings, mesh);
  comparison.mesh = options.mesh, comparison.volume = options.volume;
  if (options.show == "angle") comparison.scale = angle_scale(options.range_deg);
  else if (options.range_mm > 0) comparison.scale = distance_scale(options.range_mm);
  const double compared = seconds_now();
  look_closer(options, field, comparison);
  std::cout << report_text(comparison);
  log::info("read in {:.2f} s, compared in {:.2f} s", read - began, compared - read);
  if (!options.json.empty())
    write_file(options.json, std::span<const char>(report_json(comparison)));
  if (!options.csv.empty()) write_file(options.csv, std::span<const char>(report_csv(comparison)));
  if (options.colored.empty()) return;
  const std::vector<Deviation> at_vertices(
      comparison.deviations.end() - ptrdiff_t(comparison.vertices), comparison.deviations.end());
  const std::string name = std::filesystem::path(options.mesh).stem().string();
  write_file(options.colored, std::span<const char>(colored_glb(
                                  mesh, deviation_colors(comparison.scale, at_vertices), name)));
}

void add_options(CLI::App& app, Options& o) {
  app.add_option("mesh", o.mesh, "the surface: glTF (.glb, .gltf), STL or PLY")->required();
  app.add_option("volume", o.volume, "the volume that was scanned")->required();
  app.add_option("--unit", o.unit_mm,
                 "millimetres that one unit of the mesh is worth; "
                 "without it 1 for STL and PLY, 1000 for glTF")
      ->check(CLI::Range(1e-6, 1e6));
  auto* pairs = app.add_option("--points", o.pairs,
                               "file of pairs of equal places, "
                               R"({"pairs": [{"surface_m": [x, y, z], "volume_m": [x, y, z]}]};)"
                               " without it the principal axes begin");
  app.add_flag("--no-register", o.no_register, "take the frames as they are")->excludes(pairs);
  app.add_option("--kept-share", o.kept_share, "of the points that placing goes by, the nearest")
      ->check(CLI::Range(0.1, 1.0))
      ->capture_default_str();
  app.add_option("--reach", o.reach, "voxels to look to either side of the surface")
      ->check(CLI::Range(1.0, longest_reach - 1))
      ->capture_default_str();
  app.add_option("--threshold", o.threshold_per_mm,
                 "slope of density per mm above which there is a boundary; without it automatic")
      ->check(CLI::PositiveNumber);
  app.add_flag("--falling", o.falling, "only boundaries at which density falls to the outside");
  app.add_option("--spacing", o.spacing_voxels, "voxels between points on the triangles")
      ->check(CLI::Range(0.1, 1000.0))
      ->capture_default_str();
  app.add_option("--json", o.json, "write the report as JSON");
  app.add_option("--csv", o.csv, "write a table of the points");
  app.add_option("--colored", o.colored, "write the surface with colours, a GLB");
  app.add_option("--show", o.show, "what colours show")
      ->check(CLI::IsMember({"distance", "angle"}))
      ->capture_default_str();
  app.add_option("--range", o.range_mm, "of the colours of distances, in mm")
      ->check(CLI::PositiveNumber);
  app.add_option("--angle-range", o.range_deg, "of the colours of angles, in degrees")
      ->check(CLI::Range(0.1, 180.0))
      ->capture_default_str();
  app.add_option("--profile", o.profile, "x,y,z in mm of the volume: adds the nearest point's ray")
      ->delimiter(',')
      ->expected(3);
  app.add_option("--lens", o.lens,
                 "x,y,z,radius,size in mm of the volume: adds box plots and glyphs of that ball")
      ->delimiter(',')
      ->expected(5);
  app.add_option("--tolerance", o.tolerance_mm, "mm that are no difference to glyphs")
      ->check(CLI::PositiveNumber);
}

}  // namespace

int main(int argc, char** argv) {
  if (answer_version(argc, argv)) return 0;
  log::start("compare");
  CLI::App app{"Tells how a surface differs from a volume that was scanned."};
  Options options;
  add_options(app, options);
  try {
    app.parse(argc, argv);
    if (!options.lens.empty() && !(options.lens[3] > 0 && options.lens[4] > 0))
      throw CLI::ValidationError("--lens", "radius and size must be above 0");
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    compare(options);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
