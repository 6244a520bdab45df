// SPDX-License-Identifier: Apache-2.0
// Renders by Blender's Cycles, as a child process that is ended when it takes too long.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "frame/frame.h"
#include "world/view.h"

namespace wellspring::test {

struct CyclesRender {
  int samples = 1;
  uint32_t seed = 1;
  Frame frame;  // out
  // Out: sampling alone, by the clock and of all its threads together; scene, BVH and textures were
  // ready before.
  double seconds = 0, processor_seconds = 0;
};

// True where a `blender` can be found on the PATH.
bool has_blender();
// `script`: tests/benchmark/cycles/render.py; `scene`: a glTF file; `folder`: for what passes
// between the processes. Throws std::runtime_error with the end of Blender's output when it fails
// or exceeds the time.
void render_by_cycles(const std::filesystem::path& script, const std::filesystem::path& scene,
                      const View& view, int max_depth, int threads,
                      const std::filesystem::path& folder, double timeout_seconds,
                      std::vector<CyclesRender>& renders);

// A copy of a .glb whose materials are what both renderers can express, so that light transport is
// compared and not two models of gloss: Lambertian, thin clear glass, emitters and, if `metals`,
// bare metal as far as it is not rougher than `roughest_shared_metal`; beyond, light between facets
// counts, which the two treat differently. Throws LoadError.
inline constexpr double roughest_shared_metal = 0.35;
void write_shared_copy(const std::filesystem::path& glb, bool metals,
                       const std::filesystem::path& out);

}  // namespace wellspring::test
