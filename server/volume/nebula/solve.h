// SPDX-License-Identifier: Apache-2.0
// Finds the light of rings from what rays gather: A x = b, for three channels at once (Wenger and
// others, section 4.2).
#pragma once
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "volume/nebula/rings.h"

namespace wellspring::volume {

enum class RingSolver : uint8_t {
  // Fast projected gradient (Beck and Teboulle 2009) with a step for each ring and a restart when
  // it climbs (O'Donoghue and Candes 2015): least squares, never negative.
  fista,
  // x *= A^T (b / A x) / A^T 1 (Shepp and Vardi 1982): the likeliest x for counted light.
  mlem,
  // Conjugate gradients for least squares, negative light cut off and begun anew every some steps.
  // Cutting off at every step, as the paper has it, ruins the conjugate directions: it gets stuck.
  restarted_cgls,
  // The same without a bound. Light may come out negative.
  cgls,
};
// Reads "fista", "mlem", "cgls" (with restarts) or "free-cgls". Throws LoadError for other words.
RingSolver ring_solver_of(const std::string& word);

struct SolveSettings {
  RingSolver solver = RingSolver::fista;
  int iterations = 40;
  int restart = 20;       // steps of restarted_cgls from one cut to the next
  double least_gain = 0;  // stops when no channel's residual fell by this part in five steps
};

struct SolveResult {
  std::vector<ColorLanes> light;  // for each ring
  // The norm of b - A x by that of b for each iteration and channel, 0 if b is 0: after its step
  // for conjugate gradients, before it for fista (where momentum has carried x) and mlem.
  std::vector<glm::dvec3> residual;
};

// Solves for the light. gathered: b, never negative for mlem; start: light to begin with, of the
// grid's size, or empty. Only cgls returns negative light. The result is the same on any number of
// cores.
SolveResult solve_rings(const RingSystem& system, std::span<const ColorLanes> gathered,
                        const SolveSettings& settings, std::span<const ColorLanes> start = {});

}  // namespace wellspring::volume
