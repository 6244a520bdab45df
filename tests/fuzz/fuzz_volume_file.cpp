// SPDX-License-Identifier: Apache-2.0
// Files of scanned volumes. The first byte chooses the file's name; samples of headers that name
// another file lie beside it.
#include "fuzz/fuzz.h"
#include "volume/format/open_volume.h"
#include "volume/format/patient_frame.h"

namespace wellspring::fuzz {
namespace {

constexpr const char* volume_names[] = {"volume.nii",  "volume.nii.gz", "volume.hdr",
                                        "volume.nrrd", "volume.nhdr",   "volume.mha",
                                        "volume.mhd",  "volume.slc",    "volume.json"};

void write_samples_beside() {
  std::string samples(4096, '\0');
  for (size_t i = 0; i < samples.size(); i++) samples[i] = char(i * 37 >> 3);
  for (const char* name : {"volume.img", "volume.raw", "volume.1", "volume.2"})
    folder().write(name, samples);
}

}  // namespace

void fuzz_volume_file(Bytes bytes) {
  static const bool is_written = (write_samples_beside(), true);
  if (!is_written || bytes.empty()) return;
  const std::string file =
      write_file(volume_names[bytes[0] % std::size(volume_names)], bytes.subspan(1));
  load([&] {
    VolumeChoice choice;
    choice.limits.memory = 1 << 20, choice.limits.mapped_from = 1 << 10;
    const Volume volume = open_volume(file, choice);
    require(volume.size.x >= 1 && volume.size.y >= 1 && volume.size.z >= 1, "a volume has a size");
    require(volume.channels == 1 || volume.channels == 3, "a sample is a number or a colour");
    require(glm::determinant(glm::dmat3(volume.to_metres)) != 0, "the place is not singular");
    require(are_axes(axes_of(volume.to_metres)), "axes run somewhere");
    const glm::ivec3 last = volume.size - 1;
    volume.at(0, 0, 0);
    volume.at(last.x, last.y, last.z, volume.channels - 1);
  });
  std::error_code error;
  std::filesystem::remove(file, error);
}

}  // namespace wellspring::fuzz
