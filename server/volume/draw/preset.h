// SPDX-License-Identifier: Apache-2.0
// Presets: which values of a volume are seen, in which colour, and how densely. A preset is data,
// and says it in the volume's own unit; a TransferTable is made of it for drawing.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "base/simd.h"
#include "base/vec.h"
#include "volume/draw/shown_volume.h"

namespace wellspring::volume {

enum class VolumeMode : uint8_t {
  density,  // light that is sent on and absorbed, all along the ray
  surface,  // the first place whose value is that of the first point
  maximum,  // the largest value along the ray
  glow,     // light that is sent, all along the ray; nothing is absorbed
};

// Between points, colour and density are mixed; before the first and behind the last they stay. Two
// points of one value make an edge.
struct PresetPoint {
  double value = 0;  // in the volume's unit
  vec3 color{1};     // linear
  // Extinction per millimetre; of `maximum`: opacity, 0 to 1; of `glow`: light per millimetre.
  double density = 0;
};
struct Preset {
  std::string name;
  VolumeMode mode = VolumeMode::density;
  std::vector<PresetPoint> points;  // one at least, by value
};

class TransferTable {
 public:
  TransferTable(const Preset& preset, const ShownVolume& volume);

  VolumeMode mode() const { return mode_; }
  float threshold() const { return threshold_; }  // code of the first point
  // Returns linear colour and, in `density`, extinction or light per metre (of `maximum`: opacity).
  Lanes3 look(const Lanes& codes, Lanes& density) const;
  // Returns whether nothing is seen of codes in the range.
  bool is_empty(const CodeRange& range) const;
  // Returns what look() finds as the density of one code, and the largest of all codes in a range.
  float density_of(float code) const {
    return entries_[size_t(code * (float(steps - 1) / most_code) + 0.5f)].density;
  }
  float largest_density(const CodeRange& range) const;

 private:
  static constexpr int steps = 4096;
  struct Entry {
    float red = 0, green = 0, blue = 0, density = 0;
  };
  VolumeMode mode_;
  float threshold_ = 0;
  std::vector<Entry> entries_;
  std::vector<uint32_t> seen_;  // how many entries before this one are seen
  // Row k holds the largest density of 2^k entries from each one on.
  std::vector<std::vector<float>> largest_;
  struct EntryRange {
    int first, last;
  };
  static EntryRange entries_of(const CodeRange& range);
};

// Finds presets in the volume's histogram: the classes of values that differ most (Otsu 1979, for
// four classes), for which a scan has air, wrapping or soft matter, bone, and metal. The first is
// what one sees from outside. A volume with fewer classes gets fewer presets, at least one. One of
// colours is light that it sends.
std::vector<Preset> find_presets(const ShownVolume& volume);

}  // namespace wellspring::volume
