// SPDX-License-Identifier: Apache-2.0
// Pages of the reports on light.
#include "reports.h"

namespace wellspring::test {

ReportPage light_frame_page() {
  return {"light.frame",
          "How long does one frame of the Cornell box take? 640x480, one sample a pixel.",
          {},
          {{.caption = "",
            .rows = {{"technique", "technique"}},
            .columns = {{"frame_ms", "by the clock"},
                        {"frame_ms", "of all processors, ms", 1, "", "cpu_ms"}}}}};
}

ReportPage light_scaling_page() {
  return {"light.scaling",
          "How does the cost of a ray grow with the number of triangles? The same picture of the "
          "Cornell box, cut into ever more triangles; processor time.",
          {},
          {{.caption = "",
            .rows = {{"triangles", "triangles"}},
            .columns = {{"ray_ns", "a scattered ray"}, {"sample_ns", "a sample of path"}}},
           {.caption = "",
            .columns = {{"ns_per_doubling", "for each doubling"},
                        {"exponent", "time grows with this power of the triangles"}},
            .most_rows = 2}}};
}

// light.error, or a part of it.
ReportPage light_error_page(const std::string& name) {
  std::vector<PageTable> tables = {
      {.caption = "Time to FLIP 0.10",
       .rows = {{"scene", "scene"}, {"technique", "technique"}},
       .columns = {{"time_to_flip_ratio", "of path's time"},
                   {"time_to_flip_ratio", "of path's processor time", 1, "", "cpu_ratio"},
                   {"time_to_flip_ratio", "seconds", 1, "", "seconds"},
                   {"time_to_flip_ratio", "path's seconds", 1, "", "path_seconds"},
                   {"time_to_flip_ratio", "measured, not extrapolated", 1, "", "measured"}},
       .most_rows = 16},
      {.caption = "The references' own error",
       .rows = {{"scene", "scene"}},
       .columns = {{"light.reference.flip", "FLIP"},
                   {"light.reference.rmse", "RMSE, radiance"},
                   {"light.reference.flip", "samples a pixel", 1, "", "spp"}},
       .most_rows = 5},
      {.caption = "The diffuse hall: processor time of instant_radiosity to FLIP 0.10, over path's",
       .columns = {{"instant_radiosity_over_path", "ratio (wanted: 0.1 at most)"}},
       .most_rows = 1}};
  return {
      name,
      "How much error does each light technique leave after how much time? Pictures of 1, 2, 4 "
      "... samples a pixel against a long run of path, in five scenes.",
      {"FLIP of tone-mapped pictures at 67 pixels a degree. Plots are written beside the JSON."},
      tables};
}

ReportPage light_rays_page() {
  return {
      "light.rays",
      "How many rays a second does path trace, compared with Embree's own path tracer? Its Cornell "
      "box at 1280x720, both in turns.",
      {"Wanted: 0.8. Processor time is disturbed less by other work."},
      {{.caption = "",
        .columns = {
            {"light.path.rays_per_second", "ours, million a second", 1e-6, "1"},
            {"light.embree_pathtracer.rays_per_second", "theirs, million a second", 1e-6, "1"},
            {"rays_ratio", "ours over theirs, by the clock"},
            {"rays_ratio", "lowest of the turns", 1, "", "lowest"},
            {"rays_ratio", "highest of the turns", 1, "", "highest"},
            {"rays_processor_ratio", "ours over theirs, processor time"}}}}};
}

ReportPage light_cycles_page() {
  return {"light.cycles",
          "Is path as quick as Blender's Cycles, and does it find the same light? The same glTF in "
          "both; time until path's RMSE is that of Cycles.",
          {"Wanted: at most 1. Mean: our mean radiance over theirs, less 1.",
           "Blocks: differences over their standard error (1: nothing but noise).",
           "Neighbours: the correlation of neighbouring blocks (0: no structure)."},
          {{.caption = "",
            .rows = {{"scene", "scene"}},
            .columns = {{"cycles_time_ratio", "time over theirs"},
                        {"cycles_processor_ratio", "processor time over theirs"},
                        {"cycles_relative_mean", "mean", 100, "%"},
                        {"cycles_relative_mean", "its standard error", 100, "%", "standard_error"},
                        {"cycles_block_z", "blocks"},
                        {"cycles_block_correlation", "neighbours"}}}}};
}

ReportPage light_dynamic_page() {
  return {"light.dynamic",
          "What does the light of a torch cost that moves through the castle's hall? Pictures of "
          "1280x720, processor time of all cores.",
          {"FLIP of its light alone, direct and scattered once, against `path` of as many edges; "
           "flicker: second differences of scattered light from picture to picture, over it, while "
           "the torch moves 3 cm a picture."},
          {{.caption = "",
            .rows = {{"virtual_lights", "virtual lights"}, {"shadows", "shadows"}},
            .columns = {{"picture_ms", "a picture, ms"},
                        {"picture_ms", "by the clock", 1, "", "clock_ms"},
                        {"picture_ms", "surfaces", 1, "", "surfaces_ms"},
                        {"picture_ms", "direct", 1, "", "direct_ms"},
                        {"picture_ms", "shadow maps", 1, "", "maps_ms"},
                        {"picture_ms", "splatting", 1, "", "splat_ms"},
                        {"picture_ms", "putting over", 1, "", "put_ms"},
                        {"picture_ms", "FLIP", 1, "", "flip"},
                        {"picture_ms", "flicker", 1, "", "flicker"}},
            .most_rows = 12},
           {.caption = "Lights that stay as they are, by the passes that were averaged",
            .rows = {{"light", "light"}, {"passes", "passes"}},
            .columns = {{"settled_flip", "FLIP"}, {"settled_flip", "a pass, ms", 1, "", "pass_ms"}},
            .most_rows = 12}}};
}

ReportPage light_photons_page() {
  return {"light.photons",
          "What do caustic photons cost? Stored in grids and asked by every pixel.",
          {"Storing and asking: processor time of both over four cores."},
          {{.caption = "",
            .columns = {{"photons_ms", "storing and asking"},
                        {"photons_ms", "photons", 1, "", "photons"},
                        {"photons_ms", "storing, processor", 1, "ms", "store_cpu_ms"},
                        {"photons_ms", "asking, processor", 1, "ms", "query_cpu_ms"},
                        {"photons_ms", "pixels lit", 1, "", "pixels_lit"}}}}};
}

}  // namespace wellspring::test
