// SPDX-License-Identifier: Apache-2.0
#include "light_reference.h"

#include "base/clock.h"
#include "base/rng.h"
#include "judge/compare.h"
#include "judge/flip.h"

namespace wellspring::test {

Reference make_reference(const World& world, const Lights& lights, const View& view,
                         const TransportSettings& transport, double seconds) {
  const Technique& path = *find_technique("path");
  Frame half[2];
  std::vector<dvec3> sum[2];
  int spp[2] = {0, 0};
  double began = seconds_now();
  StillSettings settings;
  settings.transport = transport;
  settings.spp = 8;
  // Pieces grow, so that each is a well spread set of samples, and the two halves stay as large.
  for (int piece = 0; piece < 2 || seconds_now() - began < seconds; piece += 2) {
    double start = seconds_now();
    for (int h = 0; h < 2; h++) {
      // Hashed: seeds that differ in a few bits give neighbouring rows each other's samples.
      settings.seed = mix64(0x7265666572656e63ull + uint64_t(piece + h));
      half[h] = render_still(path, world, lights, view, settings);
      sum[h].resize(half[h].color.size(), dvec3(0));
      for (size_t i = 0; i < sum[h].size(); i++)
        sum[h][i] += dvec3(half[h].color[i]) * double(settings.spp);
      spp[h] += settings.spp;
    }
    double spent = seconds_now() - start, left = seconds - (seconds_now() - began);
    if (settings.spp < 512 && 2 * spent < left) settings.spp *= 2;
    else if (spent > left) settings.spp = int(settings.spp * left / spent);
    if (settings.spp < 4) break;
  }
  Reference reference;
  reference.frame = half[0];
  for (size_t i = 0; i < sum[0].size(); i++) {
    reference.frame.color[i] = vec3((sum[0][i] + sum[1][i]) / double(spp[0] + spp[1]));
    for (int h = 0; h < 2; h++) half[h].color[i] = vec3(sum[h][i] / double(spp[h]));
  }
  reference.seconds = seconds_now() - began;
  reference.spp = spp[0] + spp[1];
  // Halves of variance v each differ by variance 2v; their mean has v/2.
  reference.rmse = rmse(half[0], half[1]) / 2;
  reference.relative_mse = relative_mse(half[0], half[1]) / 4;
  reference.flip = flip(half[0], half[1]) / std::sqrt(2.0);
  return reference;
}

}  // namespace wellspring::test
