// SPDX-License-Identifier: Apache-2.0
#include "show/scanner/scanned_place.h"

#include <filesystem>
#include <limits>

#include "base/clock.h"
#include "base/load_error.h"
#include "base/log.h"
#include "scan/tree/import/write_tree.h"
#include "show/scanner/scanner_source.h"

namespace wellspring::show {
namespace {

namespace fs = std::filesystem;

constexpr uint64_t most_kept = 3'000'000;     // points that are scanned when an exhibit is loaded
constexpr uint64_t most_in_memory = 300'000;  // likewise, if they cannot be kept
constexpr double seconds_between_lines = 5;   // until progress is logged again

TreeSettings settings_of_scans() {
  TreeSettings settings;
  settings.up = UpAxis::y;
  return settings;
}

// Tells progress in the log from time to time.
TreeProgress log_progress(const std::string& file) {
  return [file, told = seconds_now()](double share, const char* stage) mutable {
    if (seconds_now() < told + seconds_between_lines) return;
    told = seconds_now();
    log::info("{}: {} points, {:.0f} %", file, stage, 100 * share);
  };
}

// Returns the tree at that path; nothing if there is none that can be read.
std::optional<PointTree> find_tree(const fs::path& path) {
  std::error_code error;
  if (!fs::exists(path, error)) return {};
  try {
    return open_tree(path.string());
  } catch (const LoadError& wrong) {
    log::warn("{}", wrong.what());
    return {};
  }
}

// Removes what the scan's files were at other times.
void remove_others(const fs::path& kept) {
  const std::string name = kept.filename().string();
  const std::string stem = name.substr(0, name.rfind('-') + 1);
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(kept.parent_path(), error)) {
    const std::string other = entry.path().filename().string();
    if (other.starts_with(stem) && other.find('-', stem.size()) == std::string::npos &&
        other != name && other.ends_with(".points"))
      fs::remove(entry.path(), error);
  }
}

std::optional<PointTree> make_kept(const ScannerFile& scanner, const fs::path& path) {
  const double began = seconds_now();
  try {
    fs::create_directories(path.parent_path());
    log::info("{}: is scanned for the first time", scanner.file);
    const TreeReport report = write_tree(open_scanner(scanner, most_kept), path.string(),
                                         settings_of_scans(), log_progress(scanner.file));
    log::info("{}: {} points in {:.1f} s", scanner.file, report.points, seconds_now() - began);
    remove_others(path);
    return open_tree(path.string());
  } catch (const std::runtime_error& error) {
    log::warn("{}; the scan is made coarsely", error.what());
    return {};
  }
}

}  // namespace

ScannedPlace open_scanned_place(const ScannerFile& scanner, const std::string& cache) {
  const fs::path whole = fs::path(scanner.file).parent_path() /
                         scanned_name(scanner, std::numeric_limits<uint64_t>::max());
  const fs::path kept =
      cache.empty() ? fs::path() : fs::path(cache) / "scans" / scanned_name(scanner, most_kept);
  std::optional<PointTree> tree = find_tree(whole);
  if (!tree && !cache.empty()) tree = find_tree(kept);
  if (!tree && !cache.empty()) tree = make_kept(scanner, kept);
  if (!tree) tree = make_tree(open_scanner(scanner, most_in_memory), settings_of_scans());
  PointBounds box = scanned_bounds(scanner);
  box.low -= tree->origin, box.high -= tree->origin;
  return {*tree, box};
}

}  // namespace wellspring::show
