// SPDX-License-Identifier: Apache-2.0
#include "light/walk/part_colors.h"

#include <algorithm>

namespace wellspring::light {

bool parts_colors(const Transport& transport, const Media& media, const Surface& surface) {
  if (!transport.tables.plan.uses(TransportPart::dispersion)) return false;
  const Material& material = transport.world.scene().materials[size_t(surface.material)];
  return is_dispersive(surface, material) && owns_boundary(media, surface);
}

void part_colors(const Transport& transport, const Media& media, vec3 direction,
                 const Surface& surface, const Wavelengths& carried, float u, Bsdf& bsdf,
                 std::optional<WavelengthSpread>& spread) {
  const Material& material = transport.world.scene().materials[size_t(surface.material)];
  float outside = index_outside(transport, media, surface);
  const DielectricAlbedo& albedo =
      outside == 1 ? *transport.tables.materials[size_t(surface.material)].albedo
                   : dielectric_albedo(std::max(material.ior / outside, outside / material.ior));
  spread_wavelengths(surface, material, direction, albedo, carried, u, bsdf, spread, outside);
}

}  // namespace wellspring::light
