// SPDX-License-Identifier: Apache-2.0
// Makes a piece of an exhibit of a scanned volume.
#pragma once
#include <cstdint>
#include <string>

#include "base/layers.h"

namespace wellspring::program {

struct VolumeImport {
  std::string path;        // a file that open_volume() reads, or DICOM: a file or a folder
  std::string out = ".";   // folder for the volume
  int series = 0;          // the number in the list of DICOM, from 1; 0: that with most samples
  int64_t time = 0;        // which is checked, of a file that has several
  std::string preview;     // PNG of the volume in proposed presets; empty: none
  bool compress = false;   // as volume/compressed/compressed_volume.h has it
  bool bricks = false;     // as volume/bricks/brick_file.h has it, too; large ones always
  bool overwrite = false;  // replaces files that are there
};

// Turns DICOM into NIfTI by dcm2niix, reads the volume, puts it with its companions into `out`,
// and its bricks beside it if it is large, tells what it is on stderr, and prints a piece for
// exhibit.json. Throws LoadError.
void import_volume(const VolumeImport& import);

}  // namespace wellspring::program
