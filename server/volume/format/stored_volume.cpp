// SPDX-License-Identifier: Apache-2.0
#include "volume/format/stored_volume.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/load_error.h"
#include "volume/format/patient_frame.h"

namespace wellspring::volume {

int bytes_of(Number number) { return number < Number::u64 ? bytes_of(SampleKind(number)) : 8; }

void set_size(StoredVolume& stored, int64_t x, int64_t y, int64_t z, const std::string& where) {
  for (const int64_t length : {x, y, z})
    if (length < 1 || length > longest_volume)
      throw LoadError(
          stored.file, where,
          fmt::format("says {} samples along an axis; 1 to {} are read", length, longest_volume));
  if (stored.components < 1 || stored.components > longest_volume)
    throw LoadError(stored.file, where, "has no sensible number of channels");
  const double bytes = double(x) * double(y) * double(z) * double(stored.components) *
                       double(bytes_of(stored.number));
  if (bytes > double(most_volume_bytes))
    throw LoadError(stored.file, where,
                    fmt::format("says {} x {} x {} samples, {:.0f} GiB; at most {} GiB are read", x,
                                y, z, bytes / 0x1p30, most_volume_bytes >> 30));
  stored.size = {int(x), int(y), int(z)};
}

void set_times(StoredVolume& stored, int64_t times, const std::string& where) {
  if (times < 1 || times > longest_volume)
    throw LoadError(stored.file, where,
                    fmt::format("says {} times; 1 to {} are read", times, longest_volume));
  stored.times = times;
}

void complete_spacing(const StoredVolume& stored, glm::dvec3& spacing, const std::string& where) {
  const auto is_good = [&](int i) { return std::isfinite(spacing[i]) && spacing[i] != 0; };
  double largest = 0;
  for (int i = 0; i < 3; i++) {
    if (is_good(i)) largest = std::max(largest, std::abs(spacing[i]));
    else if (stored.size[i] > 1)
      throw LoadError(stored.file, where,
                      fmt::format("has the spacing {} along axis {}, which has {} samples",
                                  spacing[i], "xyz"[i], stored.size[i]));
  }
  for (int i = 0; i < 3; i++)
    if (!is_good(i)) spacing[i] = largest > 0 ? largest : 1;
}

bool is_regular(const glm::dmat4& to_space) {
  double product = 1;
  for (int column = 0; column < 4; column++) {
    for (int row = 0; row < 3; row++)
      if (!(std::abs(to_space[column][row]) <= 1e12)) return false;
    if (column < 3) product *= glm::length(glm::dvec3(to_space[column]));
  }
  return product > 1e-30 && std::abs(glm::determinant(glm::dmat3(to_space))) > 1e-6 * product;
}

void set_place(StoredVolume& stored, const glm::dmat4& to_space, const std::string& axes,
               double unit, const std::string& where) {
  if (!is_regular(to_space))
    throw LoadError(stored.file, where,
                    "the affine is singular, or has numbers that are not finite");
  stored.to_metres = to_patient_frame(axes) * to_space;
  for (int column = 0; column < 4; column++)
    for (int row = 0; row < 3; row++) stored.to_metres[column][row] *= unit;
  stored.to_metres[0][3] = stored.to_metres[1][3] = stored.to_metres[2][3] = 0;
  stored.to_metres[3][3] = 1;
}

glm::dmat4 affine_of(glm::dvec3 spacing, glm::dvec3 origin) {
  glm::dmat4 affine(1);
  for (int i = 0; i < 3; i++) affine[i][i] = spacing[i];
  affine[3] = glm::dvec4(origin, 1);
  return affine;
}

std::vector<std::string> files_of(const StoredVolume& stored) {
  std::vector<std::string> files{stored.file};
  for (const StoredPart& part : stored.parts)
    if (std::ranges::find(files, part.file) == files.end()) files.push_back(part.file);
  return files;
}

}  // namespace wellspring::volume
