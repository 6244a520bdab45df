// SPDX-License-Identifier: Apache-2.0
// Mitsuba's reference pictures, pixel by pixel: z = |mean - reference| sqrt(spp / max(variance,
// 1e-4)) with the variance of one sample as Mitsuba measured it, two-sided, significance 1 % for
// the whole picture (Sidak); at least 99.75 % of what is judged must be within it. Besides, the
// mean over all pixels, where small errors of one sign add up. WELLSPRING_REFERENCE_SPP=4096 makes
// a long run of it, WELLSPRING_REFERENCE_PICTURES=FOLDER keeps the pictures.
#include <gtest/gtest.h>

#include <boost/math/distributions/normal.hpp>
#include <cstdlib>
#include <iostream>

#include "base/load_error.h"
#include "base/parallel.h"
#include "frame/picture_file.h"
#include "light/technique/technique.h"
#include "mitsuba_mesh.h"
#include "mitsuba_scene.h"

namespace wellspring::mitsuba {
namespace {

namespace fs = std::filesystem;

const fs::path data = fs::path(WELLSPRING_DATA) / "6_reference" / "mitsuba_data";

// Gaussian of standard deviation 0.5 pixel, cut off and lowered to 0 at 2.
float gaussian(float x) { return std::max(0.0f, std::exp(-2 * x * x) - std::exp(-8.0f)); }

// A picture with the variance of one of its samples, as Mitsuba's moment integrator makes them.
struct Moments {
  Frame mean;
  std::vector<vec3> variance;
};

// Every sample counts in the pixels whose filter reaches it, as weighted means; a box reaches its
// own pixel alone.
Moments render_moments(const World& world, const Lights& lights, const View& view,
                       const StillSettings& settings, bool gaussian_filter) {
  const Technique& path = *find_technique("path");
  struct Splat {
    vec2 offset;
    vec3 color;
  };
  size_t pixels = size_t(view.width) * size_t(view.height), spp = size_t(settings.spp);
  std::vector<Splat> splats(pixels * spp);
  parallel_for(int(pixels), [&](int pixel) {
    int x = pixel % view.width, y = pixel / view.width;
    for (size_t i = 0; i < spp; i++) {
      Request request = pixel_request(view, settings.seed, x, y, int(i));
      vec3 d = request.ray.direction / dot(request.ray.direction, view.forward);
      float scale = float(view.height) / (2 * view.tan_half_fov);
      vec2 at(dot(d, view.right) * scale + 0.5f * float(view.width) - float(x) - 0.5f,
              0.5f * float(view.height) - dot(d, view.up) * scale - float(y) - 0.5f);
      splats[size_t(pixel) * spp + i] = {
          at, path.trace(world, lights, settings.transport, request).radiance()};
    }
  });
  Moments result;
  result.mean.width = view.width;
  result.mean.height = view.height;
  result.mean.color.resize(pixels);
  result.variance.resize(pixels);
  int reach = gaussian_filter ? 2 : 0;
  parallel_for(int(pixels), [&](int pixel) {
    int x = pixel % view.width, y = pixel / view.width;
    dvec3 sum(0), squares(0);
    double weights = 0;
    for (int v = std::max(0, y - reach); v <= std::min(view.height - 1, y + reach); v++)
      for (int u = std::max(0, x - reach); u <= std::min(view.width - 1, x + reach); u++)
        for (size_t i = 0; i < spp; i++) {
          const Splat& s = splats[(size_t(v) * size_t(view.width) + size_t(u)) * spp + i];
          double weight = 1;
          if (gaussian_filter)
            weight =
                double(gaussian(float(u - x) + s.offset.x) * gaussian(float(v - y) + s.offset.y));
          sum += weight * dvec3(s.color);
          squares += weight * dvec3(s.color) * dvec3(s.color);
          weights += weight;
        }
    dvec3 mean = sum / std::max(weights, 1e-9);
    result.mean.color[size_t(pixel)] = vec3(mean);
    result.variance[size_t(pixel)] =
        vec3(glm::max(squares / std::max(weights, 1e-9) - mean * mean, dvec3(0)));
  });
  return result;
}

// Pixels that see nothing whose look is not exactly ours.
std::vector<bool> judged_pixels(const ReferenceScene& reference, const World& world) {
  const View& view = reference.view;
  std::vector<bool> judged(size_t(view.width) * size_t(view.height), true);
  constexpr int grid = 8;
  for (size_t pixel = 0; pixel < judged.size() && !reference.inexact.empty(); pixel++)
    for (int i = 0; i <= grid && judged[pixel]; i++)
      for (int j = 0; j <= grid; j++) {
        float x = float(pixel % size_t(view.width)) + float(i) / grid,
              y = float(pixel / size_t(view.width)) + float(j) / grid;
        Hit hit = world.intersect(view_ray(view, x, y));
        if (hit.valid() && reference.inexact.count(hit.instance)) judged[pixel] = false;
      }
  return judged;
}

struct Judgement {
  int values = 0, outside = 0;  // colour components judged; beyond the limit
  double worst = 0, limit = 0;  // |z|
  double mean_z = 0;            // z of the sum over the picture
  double relative = 0;          // difference of the means
};

// If the reference's variance is negative (it is a difference of moments, lost to rounding), ours
// stands in for it.
Judgement judge(const Moments& ours, const Frame& reference, const Frame& variance,
                const std::vector<bool>& judged, int spp) {
  Judgement j;
  size_t pixels = 0;
  for (bool b : judged) pixels += b;
  double alone = 1 - std::pow(0.99, 1.0 / double(pixels));
  j.limit = quantile(complement(boost::math::normal(), alone / 2));
  double difference = 0, sum = 0, variances = 0;
  for (size_t i = 0; i < judged.size(); i++) {
    if (!judged[i]) continue;
    for (int k = 0; k < 3; k++) {
      double known =
          variance.color[i][k] < 0 ? double(ours.variance[i][k]) : double(variance.color[i][k]);
      double v = std::max(known, 1e-4);
      double d = double(ours.mean.color[i][k]) - double(reference.color[i][k]);
      double z = std::abs(d) * std::sqrt(spp / v);
      j.values++;
      j.outside += !(z <= j.limit);
      j.worst = std::max(j.worst, z);
      difference += d;
      sum += double(reference.color[i][k]);
      variances += v / spp;
    }
  }
  j.mean_z = difference / std::sqrt(variances);
  j.relative = difference / sum;
  return j;
}

void judge_scene(const char* folder, const char* scene, const char* reference, int spp) {
  fs::path place = data / "tests" / "scenes" / folder;
  if (!fs::exists(place)) GTEST_SKIP() << "no reference pictures at " << place;
  // The means of a long run would be judged finer than the references are themselves.
  const char* asked = std::getenv("WELLSPRING_REFERENCE_SPP");
  if (asked) spp = std::clamp(std::atoi(asked), 1, 1 << 16);
  ReferenceScene converted = load_reference_scene(place / (std::string(scene) + ".xml"));
  std::string stem = (place / "refs" / reference).string();
  Frame expected = load_linear_picture(stem + "_ref_rgb.exr"),
        variance = load_linear_picture(stem + "_ref_rgb_var.exr");
  ASSERT_EQ(expected.width, converted.view.width);
  ASSERT_EQ(expected.height, converted.view.height);
  World world(converted.scene);
  Lights lights = make_lights(world);
  StillSettings settings;
  settings.spp = spp;
  settings.transport.max_depth = converted.max_depth;
  Moments ours = render_moments(world, lights, converted.view, settings, converted.gaussian_filter);
  std::vector<bool> judged = judged_pixels(converted, world);
  Judgement j = judge(ours, expected, variance, judged, spp);
  std::cout << reference << ": " << j.values / 3 << " of " << judged.size() << " pixels, " << spp
            << " samples: " << 100 - 100.0 * j.outside / j.values << " % within |z| " << j.limit
            << ", worst " << j.worst << ", mean " << 100 * j.relative << " % apart, z " << j.mean_z
            << "\n";
  if (const char* folder_out = std::getenv("WELLSPRING_REFERENCE_PICTURES")) {
    save_picture(std::string(folder_out) + "/" + reference + "_ours.exr", ours.mean, {});
    save_picture(std::string(folder_out) + "/" + reference + "_ours.png", ours.mean, {});
    save_picture(std::string(folder_out) + "/" + reference + "_theirs.png", expected, {});
  }
  EXPECT_GT(j.values, 3 * 100) << "too little of the picture is judged";
  EXPECT_LE(j.outside, 0.0025 * j.values);
  if (!asked) {
    EXPECT_LE(std::abs(j.mean_z), 2.576) << "the means differ (two-sided, 1 %)";
  }
  EXPECT_EQ(lights.bad_samples->load(), 0u);
}

}  // namespace

// The walls' spectra stand in the data once more, as Mitsuba's own RGB.
TEST(Mitsuba, SpectraBecomeTheColorsThatMitsubaMakesOfThem) {
  fs::path box = data / "scenes" / "cbox";
  if (!fs::exists(box)) GTEST_SKIP() << "no scenes at " << box;
  Document spectral, rgb;
  load_document(box / "cbox-spectral.xml", spectral);
  load_document(box / "cbox-rgb.xml", rgb);
  for (const char* name : {"white", "red", "green", "light"}) {
    vec3 ours = spectrum_to_rgb(text(spectral.by_id.at(name), "reflectance", ""));
    vec3 theirs(parse_vector(text(rgb.by_id.at(name), "reflectance", "")));
    EXPECT_LT(length(ours - theirs), 0.002f * length(theirs))
        << name << ": " << ours.x << " " << ours.y << " " << ours.z;
  }
}

TEST(Mitsuba, FloatingSphereInDirectionalLight) {
  judge_scene("floating_sphere", "test_directional_direct", "test_directional", 64);
}
TEST(Mitsuba, Instances) {
  judge_scene("instancing", "test_instancing_path", "test_instancing", 64);
}
TEST(Mitsuba, FaceWeights) {
  judge_scene("mesh_attributes", "test_mesh_attributes_1_face_direct",
              "test_mesh_attributes_1_face", 64);
}
TEST(Mitsuba, FaceColors) {
  judge_scene("mesh_attributes", "test_mesh_attributes_3_face_direct",
              "test_mesh_attributes_3_face", 64);
}
TEST(Mitsuba, VertexColors) {
  judge_scene("mesh_attributes", "test_mesh_attributes_3_vertex_direct",
              "test_mesh_attributes_3_vertex", 64);
}
TEST(Mitsuba, TextureInterpolation) {
  judge_scene("texture_interp", "test_texture_interp_direct", "test_texture_interp", 16);
}
TEST(Mitsuba, TexturedSphereInThreeLights) {
  judge_scene("bsdf_spheres", "test_textured_diffuse_path", "test_textured_diffuse", 64);
}
TEST(Mitsuba, SpheresUnderAnAreaLight) {
  judge_scene("bsdf_spheres", "test_arealight_path", "test_arealight", 64);
}
TEST(Mitsuba, SpheresInUniformLight) {
  judge_scene("bsdf_spheres", "test_constant_path", "test_constant", 64);
}
TEST(Mitsuba, SpheresInAnEnvironment) {
  judge_scene("bsdf_spheres", "test_envmap_path", "test_envmap", 64);
}
TEST(Mitsuba, SpheresUnderAPointLight) {
  judge_scene("bsdf_spheres", "test_pointlight_path", "test_pointlight", 64);
}

}  // namespace wellspring::mitsuba
