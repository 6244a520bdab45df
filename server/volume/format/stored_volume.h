// SPDX-License-Identifier: Apache-2.0
// Describes where the samples of a scanned volume lie in files, and how. Readers of formats make
// it of a header alone; load_samples.h fetches the samples.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "volume/volume.h"

namespace wellspring::volume {

// The first eight are those of SampleKind; the others become f64.
enum class Number : uint8_t { u8, i8, u16, i16, u32, i32, f32, f64, u64, i64 };
int bytes_of(Number number);

enum class Packing : uint8_t { none, deflate, slc };  // deflate: as gzip or as zlib

// One file's share of the samples: they begin at byte `begin` of the file, or after `skip` more
// bytes that are unpacked.
struct StoredPart {
  std::string file;
  uint64_t begin = 0, skip = 0;
};

struct StoredVolume {
  std::string file;    // as the caller gave it, for errors
  std::string format;  // its name, for people
  glm::ivec3 size{1};
  int64_t times = 1;  // volumes that lie one after the other
  Number number = Number::u8;
  bool is_swapped = false;  // not in this machine's byte order
  // Each sample has so many numbers side by side, of which `channels` are taken from `first` on.
  int components = 1, first = 0, channels = 1;
  double slope = 1, intercept = 0;
  glm::dmat4 to_metres{1};
  bool is_placed = false;  // the file states an orientation
  Packing packing = Packing::none;
  std::vector<StoredPart> parts;  // in order, all shares are equal

  bool is_direct() const { return number < Number::u64 && components == channels; }
  // Bytes of one time as they are stored; sizes must be checked.
  uint64_t stored_bytes() const {
    return uint64_t(size.x) * uint64_t(size.y) * uint64_t(size.z) * uint64_t(components) *
           uint64_t(bytes_of(number));
  }
};

inline constexpr int64_t longest_volume = int64_t(1) << 20;       // samples along an axis
inline constexpr uint64_t most_volume_bytes = uint64_t(1) << 36;  // a time has at most so many

// Sets the size. Throws LoadError if an axis is not 1 to longest_volume, or one time has more than
// most_volume_bytes; numbers and components must be set before.
void set_size(StoredVolume& stored, int64_t x, int64_t y, int64_t z, const std::string& where);
// Sets the number of times; throws LoadError if they are not 1 or more, or beyond all reason.
void set_times(StoredVolume& stored, int64_t times, const std::string& where);

// Gives an axis of one sample that has no spacing the largest of the others, or 1. Throws LoadError
// if a longer axis has none: zero, infinite or no number. Call after set_size().
void complete_spacing(const StoredVolume& stored, glm::dvec3& spacing, const std::string& where);

// Sets to_metres from an affine that leads from index to a space of these axes in a unit of so many
// metres. Throws LoadError if it is singular or has numbers that are not finite.
void set_place(StoredVolume& stored, const glm::dmat4& to_space, const std::string& axes,
               double unit, const std::string& where);
// Says whether set_place() would take it.
bool is_regular(const glm::dmat4& to_space);
// Makes an affine of spacings along the axes, and of the first sample's place.
glm::dmat4 affine_of(glm::dvec3 spacing, glm::dvec3 origin);

// Returns the header's file and those of its samples, each once.
std::vector<std::string> files_of(const StoredVolume& stored);

}  // namespace wellspring::volume
