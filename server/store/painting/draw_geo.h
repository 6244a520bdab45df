// SPDX-License-Identifier: Apache-2.0
// Draws a map's outlines and names by Cairo into a window of a level. Only what touches the window
// is looked at. Widths are those of ink on paper: what is thinner than a texel is paler there, so
// coarse levels look like the mean of fine ones.
#pragma once
#include "store/painting/geo_drawing.h"

struct _cairo;  // from Cairo

namespace wellspring::store {

// Says which texels are drawn: Cairo's surface begins at texel `origin` of the level.
struct GeoCanvas {
  _cairo* cairo = nullptr;
  PaintPlacement to_window;  // from the drawing's places to the surface
  dvec2 origin{0};
  int width = 0, height = 0;
};

// Draws, and takes what it costs from `work`, which counts about drawn shapes; stops below 0.
void draw_geo(const GeoDrawing& drawing, const GeoCanvas& canvas, double& work);

}  // namespace wellspring::store
