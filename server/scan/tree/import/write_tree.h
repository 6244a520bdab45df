// SPDX-License-Identifier: Apache-2.0
// Makes an octree of points (tree_format.h) of any number of files, in bounded memory, by counting
// points on a grid, distributing them to chunks, indexing chunks one by one on all cores, and
// merging the levels above (Schuetz, Ohrhallinger, Wimmer 2020, "Fast Out-of-Core Octree Generation
// for Massive Point Clouds", section 4). Other than there, inner nodes hold means of voxels, exact
// ones of all points beneath.
#pragma once
#include <string>
#include <vector>

#include "scan/tree/point_tree.h"
#include "scan/tree/tree_settings.h"

namespace wellspring::scan {

// Writes the file, which appears when it is whole. If this ends early, files beside it, in the
// folder NAME.work, let the next call with the same sources and settings go on: it reads no file
// again that was read to its end, and indexes no chunk again; the result has the same bytes. (A
// machine that loses power may lose a stage.) Throws LoadError: a source cannot be read, has no
// point, or nothing can be written; Cancelled, by the caller's token.
TreeReport write_tree(const std::vector<TreeSource>& sources, const std::string& path,
                      const TreeSettings& settings, const TreeProgress& progress = {});

// Makes a tree in memory, of a cloud that need not be imported: some millions of points, which take
// 120 bytes each while it is made, 18 afterwards. Throws as write_tree().
PointTree make_tree(const std::vector<TreeSource>& sources, const TreeSettings& settings);
inline PointTree make_tree(const TreeSource& source, const TreeSettings& settings) {
  return make_tree(std::vector{source}, settings);
}

}  // namespace wellspring::scan
