// SPDX-License-Identifier: Apache-2.0
// Makes a file of bricks (brick_file.h) of a volume.
#pragma once
#include <functional>
#include <string>

#include "volume/volume.h"

namespace wellspring::volume {

// Goes through the volume twice, slice by slice: in memory are about 100 bytes for each sample of a
// slice, and a brick for each core. Takes a volume as make_shown_volume() does, of any number of
// samples. Nobody finds half of the file. `tell` is told from time to time which share is done, on
// the calling thread. Throws LoadError if the file cannot be written.
void write_bricks(const Volume& volume, const std::string& path,
                  const std::function<void(double)>& tell = {});

}  // namespace wellspring::volume
