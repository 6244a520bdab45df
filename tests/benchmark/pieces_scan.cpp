// SPDX-License-Identifier: Apache-2.0
// pieces.scan: what a picture of a scanned place costs by the number of its points, and how much it
// differs from one that shows all of them; what of it tears if points are unevenly spread; how
// quickly a scan is imported.
#include <algorithm>
#include <cmath>

#include "base/clock.h"
#include "judge/flip.h"
#include "made_site.h"
#include "own_folder.h"
#include "report.h"
#include "reports.h"
#include "scan/draw/draw_points.h"
#include "scan/draw/fill_holes.h"
#include "scan/draw/point_colors.h"
#include "scan/tree/choose_nodes.h"
#include "scan/tree/point_tree.h"
#include "scan/tree/import/write_tree.h"

namespace wellspring::test {
namespace {

ScanCamera view_of(const PointTree& tree) {
  ScanCamera view = made_site_view();
  view.eye -= tree.origin;
  return view;
}

Frame frame_of(const PointBuffer& buffer) {
  Frame frame;
  fit_frame(buffer.width, buffer.height, frame);
  for (size_t i = 0; i < frame.color.size(); i++)
    frame.color[i] = std::isfinite(buffer.depth[i]) ? captured_color(buffer.color[i]) : vec3(0.1f);
  return frame;
}

struct Drawn {
  PointBuffer buffer;
  double ms = 0;
  size_t points = 0;
};

Drawn draw(PointRaster& raster, const PointTree& tree, const ChooseSettings& choose, bool blended,
           int times) {
  Drawn drawn;
  drawn.ms = INFINITY;
  const ScanCamera view = view_of(tree);
  for (int i = 0; i < times; i++) {
    const double began = seconds_now();
    std::vector<NodePoints> nodes;
    for (const ChosenNode& one : choose_nodes(tree, view, choose).nodes)
      nodes.push_back(tree.points_of(one.node));
    raster.draw(drawn.buffer, nodes, view, {.blended = blended});
    fill_holes(drawn.buffer, nodes, view);
    drawn.ms = std::min(drawn.ms, 1000 * (seconds_now() - began));
    drawn.points = 0;
    for (const NodePoints& one : nodes) drawn.points += one.count;
  }
  return drawn;
}

// Returns the share of pixels that see through a surface that `whole` has, or nothing of it.
double torn_share(const PointBuffer& buffer, const PointBuffer& whole) {
  constexpr float through = 1.05f;  // times the surface's depth
  size_t covered = 0, torn = 0;
  for (size_t i = 0; i < whole.depth.size(); i++) {
    if (!std::isfinite(whole.depth[i])) continue;
    covered++;
    torn += !(buffer.depth[i] < through * whole.depth[i]);
  }
  return double(torn) / double(covered);
}

// Measures a scan by two stations of a tenth of the points, as pictures in motion and at rest show
// it, against the whole one.
void bench_uneven(BenchReport& report, uint64_t points, const std::string& file,
                  PointRaster& raster, const PointBuffer& whole, int times) {
  TreeSettings settings;
  settings.up = UpAxis::y;
  write_tree({{"made", [points] { return made_site(points / 10, SiteScan::stations); }}}, file,
             settings);
  const PointTree tree = open_tree(file);
  for (const bool blended : {false, true}) {
    const Drawn drawn =
        draw(raster, tree, {.budget = blended ? 2'500'000u : 1'000'000u}, blended, times);
    const nlohmann::json where = {{"discs", blended ? "blended" : "nearest"}};
    report.add("pieces.scan.uneven_points", double(drawn.points) / 1e6, "M", where);
    report.add("pieces.scan.uneven_ms", drawn.ms, "ms", where);
    report.add("pieces.scan.uneven_torn", 100 * torn_share(drawn.buffer, whole), "%", where);
    report.add("pieces.scan.uneven_flip", flip(frame_of(drawn.buffer), frame_of(whole)), "", where);
  }
}

}  // namespace

void bench_pieces_scan(BenchReport& report, const BenchOptions& options) {
  const uint64_t points = options.quick ? 5'000'000 : 30'000'000;
  const OwnFolder folder;
  const std::string file = folder.path() + "/site.points";
  TreeSettings settings;
  settings.up = UpAxis::y;
  const double began = seconds_now(), cores = process_seconds_now();
  const TreeReport made =
      write_tree({{"made", [points] { return made_site(points); }}}, file, settings);
  const double millions = double(points) / 1e6;
  report.add("pieces.scan.import_core_mps", millions / (process_seconds_now() - cores),
             "M points/s", {});
  report.add("pieces.scan.import_seconds", seconds_now() - began, "s", {});
  report.add("pieces.scan.bytes_per_point", double(made.bytes) / double(made.points), "B", {});
  const double opening = seconds_now();
  const PointTree tree = open_tree(file);
  PointRaster raster;
  const Drawn first = draw(raster, tree, {.budget = 1'000'000}, false, 1);
  report.add("pieces.scan.first_picture_ms", 1000 * (seconds_now() - opening), "ms", {});
  const Drawn all = draw(raster, tree, {.pixels = 0, .budget = SIZE_MAX}, true, 1);
  const Frame reference = frame_of(all.buffer);
  const int times = options.quick ? 3 : 7;
  for (const bool blended : {false, true})
    for (const size_t budget : {250'000u, 500'000u, 1'000'000u, 2'500'000u}) {
      const Drawn drawn = draw(raster, tree, {.budget = budget}, blended, times);
      const nlohmann::json where = {{"discs", blended ? "blended" : "nearest"},
                                    {"budget", double(budget) / 1e6}};
      report.add("pieces.scan.points", double(drawn.points) / 1e6, "M", where);
      report.add("pieces.scan.gbuffer_ms", drawn.ms, "ms", where);
      report.add("pieces.scan.flip", flip(frame_of(drawn.buffer), reference), "", where);
    }
  bench_uneven(report, points, folder.path() + "/uneven.points", raster, all.buffer, times);
}

ReportPage pieces_scan_page() {
  return {
      "pieces.scan",
      "What does a picture of a scanned place cost by the number of its points, and how much does "
      "it lack?",
      {"A made hall of 30 million points (5 in a quick run), seen from a corner at 1280 x 720: "
       "nodes are chosen, discs drawn, holes closed, on all cores. FLIP is against a picture of "
       "all points, blended.",
       "Pictures in motion show up to a million points, the nearest disc in each pixel; those at "
       "rest 2.5 million, blended."},
      {{.caption = "Pictures",
        .rows = {{"discs", "discs"}, {"budget", "points at most, millions"}},
        .columns = {{"pieces.scan.points", "points", 1, "M"},
                    {"pieces.scan.gbuffer_ms", "a picture", 1, "ms"},
                    {"pieces.scan.flip", "FLIP", 1, ""}},
        .most_rows = 8},
       {.caption = "A tenth of the points, scanned from two stations",
        .rows = {{"discs", "discs"}},
        .columns = {{"pieces.scan.uneven_points", "points", 1, "M"},
                    {"pieces.scan.uneven_ms", "a picture", 1, "ms"},
                    {"pieces.scan.uneven_torn", "torn pixels", 1, "%"},
                    {"pieces.scan.uneven_flip", "FLIP", 1, ""}},
        .most_rows = 2},
       {.caption = "Import, and the first picture after opening",
        .columns = {{"pieces.scan.import_core_mps", "a core", 1, "M points/s"},
                    {"pieces.scan.import_seconds", "all", 1, "s"},
                    {"pieces.scan.bytes_per_point", "on the disk, a point", 1, "B"},
                    {"pieces.scan.first_picture_ms", "first picture", 1, "ms"}},
        .most_rows = 4}}};
}

}  // namespace wellspring::test
