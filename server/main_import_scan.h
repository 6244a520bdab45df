// SPDX-License-Identifier: Apache-2.0
// Makes a piece of an exhibit of a scanned place or thing.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/layers.h"

namespace wellspring::program {

struct ScanImport {
  std::vector<std::string> files;  // all of one scan; open_scan() reads them
  std::optional<std::string> out;  // folder for the tree of points; without it the current one
  std::string name;                // the made file's, without .points; empty: the first's
  std::string up = "z";            // axis of the files that points up
  double unit = 0;                 // metres of a unit of the files; 0: as they say
  double turn = 0;                 // degrees, positive turns left
  int memory = 1024;               // MiB
  bool overwrite = false;          // replaces a file that is there
};

// Puts the points of all files into one tree (scan/tree/tree_format.h) in `out`, tells what it is
// on stderr, and prints a piece for exhibit.json. An import that was broken off goes on. A
// .scanner.json is scanned whole, to a tree beside it. Throws LoadError.
void import_scan(const ScanImport& import);

}  // namespace wellspring::program
