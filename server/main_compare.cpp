// SPDX-License-Identifier: Apache-2.0
// Runs `wellspring compare MESH VOLUME`: how a surface differs from a CT volume. Exit status: 0
// done, 1 the input is wrong, 2 the command line is wrong.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <filesystem>
#include <iostream>

#include "about/version.h"
#include "base/clock.h"
#include "base/load_error.h"
#include "base/log.h"
#include "base/write_file.h"
#include "volume/compare/colored_glb.h"
#include "volume/compare/mesh_file.h"
#include "volume/compare/report.h"
#include "volume/format/open_volume.h"
#include "world/load/scene_load.h"

using namespace wellspring;
using namespace wellspring::program;

namespace {

constexpr size_t most_points = 4'000'000;

struct Options {
  std::string mesh, volume, pairs, json, csv, colored, show = "distance";
  double unit_mm = 0;  // 0: by the file's kind
  bool no_register = false, falling = false;
  double reach = 16, threshold_per_mm = 0, spacing_voxels = 2, range_mm = 0, range_deg = 45,
         tolerance_mm = 0, kept_share = 0.8;
  std::vector<double> profile, lens;  // x, y, z in mm; and radius, size
};

// Joins all triangles of a glTF file, where its nodes put them.
SurfaceMesh read_scene_surface(const std::string& file, double metres) {
  const Scene scene = load_scene(file);
  SurfaceMesh surface;
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[size_t(instance.mesh)];
    const dmat4 to_world(instance.to_world);
    const bool mirrors = glm::determinant(glm::dmat3(to_world)) < 0;
    if (surface.positions.size() + mesh.positions.size() > UINT32_MAX)
      throw LoadError(file, "", "has too many vertices");
    const uint32_t first = uint32_t(surface.positions.size());
    for (vec3 position : mesh.positions)
      surface.positions.push_back(
          (dvec3(to_world * glm::dvec4(dvec3(position), 1)) + scene.origin) * metres);
    for (uvec3 triangle : mesh.triangles) {
      if (mirrors) std::swap(triangle.y, triangle.z);
      surface.triangles.push_back(triangle + first);
    }
  }
  if (surface.triangles.empty()) throw LoadError(file, "", "has no triangles");
  weld(surface);
  return surface;
}

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

// A scale that is not given reaches from the first to the last percent.
ColorScale chosen_scale(const Options& options, const Comparison& comparison) {
  if (options.show == "angle") return angle_scale(options.range_deg);
  double range = options.range_mm;
  if (range <= 0)
    for (const auto& one : comparison.summary.percentiles)
      range = std::max(range, std::abs(one.distance) * 1000);
  return distance_scale(range > 0 ? range : comparison.voxel * 1000);
}

void compare(const Options& options) {
  double began = seconds_now();
  auto lap = [&] {
    const double now = seconds_now(), took = now - began;
    began = now;
    return took;
  };
  SurfaceMesh mesh = read_surface(options);
  const Volume volume = open_volume(options.volume);
  std::vector<ControlPair> pairs;
  if (!options.pairs.empty()) pairs = read_control_pairs(options.pairs);
  const DensityField field = make_density_field(volume);
  Comparison comparison;
  comparison.mesh = options.mesh, comparison.volume = options.volume;
  comparison.triangles = mesh.triangles.size(), comparison.vertices = mesh.positions.size();
  comparison.flat_triangles = flat_triangles(mesh);
  comparison.grid = field.grid.size, comparison.voxel = field.voxel;
  comparison.settings.reach = options.reach;
  comparison.settings.threshold = options.threshold_per_mm * 1000;
  comparison.settings.boundary = options.falling ? Boundary::falling : Boundary::any;
  comparison.threshold = slope_threshold(field, comparison.settings);
  const double read_time = lap();
  if (!options.no_register) {
    RegistrationSettings settings;
    settings.kept_share = options.kept_share, settings.reach = options.reach;
    settings.threshold = comparison.settings.threshold;
    comparison.registration = register_surface(mesh, field, pairs, settings);
    mesh = moved(mesh, comparison.registration->to_volume);
  }
  const double place_time = lap();
  comparison.points = triangle_points(mesh, options.spacing_voxels * field.voxel, most_points);
  const size_t first_vertex = comparison.points.size();
  const std::vector<SurfacePoint> vertices = vertex_points(mesh);
  comparison.points.insert(comparison.points.end(), vertices.begin(), vertices.end());
  comparison.deviations = find_deviations(field, comparison.points, comparison.settings);
  const double search_time = lap();
  comparison.summary = summarize(comparison.points, comparison.deviations);
  comparison.scale = chosen_scale(options, comparison);
  look_closer(options, field, comparison);
  std::cout << report_text(comparison);
  log::info("read in {:.2f} s, placed in {:.2f} s, searched in {:.2f} s", read_time, place_time,
            search_time);
  if (!options.json.empty())
    write_file(options.json, std::span<const char>(report_json(comparison)));
  if (!options.csv.empty()) write_file(options.csv, std::span<const char>(report_csv(comparison)));
  if (options.colored.empty()) return;
  const std::vector<Deviation> at_vertices(comparison.deviations.begin() + ptrdiff_t(first_vertex),
                                           comparison.deviations.end());
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
