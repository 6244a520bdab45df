// SPDX-License-Identifier: Apache-2.0
// Where a surface ends that is made of triangles narrower than a pixel: bars, tubes and mouldings,
// of which sampling places meet one face and miss the next. The line from one sampling place
// towards the next is followed from triangle to triangle over their common edges.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "world/raster/raster_setup.h"
#include "world/view.h"
#include "world/world.h"

namespace wellspring::world {

// Which triangles of a mesh meet along their edges, vertices being the same where their places are.
struct MeshNeighbours {
  static constexpr uint32_t none = 0xffffffffu;
  // Of each triangle over its edge from corner k to the next: triangle * 4 + its own edge there. Or
  // none: nothing, or more than one.
  std::vector<std::array<uint32_t, 3>> over;
  // The least width of a triangle and its neighbours, from edge to opposite corner, in mesh space.
  std::vector<float> width;
  // Not 0: it is part of something long and thin; it has a crease, or its surface ends there.
  std::vector<uint8_t> bar;
};
MeshNeighbours find_neighbours(const Mesh& mesh);

// An edge on the way from one sampling place to the next: pixels up to there, and those by which
// that changes a pixel to the side.
struct EdgeLine {
  float at = 2, slope = 0;
};

// Where a triangle that covers the place (x, y) ends on the way to the neighbour at `step` along
// the axis; beyond 1: not before there.
struct TriangleExit : EdgeLine {
  int edge = 0;  // of the triangle
};
TriangleExit exit_of(const RasterTriangle& t, int x, int y, int step, bool vertical,
                     const RasterView& view);

// Of the picture that is drawn.
struct SurfaceWalk {
  const World& world;
  const std::vector<MeshNeighbours>& meshes;
  const std::vector<uint32_t>& mesh_of;  // of every instance
  const View& view;
  const RasterView& raster;
  float focal;  // pixels a unit of slope

  // From the place (x, y), which the triangle covers and whose `exit` is given, to where its
  // surface ends or turns away on the way to the neighbour at `step` along the axis; beyond 1: it
  // does not.
  EdgeLine end_of(const RasterTriangle& t, const TriangleExit& exit, int x, int y, int step,
                  bool vertical) const;
};

}  // namespace wellspring::world
