// SPDX-License-Identifier: Apache-2.0
// Tells formats of scanned volumes apart, and reads them.
#pragma once
#include <cstdint>
#include <string>

#include "volume/format/load_samples.h"
#include "volume/format/stored_volume.h"
#include "volume/volume.h"

namespace wellspring::volume {

struct VolumeChoice {
  int64_t time = 0;  // from 0, if a file has several volumes
  // If not empty, overrules the orientation of the file: the letters to which x, y and z run
  // (patient_frame.h); spacings stay, and the grid's centre becomes the origin.
  std::string axes = {};
  VolumeLimits limits = {};
};

// Reads a header: NIfTI-1 or -2 or Analyze (nifti.h), NRRD (nrrd.h), MetaImage (meta_image.h), SLC
// (slc.h), or the JSON that describes raw samples (raw_json.h), given as that file or as the raw
// one. Content decides, then the name. Throws LoadError that names file and place.
StoredVolume describe_volume(const std::string& path, const VolumeChoice& choice = {});

// Reads the volume (load_samples.h). Throws LoadError that names file and place.
Volume open_volume(const std::string& path, const VolumeChoice& choice = {});

}  // namespace wellspring::volume
