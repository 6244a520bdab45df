// SPDX-License-Identifier: Apache-2.0
// A scanned volume that stands in the scene, and what is seen of it. It is no mesh: pictures lay it
// over what they draw (picture/volume_view.h), and rays meet it where they ask for it.
#pragma once
#include <algorithm>
#include <limits>
#include <memory>
#include <vector>

#include "volume/draw/march.h"
#include "world/scene.h"

namespace wellspring::world {

// Holds what is seen of a volume: a preset in the light of the room, or a mixture of two.
struct VolumeLook {
  std::shared_ptr<const DrawnPreset> preset, over;  // null `preset`: nothing; null `over`: it alone
  std::shared_ptr<const ShownVolume> volume;        // null: PlacedVolume::volume
  float share = 0;                                  // share of `over`, 0 to 1
  std::vector<VolumeCut> cuts;                      // in the frame of Volume::to_metres
  float turn = 0;  // radians to the left, around the upright axis through its middle
  bool operator==(const VolumeLook& other) const {
    const auto same = [](const VolumeCut& a, const VolumeCut& b) {
      return a.normal == b.normal && a.offset == b.offset;
    };
    return preset == other.preset && over == other.over && volume == other.volume &&
           share == other.share && turn == other.turn && std::ranges::equal(cuts, other.cuts, same);
  }
};

// Holds the corners of all that a volume fills, in the frame of Volume::to_metres, metres.
struct VolumeBox {
  vec3 low{std::numeric_limits<float>::infinity()}, high{-std::numeric_limits<float>::infinity()};
  vec3 middle() const { return 0.5f * (low + high); }
};
VolumeBox box_of(const ShownVolume& volume);

struct PlacedVolume {
  std::shared_ptr<const ShownVolume> volume;
  vec3 position{0};     // its middle, scene coordinates
  float yaw = 0;        // radians; as a storyteller's: 0 faces -Z
  float scale = 1;      // metres of the scene to one of the scan
  uint32_t object = 0;  // seen there
  VolumeLook look;
  const ShownVolume& shown() const { return look.volume ? *look.volume : *volume; }
};

// Leads from the scene to the frame of a volume (Volume::to_metres), in which one metre is
// 1 / scale of the scene's.
struct ToVolume {
  mat3 turn{1};    // turns directions, which stay unit vectors
  vec3 middle{0};  // the volume's, in its own frame
  vec3 position{0};
  float scale = 1;

  explicit ToVolume(const PlacedVolume& placed);
  vec3 place(vec3 p) const { return turn * ((p - position) / scale) + middle; }
  vec3 way(vec3 d) const { return turn * d; }
};

// Returns a box around the volume, however it is turned, in scene coordinates.
Bounds bounds_of(const PlacedVolume& placed);

}  // namespace wellspring::world
