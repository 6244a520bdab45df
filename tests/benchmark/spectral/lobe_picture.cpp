// SPDX-License-Identifier: Apache-2.0
#include "lobe_picture.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "light/material/dispersion.h"
#include "light/random/sampler.h"
#include "scenes/build.h"
#include "world/load/scene_spectra.h"

namespace wellspring::test {
namespace {

using namespace scenes;

const vec3 view_direction(0, 0, -1);   // all of the eye's rays are parallel
constexpr float half_picture = 0.69f;  // so that its corners are still on the ball
constexpr float stripes_z = -20, period = 8, lit = 2;
constexpr int stripe_count = 40;  // to both sides
constexpr int seen_steps = 4096, lobe_steps = 4096;

float stripe_begin(int i) { return float(i - stripe_count) * period; }

// Returns the sine between a lobe and a plane beyond which nothing of it is on the other side.
double reach_of(double exponent) { return std::min(1.0, 9 / std::sqrt(exponent)); }

// Returns the share of a lobe (n + 1) / (2 pi) cos^n that is above a plane through its origin.
double share_above(double sine, double exponent) {
  const double along = std::sqrt(std::max(0.0, 1 - sine * sine));
  double sum = 0;
  for (int i = 0; i < lobe_steps; i++) {
    const double cosine = std::pow((i + 0.5) / lobe_steps, 1 / (exponent + 1));
    const double spread = along * std::sqrt(1 - cosine * cosine);
    const double height = sine * cosine;
    sum += height >= spread ? 1 : height <= -spread ? 0 : std::acos(-height / spread) / double(pi);
  }
  return sum / lobe_steps;
}

}  // namespace

LobePicture::LobePicture(const LobeMaterial& lobes, int size) : lobes_(lobes), size_(size) {
  Scene known;
  Spectrum index;
  for (size_t i = 0; i < spectrum_size; i++)
    index[i] = glm::mix(lobes.index_at_360, lobes.index_at_830,
                        (nm_of(i) - first_nm) / double(last_nm - first_nm));
  material_.spectra.index = add_spectrum(known, "index", index);
  tables_ = make_spectral_tables(known);
  ball_scene_ = stripes_scene_ = empty_scene();
  add_sphere(ball_scene_, diffuse(vec3(1)), 1, "ball");
  const int lamp = add_material(stripes_scene_, emitter(vec3(1)));
  for (int i = 0; i < 2 * stripe_count; i++)
    add_quad(stripes_scene_, lamp, {stripe_begin(i), -400, stripes_z}, {lit, 0, 0}, {0, 800, 0});
  ball_ = std::make_unique<World>(ball_scene_);
  stripes_ = std::make_unique<World>(stripes_scene_);
  const double reach = reach_of(lobes.exponent);
  for (int i = 0; i <= seen_steps; i++)
    seen_.push_back(share_above(reach * (2.0 * i / seen_steps - 1), lobes.exponent));
}

vec3 LobePicture::place_of(int pixel) const {
  const vec2 at((float(pixel % size_) + 0.5f) / float(size_),
                (float(pixel / size_) + 0.5f) / float(size_));
  const vec2 xy = half_picture * (2.0f * at - 1.0f);
  return {xy, std::sqrt(1 - dot(xy, xy))};
}

float LobePicture::index_of(float nm) const { return index_at(*tables_, material_, nm); }

double LobePicture::seen(double sine) const {
  const double reach = reach_of(lobes_.exponent);
  const double x = glm::clamp((sine / reach + 1) / 2, 0.0, 1.0) * seen_steps;
  const size_t i = std::min(size_t(x), size_t(seen_steps) - 1);
  return glm::mix(seen_[i], seen_[i + 1], x - double(i));
}

// The stripes' edges are parallel: each makes a plane with the place on the ball, and what a lobe
// sees of a stripe is the difference of what is above two planes.
LobePixels LobePicture::reference() const {
  LobePixels pixels(size_t(size_) * size_t(size_), dvec3(0));
  parallel_for(int(pixels.size()), [&](int pixel) {
    const vec3 place = place_of(pixel);
    std::vector<dvec3> edges;
    for (int i = 0; i < 2 * stripe_count; i++)
      for (const float x : {stripe_begin(i), stripe_begin(i) + lit})
        edges.push_back(
            normalize(dvec3(double(place.z) - double(stripes_z), 0, double(x - place.x))));
    dvec3& sum = pixels[size_t(pixel)];
    for (size_t nm = 0; nm < spectrum_size; nm++) {
      const double chance = double(tables_->below[nm + 1] - tables_->below[nm]);
      const dvec3 lobe =
          glm::refract(dvec3(view_direction), dvec3(place), 1 / double(index_of(float(nm_of(nm)))));
      double light = 0;
      for (size_t i = 0; i < edges.size(); i += 2)
        light += seen(dot(lobe, edges[i])) - seen(dot(lobe, edges[i + 1]));
      sum += chance * light * dvec3(tables_->response[nm]);
    }
  });
  return pixels;
}

vec3 LobePicture::cluster(LobeEstimator estimator, int pixel, uint64_t seed,
                          uint32_t number) const {
  const vec3 place = place_of(pixel);
  Ray ray{.origin = place - 3.0f * view_direction, .direction = view_direction};
  if (!ball_->intersect(ray).valid()) return vec3(0);
  Sampler sampler(sample_seed(seed, uint32_t(pixel), 0, 0), number);
  Wavelengths w;
  begin_cluster(*tables_, hero_place(sampler.next(), mix64(sampler.seed ^ mix64(number))), w);
  const vec2 u = sampler.next2();
  const float exponent = float(lobes_.exponent);
  auto lobe = [&](int i) { return refract(view_direction, place, 1 / index_of(w.nm[i])); };
  const vec3 axis = lobe(0);
  const float cosine = std::pow(1 - u.x, 1 / (exponent + 1));
  const float sine = std::sqrt(std::max(0.0f, 1 - cosine * cosine)), turn = 2 * pi * u.y;
  vec3 tangent = normalize(cross(axis, std::abs(axis.x) < 0.5f ? vec3(1, 0, 0) : vec3(0, 1, 0)));
  const vec3 direction = normalize(cosine * axis + sine * std::cos(turn) * tangent +
                                   sine * std::sin(turn) * cross(axis, tangent));
  // The lobes are sampled as they scatter: over the hero's, values are densities.
  const float hero = std::max(dot(axis, direction), 1e-6f);
  for (int i = 1; i < wavelength_count; i++) {
    float share = 0;
    if (estimator != LobeEstimator::single) {
      const float along = dot(lobe(i), direction) / hero;
      share = along > 0 ? std::pow(along, exponent) : 0.0f;
    }
    w.value[i] *= share;
    w.density[i] *= estimator == LobeEstimator::naive ? 1 : share;
  }
  if (!stripes_->intersect({.origin = place, .direction = direction}).valid()) return vec3(0);
  return tint_of(*tables_, w);
}

LobePixels LobePicture::draw(LobeEstimator estimator, int clusters, uint64_t seed) const {
  LobePixels pixels(size_t(size_) * size_t(size_), dvec3(0));
  parallel_for(int(pixels.size()), [&](int pixel) {
    dvec3 sum(0);
    for (int i = 0; i < clusters; i++) sum += dvec3(cluster(estimator, pixel, seed, uint32_t(i)));
    pixels[size_t(pixel)] = sum / double(clusters);
  });
  return pixels;
}

double LobePicture::variance(LobeEstimator estimator, int count, uint64_t seed) const {
  std::vector<double> of(size_t(size_) * size_t(size_));
  parallel_for(int(of.size()), [&](int pixel) {
    dvec3 sum(0), squares(0);
    for (int i = 0; i < count; i++) {
      // The first of a sequence of its own owes nothing to the others.
      const dvec3 one(cluster(estimator, pixel, mix64(seed + uint64_t(i)), 0));
      sum += one, squares += one * one;
    }
    const dvec3 mean = sum / double(count), spread = squares / double(count) - mean * mean;
    of[size_t(pixel)] = (spread.x + spread.y + spread.z) / 3;
  });
  double sum = 0;
  for (const double one : of) sum += one;
  return sum / double(of.size());
}

double lobe_error(std::span<const dvec3> picture, std::span<const dvec3> truth, bool shown) {
  auto cut = [&](const dvec3& c) { return shown ? glm::clamp(c, dvec3(0), dvec3(1)) : c; };
  double sum = 0;
  for (size_t i = 0; i < picture.size(); i++) {
    const dvec3 off = abs(cut(picture[i]) - cut(truth[i]));
    sum += off.x + off.y + off.z;
  }
  return sum / (3 * double(picture.size()));
}

}  // namespace wellspring::test
