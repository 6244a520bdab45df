// SPDX-License-Identifier: Apache-2.0
// Runs `wellspring nebula PICTURE`: makes a volume of light of a picture of a planetary nebula, and
// a picture of the volume from the front and from the right. Exit status: 0 done, 1 the input is
// wrong, 2 the command line is wrong.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <fmt/core.h>
#include <iostream>

#include "about/version.h"
#include "base/log.h"
#include "frame/picture_file.h"
#include "volume/nebula/nebula.h"
#include "volume/nrrd_write.h"

namespace wellspring::program {
namespace {

struct Options {
  std::string picture, out, rings = "60x120", solver = "fista", samples = "u8";
  double angle = 0, tilt = 0;
  bool has_angle = false, has_tilt = false, keep_stars = false;
  NebulaSettings nebula;
};

// Shows the light so that one pixel in two hundred is white or more.
void save_preview(const std::string& file, const Volume& volume) {
  image::LinearImage shown = show_cubes(volume);
  std::vector<float> light;
  for (const vec3 color : shown.color) light.push_back(std::max({color.x, color.y, color.z}));
  const auto white = light.end() - ptrdiff_t(light.size() / 200) - 1;
  std::nth_element(light.begin(), white, light.end());
  Frame frame;
  frame.width = shown.width, frame.height = shown.height;
  frame.color = std::move(shown.color);
  const float exposure = *white > 0 ? 1 / *white : 1;
  for (vec3& color : frame.color) color *= exposure;
  Image8 picture;
  tonemap(frame, Tonemap{}, picture);
  save_image8(file, picture);
}

void tell(const NebulaReport& report, const Volume& volume) {
  const glm::dvec3 residual = report.residual.empty() ? glm::dvec3(0) : report.residual.back();
  std::cout << fmt::format(
      "stars: {} filled, {} pixels\naxis: {:.1f} degrees{}\ntilt: {:.1f} degrees{}\n"
      "rays: {} in {} rings, {} lengths\nresidual: {:.4f} {:.4f} {:.4f} after {} iterations\n"
      "voxels: {} x {} x {}\nreprojection error: {:.1e}\n"
      "unreached: {} pixels, {:.3f} % of the light\n"
      "seconds: {:.2f} picture, {:.2f} rays, {:.2f} solve, {:.2f} voxels\n",
      report.stars, report.star_pixels, report.angle_degrees,
      report.angle_proposed ? ", proposed" : "", report.tilt_degrees,
      report.tilt_proposed ? ", proposed (or the other way)" : "", report.rays, report.rings,
      report.entries, residual.x, residual.y, residual.z, report.residual.size(), volume.size.x,
      volume.size.y, volume.size.z, report.cubes.reprojection_error, report.cubes.unreached_pixels,
      100 * report.cubes.unreached_light, report.prepare_seconds, report.system_seconds,
      report.solve_seconds, report.cubes_seconds);
}

int run(Options& options) {
  NebulaSettings& settings = options.nebula;
  char rest = 0;
  if (std::sscanf(options.rings.c_str(), "%dx%d%c", &settings.rings.x, &settings.rings.y, &rest) !=
          2 ||
      settings.rings.x < 1 || settings.rings.y < 1) {
    std::cerr << "--rings wants RADIALxAXIAL, such as 60x120\n";
    return 2;
  }
  if (options.has_angle) settings.angle_degrees = options.angle;
  if (options.has_tilt) settings.tilt_degrees = options.tilt;
  settings.remove_stars = !options.keep_stars;
  settings.solve.solver = ring_solver_of(options.solver);
  settings.cubes.kind = options.samples == "f32"   ? SampleKind::f32
                        : options.samples == "u16" ? SampleKind::u16
                                                   : SampleKind::u8;
  const std::filesystem::path picture(options.picture);
  if (options.out.empty()) options.out = picture.stem().string() + ".nrrd";
  NebulaReport report;
  const Volume volume = make_nebula(load_nebula_picture(options.picture), settings, report);
  save_nrrd(options.out, volume);
  std::filesystem::path preview(options.out);
  preview.replace_extension(".png");
  std::error_code error;
  if (std::filesystem::equivalent(preview, picture, error)) preview.replace_extension(".seen.png");
  save_preview(preview.string(), volume);
  tell(report, volume);
  return 0;
}

}  // namespace
}  // namespace wellspring::program

int main(int argc, char** argv) {
  using namespace wellspring;
  using namespace wellspring::program;
  if (answer_version(argc, argv)) return 0;
  log::start("nebula");
  CLI::App app{
      "Makes a volume of light of one picture of a planetary nebula, as NRRD, and beside "
      "it a picture of it from the front and from the right."};
  Options options;
  app.add_option("picture", options.picture, "PNG, JPEG or WebP")->required();
  const CLI::Option& angle = *app.add_option(
      "--angle", options.angle, "of the axis, degrees from the right, counter-clockwise");
  const CLI::Option& tilt = *app.add_option("--tilt", options.tilt,
                                            "of that end of the axis out of the picture, degrees");
  app.get_option("--tilt")->check(CLI::Range(-75.0, 75.0));
  app.add_option("--rings", options.rings, "along the radius and the axis")->capture_default_str();
  app.add_option("--solver", options.solver)
      ->check(CLI::IsMember({"fista", "mlem", "cgls", "free-cgls"}))
      ->capture_default_str();
  app.add_option("--iterations", options.nebula.solve.iterations)
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  app.add_option("--side", options.nebula.most_side, "longest side of the volume, in voxels")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  app.add_option("--samples", options.samples)
      ->check(CLI::IsMember({"u8", "u16", "f32"}))
      ->capture_default_str();
  app.add_option("--width", options.nebula.cubes.width_metres, "of the longer side, in metres")
      ->check(CLI::Range(0.001, 1000.0))
      ->capture_default_str();
  app.add_option("--star-radius", options.nebula.stars.radius,
                 "pixels: stars are about a third of it; 0: a 64th of the longer side")
      ->check(CLI::Range(0, 200))
      ->capture_default_str();
  app.add_flag("--keep-stars", options.keep_stars, "leave stars in the picture");
  app.add_option("--out", options.out, "NRRD file; beside it a PNG is written");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  options.has_angle = angle.count() > 0, options.has_tilt = tilt.count() > 0;
  try {
    return run(options);
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
