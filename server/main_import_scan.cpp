// SPDX-License-Identifier: Apache-2.0
#include "main_import_scan.h"

#include <filesystem>
#include <fmt/format.h>
#include <iostream>
#include <nlohmann/json.hpp>

#include "base/clock.h"
#include "base/load_error.h"
#include "base/log.h"
#include "scan/format/open_scan.h"
#include "scan/tree/coarse_cut.h"
#include "scan/tree/import/write_tree.h"
#include "show/scanner/scanner_source.h"

namespace wellspring::program {
namespace {

namespace fs = std::filesystem;

constexpr size_t most_looked_at = 100'000;  // points

// Returns a name of a piece: small letters, digits and hyphens.
std::string id_of(const fs::path& file) {
  std::string id;
  for (const unsigned char c : file.stem().string())
    if (std::isalnum(c)) id += char(std::tolower(c));
    else if (!id.empty() && id.back() != '-') id += '-';
  while (id.ends_with('-')) id.pop_back();
  return id.empty() ? "scan" : id;
}

void tell(const fs::path& made, const TreeReport& report, double seconds) {
  const PointTree tree = open_tree(made.string());
  const PointBounds box = bounds_of(coarse_cut(tree, most_looked_at));
  const dvec3 size = box.high - box.low;
  std::cerr << fmt::format(
      "{}: {} points in {} nodes, {} MB, {:.0f} s\n  {:.2f} m wide, {:.2f} m high, {:.2f} m deep; "
      "its origin is {:.3f}, {:.3f}, {:.3f}\n",
      made.string(), report.points, report.nodes, report.bytes / 1'000'000, seconds, size.x, size.y,
      size.z, tree.origin.x, tree.origin.y, tree.origin.z);
  if (report.dropped > 0)
    std::cerr << fmt::format("  {} points were left out: their places are no numbers, or too far\n",
                             report.dropped);
  for (const std::string& notice : report.notices) std::cerr << "  " << notice << "\n";
}

void make(const ScanImport& import, const std::vector<TreeSource>& sources, const fs::path& made,
          UpAxis up) {
  if (fs::exists(made) && !import.overwrite)
    throw LoadError(made.string(), "", "is there already; --overwrite replaces it");
  if (!made.parent_path().empty()) fs::create_directories(made.parent_path());
  TreeSettings settings;
  settings.unit = import.unit;
  settings.up = up;
  settings.turn = glm::radians(import.turn);
  settings.memory = uint64_t(import.memory) << 20;
  const double began = seconds_now();
  Progress progress("import");
  const TreeReport report =
      write_tree(sources, made.string(), settings,
                 [&](double share, const char* stage) { progress.tell(share, stage); });
  progress.clear();
  tell(made, report, seconds_now() - began);
}

void print_piece(const std::string& id, const fs::path& source) {
  nlohmann::ordered_json piece;
  piece["id"] = id, piece["kind"] = "scan";
  piece["source"] = source.filename().string();
  piece["place"] = {{"position", {0, 0, 0}}, {"yaw_deg", 0}};
  std::cout << piece.dump() << "\n";
}

// Scans a scene with all its points. The tree lies beside the description, where an exhibit that
// names that finds it.
void import_scanner(const ScanImport& import) {
  const fs::path file = import.files.front();
  if (import.files.size() > 1)
    throw LoadError(import.files[1], "", "is no part of a scanner's scan");
  if (import.unit != 0 || import.turn != 0)
    throw LoadError(file.string(), "", "is in metres and lies as its scene does");
  std::vector<Problem> problems;
  const ScannerFile scanner = read_scanner_file(file.string(), problems);
  for (const Problem& problem : problems)
    if (problem.fatal) throw LoadError(problem.file, problem.where, problem.what);
  const fs::path folder = import.out.value_or(file.parent_path().string());
  make(import, open_scanner(scanner, scanner.points),
       folder / scanned_name(scanner, scanner.points), UpAxis::y);
  print_piece(id_of(file.stem()), file);
}

}  // namespace

void import_scan(const ScanImport& import) {
  if (import.files.front().ends_with(scanner_ending)) return import_scanner(import);
  const std::string id = id_of(import.name.empty() ? import.files.front() : import.name);
  const fs::path made = fs::path(import.out.value_or(".")) / (id + ".points");
  std::vector<TreeSource> sources;
  for (const std::string& file : import.files)
    sources.push_back({file, [file] { return open_scan(file); }});
  make(import, sources, made, up_axis_of(import.up));
  print_piece(id, made);
}

}  // namespace wellspring::program
