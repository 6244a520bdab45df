// SPDX-License-Identifier: Apache-2.0
// Reads how a GeoJSON file is drawn on a painting.
#pragma once
#include <memory>

#include "store/painting/geo_drawing.h"
#include "store/painting/painting_file.h"

namespace wellspring::store {

// Returns how maps are drawn of which nobody says it: dark lines, pale areas, names with a halo.
// `millimetre`: a share of the picture's width.
GeoStyle plain_geo_style(double millimetre);

// Reads an item that shows a .geojson file of the painting's folder or a folder in it.
PaintItem read_geo_item(json::FieldReader& fields, PaintingReading& reading);

}  // namespace wellspring::store
