// SPDX-License-Identifier: Apache-2.0
#include "volume/format/open_volume.h"

#include <filesystem>
#include <fmt/format.h>
#include <string_view>

#include "base/load_error.h"
#include "volume/format/byte_stream.h"
#include "volume/format/header_text.h"
#include "volume/format/meta_image.h"
#include "volume/format/nifti.h"
#include "volume/format/nrrd.h"
#include "volume/format/patient_frame.h"
#include "volume/format/raw_json.h"
#include "volume/format/slc.h"

namespace wellspring::volume {
namespace {

namespace fs = std::filesystem;
using namespace std::string_view_literals;

// Names a format that is known and not read; empty: it is not known.
std::string_view foreign_volume(std::string_view bytes) {
  if (bytes.starts_with("\x89HDF")) return "HDF5";
  if (bytes.starts_with("CDF\x01") || bytes.starts_with("CDF\x02")) return "NetCDF";
  if (bytes.starts_with("# vtk") || bytes.starts_with("<VTKFile")) return "VTK";
  if (bytes.starts_with("II*\0"sv) || bytes.starts_with("MM\0*"sv)) return "TIFF";
  if (bytes.starts_with("\0\0\0\x01\0\0"sv)) return "MGH";
  if (bytes.starts_with("\x28\xb5\x2f\xfd")) return "Zstandard";
  if (bytes.starts_with("BZh")) return "bzip2";
  return {};
}

StoredVolume read_header(const std::string& path, const VolumeChoice& choice) {
  constexpr const char* about_dicom =
      "is DICOM; `wellspring import volume` turns a folder of it into NIfTI";
  std::error_code error;
  if (fs::is_directory(path, error))
    throw LoadError(path, "", "is a folder; `wellspring import volume` reads folders of DICOM");
  if (!fs::exists(path, error)) throw LoadError(path, "", "is not there");
  const std::string bytes = first_bytes(path, 512);
  if (bytes.empty()) throw LoadError(path, "", "is empty");
  if (bytes.starts_with("NRRD000")) return read_nrrd_header(path, choice.time);
  if (is_nifti(bytes)) return read_nifti_header(path);
  if (bytes.starts_with("11111\n")) return read_slc_header(path);
  if (bytes.size() > 132 && bytes.compare(128, 4, "DICM") == 0)
    throw LoadError(path, "", about_dicom);
  const std::string name = in_small_letters(path);
  const auto is_named = [&](std::initializer_list<const char*> ends) {
    for (const char* end : ends)
      if (name.ends_with(end)) return true;
    return false;
  };
  if (is_meta_image(bytes) || is_named({".mhd", ".mha"})) return read_meta_header(path);
  if (is_named({".nii", ".nii.gz", ".hdr", ".hdr.gz", ".img", ".img.gz"}))
    return read_nifti_header(path);
  if (is_named({".json"})) return read_raw_json(path);
  if (is_named({".dcm"})) throw LoadError(path, "", about_dicom);
  if (const std::string json = find_raw_json(path); !json.empty()) return read_raw_json(json);
  if (const std::string_view format = foreign_volume(bytes); !format.empty())
    throw LoadError(path, "",
                    fmt::format("is {}, which is not read as a volume; turn it into "
                                "NIfTI or NRRD first",
                                format));
  throw LoadError(path, "",
                  "is no volume that is known: NIfTI, Analyze, NRRD, MetaImage, SLC, or raw "
                  "samples with a .json beside them");
}

}  // namespace

StoredVolume describe_volume(const std::string& path, const VolumeChoice& choice) {
  StoredVolume stored = read_header(path, choice);
  if (choice.axes.empty()) return stored;
  if (!are_axes(choice.axes))
    throw LoadError(path, "",
                    fmt::format("cannot have the axes '{}': they are one letter each of "
                                "LR, AP and SI",
                                choice.axes));
  glm::dvec3 spacing;
  for (int i = 0; i < 3; i++) spacing[i] = glm::length(glm::dvec3(stored.to_metres[i]));
  const glm::dvec3 center = spacing * glm::dvec3(stored.size - 1) / 2.0;
  set_place(stored, affine_of(spacing, -center), choice.axes, 1, "axes");
  stored.is_placed = true;
  return stored;
}

Volume open_volume(const std::string& path, const VolumeChoice& choice) {
  const StoredVolume stored = describe_volume(path, choice);
  const bool is_list = stored.channels == 1 && stored.components > 1;
  return load_samples(stored, is_list ? 0 : choice.time, choice.limits);
}

}  // namespace wellspring::volume
