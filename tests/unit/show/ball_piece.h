// SPDX-License-Identifier: Apache-2.0
// A piece that is a scanned volume: a ball of 20 mm with a core of 8 mm, ten times as large.
#pragma once
#include "show/exhibit/exhibit.h"
#include "unit/volume/draw_made.h"

namespace wellspring::test {

// Adds it with the presets "skin" and "core". `position`: of its underside.
inline void add_ball(Exhibit& exhibit, dvec3 position) {
  ExhibitPiece piece;
  piece.id = "ball", piece.position = position, piece.scale = 10;
  piece.object = uint32_t(exhibit.scene.objects.size());
  exhibit.scene.objects.push_back("ball");
  piece.volume =
      std::make_shared<ShownVolume>(make_shown_volume(made_volume({48, 48, 48}, [](glm::vec3 p) {
        return length(p) < 8 ? 2.0f : length(p) < 20 ? 1.0f : 0.0f;
      })));
  for (const auto& [id, value] : {std::pair("skin", 0.5), std::pair("core", 1.5)}) {
    PieceLayer layer;
    layer.id = id;
    layer.preset = Preset{id, VolumeMode::surface, {{value, vec3(1), 1}}};
    piece.layers.push_back(std::move(layer));
  }
  exhibit.pieces.push_back(std::move(piece));
}

}  // namespace wellspring::test
