// SPDX-License-Identifier: Apache-2.0
#include "scan/tree/import/write_tree.h"

#include <filesystem>

#include "base/load_error.h"
#include "scan/tree/import/run_import.h"

namespace wellspring::scan {

TreeReport write_tree(const std::vector<TreeSource>& sources, const std::string& path,
                      const TreeSettings& settings, const TreeProgress& progress) {
  namespace fs = std::filesystem;
  const WorkPlace place(path + ".work");
  std::error_code error;
  fs::create_directories(path + ".work", error);
  if (error) throw LoadError(path, "", "cannot be written: " + error.message());
  const DataFile lock = place.open("lock");
  if (!lock.lock()) throw LoadError(path, "", "is being written by another process");
  TreeReport report;
  import_points(sources, place, settings, progress, report).sync();
  fs::rename(place.path("tree"), path, error);
  if (error) throw LoadError(path, "", "cannot be written: " + error.message());
  fs::remove_all(path + ".work", error);
  return report;
}

PointTree make_tree(const std::vector<TreeSource>& sources, const TreeSettings& settings) {
  TreeReport report;
  return map_tree(sources.at(0).file, import_points(sources, WorkPlace(""), settings, {}, report));
}

}  // namespace wellspring::scan
