// SPDX-License-Identifier: Apache-2.0
// Multiresolution splatting (light/virtual): its time, its error and its flicker.
#pragma once
#include "light/virtual/splatter.h"
#include "light/technique/technique.h"
#include "markdown_page.h"
#include "report.h"

namespace wellspring::test {

void bench_splat(BenchReport& report, const BenchOptions& options);
ReportPage splat_page();
// Error, choice of virtual lights, flicker.
void bench_splat_error(BenchReport& report, const BenchOptions& options);
ReportPage splat_error_page();

// Holds what every pixel of a view sees, by rays.
struct SeenPixels {
  View view;
  std::vector<float> depth, nx, ny, nz;
  SeenPixels(const World& world, const Lights& lights, const View& view);
  SplatPixels pixels() const;
};
// A bulb that is carried: `step` two centimetres further each.
SplatSource carried_torch(const View& view, int step);
double processor_seconds();  // all threads together

}  // namespace wellspring::test
