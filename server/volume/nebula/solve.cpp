// SPDX-License-Identifier: Apache-2.0
#include "volume/nebula/solve.h"

#include <algorithm>
#include <cmath>

#include "base/load_error.h"
#include "volume/nebula/ring_sweep.h"

namespace wellspring::volume {

namespace {

using Rays = std::span<const ColorLanes>;
using Lights = std::vector<ColorLanes>;

ColorLanes not_negative(ColorLanes a) { return a > 0 ? a : ColorLanes{}; }
// Returns a / b, 0 where b is 0 or less.
ColorLanes ratio(ColorLanes a, ColorLanes b) { return b > 0 ? a / b : ColorLanes{}; }

ColorLanes sum_of_squares(Rays values) {
  ColorLanes sum{};
  for (const ColorLanes value : values) sum += value * value;
  return sum;
}

// Keeps how far the rays are from what they should gather. Residuals lie in their rays' order, so
// that the sum does not depend on which core was first.
struct Course {
  const SolveSettings& settings;
  ColorLanes whole;  // the square of b's norm
  std::vector<glm::dvec3> residual;

  // Returns whether it is worth going on.
  bool note(Rays difference) {
    const ColorLanes part = ratio(sum_of_squares(difference), whole);
    residual.push_back(glm::sqrt(glm::dvec3(part[0], part[1], part[2])));
    constexpr size_t back = 5;
    if (settings.least_gain <= 0 || residual.size() <= back) return true;
    const glm::dvec3 before = residual[residual.size() - 1 - back];
    return glm::any(glm::greaterThan(before - residual.back(), settings.least_gain * before));
  }
};

// Sets the sweep to A^T (b - A x), and the difference to what is in the brackets.
void sweep_difference(RingSweep& sweep, Lights& difference, const RingSystem& system, Rays b,
                      const Lights& light) {
  sweep_rings(sweep, system, light,
              [&](size_t ray, ColorLanes gathered) { return difference[ray] = b[ray] - gathered; });
}

void solve_by_fista(const RingSystem& system, Rays b, Lights& light, Course& course) {
  // A^T A is at most the diagonal matrix of A^T A 1, since no length is negative.
  RingSweep sweep;
  const Lights ones(light.size(), all_colors(1));
  sweep_rings(sweep, system, ones, [](size_t, ColorLanes gathered) { return gathered; });
  const Lights bound = sweep.back;
  Lights ahead = light, difference(b.size());
  ColorLanes pace = all_colors(1);
  for (int i = 0; i < course.settings.iterations; ++i) {
    sweep_difference(sweep, difference, system, b, ahead);
    ColorLanes climbs{};
    Lights next(light.size());
    for (size_t k = 0; k < light.size(); ++k) {
      next[k] = not_negative(ahead[k] + ratio(sweep.back[k], bound[k]));
      climbs += (ahead[k] - next[k]) * bound[k] * (next[k] - light[k]);
    }
    for (int c = 0; c < 3; ++c)
      if (climbs[c] > 0) pace[c] = 1;
    ColorLanes momentum{};
    for (int c = 0; c < 3; ++c) {
      const double faster = (1 + std::sqrt(1 + 4 * pace[c] * pace[c])) / 2;
      momentum[c] = climbs[c] > 0 ? 0 : (pace[c] - 1) / faster;
      pace[c] = faster;
    }
    for (size_t k = 0; k < light.size(); ++k) ahead[k] = next[k] + momentum * (next[k] - light[k]);
    light = std::move(next);
    if (!course.note(difference)) return;
  }
}

void solve_by_mlem(const RingSystem& system, Rays b, Lights& light, Course& course) {
  RingSweep sweep;
  sweep_rings(sweep, system, {}, [](size_t, ColorLanes) { return all_colors(1); });
  const Lights weight = sweep.back;
  // Every ring begins with the same light, that which gives the picture's sum.
  ColorLanes seen{}, lengths{};
  for (const ColorLanes value : b) seen += not_negative(value);
  for (const ColorLanes value : weight) lengths += value;
  const ColorLanes even = ratio(seen, lengths);
  // Light that is 0 could never grow again.
  const ColorLanes brightness = sum_of_squares(light);
  const ColorLanes least = brightness > 0 ? even * 1e-3 : even;
  for (ColorLanes& value : light) value = value > least ? value : least;
  Lights difference(b.size());
  for (int i = 0; i < course.settings.iterations; ++i) {
    sweep_rings(sweep, system, light, [&](size_t ray, ColorLanes gathered) {
      difference[ray] = b[ray] - gathered;
      return ratio(not_negative(b[ray]), gathered);
    });
    for (size_t k = 0; k < light.size(); ++k) light[k] *= ratio(sweep.back[k], weight[k]);
    if (!course.note(difference)) return;
  }
}

// Runs some steps of conjugate gradients. Returns whether it is worth going on.
bool run_cgls(const RingSystem& system, Rays b, int steps, Lights& light, Course& course) {
  RingSweep sweep;
  Lights difference(b.size());
  sweep_difference(sweep, difference, system, b, light);
  Lights direction = sweep.back;
  ColorLanes slope = sum_of_squares(direction);
  for (int i = 0; i < steps; ++i) {
    const Lights ahead = gather_rays(system, direction);
    const ColorLanes step = ratio(slope, sum_of_squares(ahead));
    for (size_t k = 0; k < light.size(); ++k) light[k] += step * direction[k];
    for (size_t ray = 0; ray < b.size(); ++ray) difference[ray] -= step * ahead[ray];
    if (!course.note(difference)) return false;
    sweep_rings(sweep, system, {}, [&](size_t ray, ColorLanes) { return difference[ray]; });
    const ColorLanes flatter = sum_of_squares(sweep.back), turn = ratio(flatter, slope);
    for (size_t k = 0; k < light.size(); ++k) direction[k] = sweep.back[k] + turn * direction[k];
    slope = flatter;
  }
  return true;
}

}  // namespace

RingSolver ring_solver_of(const std::string& word) {
  if (word == "fista") return RingSolver::fista;
  if (word == "mlem") return RingSolver::mlem;
  if (word == "cgls") return RingSolver::restarted_cgls;
  if (word == "free-cgls") return RingSolver::cgls;
  throw LoadError("nebula", "solver", "is none of fista, mlem, cgls and free-cgls: " + word);
}

SolveResult solve_rings(const RingSystem& system, std::span<const ColorLanes> gathered,
                        const SolveSettings& settings, std::span<const ColorLanes> start) {
  if (gathered.size() != size_t(system.rays))
    throw LoadError("nebula", "rays", "are not as many as the picture has");
  SolveResult result;
  result.light.assign(size_t(system.grid.count()), ColorLanes{});
  if (start.size() == result.light.size()) result.light.assign(start.begin(), start.end());
  Course course{settings, sum_of_squares(gathered), {}};
  switch (settings.solver) {
    case RingSolver::fista: solve_by_fista(system, gathered, result.light, course); break;
    case RingSolver::mlem: solve_by_mlem(system, gathered, result.light, course); break;
    case RingSolver::cgls:
      run_cgls(system, gathered, settings.iterations, result.light, course);
      break;
    case RingSolver::restarted_cgls:
      for (int done = 0; done < settings.iterations;) {
        const int steps = std::min(std::max(1, settings.restart), settings.iterations - done);
        const bool goes_on = run_cgls(system, gathered, steps, result.light, course);
        for (ColorLanes& light : result.light) light = not_negative(light);
        done += steps;
        if (!goes_on) break;
      }
      break;
  }
  result.residual = std::move(course.residual);
  return result;
}

}  // namespace wellspring::volume
