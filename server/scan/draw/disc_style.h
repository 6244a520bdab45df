// SPDX-License-Identifier: Apache-2.0
// Says how points are drawn.
#pragma once

namespace wellspring::scan {

struct DiscStyle {
  // A disc's radius is this times its node's spacing; above 0.71 discs on a grid cover it.
  float radius = 0.75f;
  float most_pixels = 24;  // no disc has a larger radius in the picture; up to 31
  // Points are opaque spheres of that radius instead, of whatever size near the eye; not blended.
  bool spheres = false;
  // Discs of one surface are averaged with weights that fall towards their rims (Botsch et al.
  // 2005, "High-quality surface splatting on today's GPUs"); false: the nearest middle wins.
  bool blended = false;
};

}  // namespace wellspring::scan
