// SPDX-License-Identifier: Apache-2.0
#include "light/walk/lambert_hits.h"

#include <algorithm>
#include <bit>

#include "light/walk/first_surface.h"
#include "light/material/lambert_simd.h"
#include "world/packet_simd.h"
#include "world/surface_simd.h"

namespace wellspring::light {
namespace {

// Eight of them, `first` on.
void describe_lanes(const Transport& transport, const RayPacket& rays, const Hit* hits,
                    uint32_t lanes, size_t first, std::span<Sample> samples,
                    std::vector<LambertHit>& eyes) {
  Lanes3 direction{load_lanes(rays.direction_x), load_lanes(rays.direction_y),
                   load_lanes(rays.direction_z)};
  LambertSurfaceLanes surface = eval_lambert_surfaces(transport.world, direction, hits, lanes);
  LambertLobeLanes lobes = make_lambert(surface, direction);
  Lanes3 origin = offset_origins(surface, surface.geometric_normal);
  for (uint32_t bits = lanes; bits; bits &= bits - 1) {
    int i = std::countr_zero(bits);
    Sample& sample = samples[first + size_t(i)];
    sample = Sample();
    describe_place(transport.world, hits[i], surface.place(i), surface.normal.at(i), hits[i].t,
                   sample);
    sample.albedo = lobes.reflectance.at(i);
    eyes.push_back({uint32_t(first) + uint32_t(i), surface.position.at(i), lobes.normal.at(i),
                    lobes.geometric_normal.at(i), origin.at(i), surface.extent[i]});
  }
}

}  // namespace

LambertHits see_lambert(const Transport& transport, std::span<const Request> requests,
                        std::span<Sample> samples) {
  LambertHits seen;
  seen.eyes.reserve(requests.size());
  for (size_t first = 0; first < requests.size(); first += lane_count) {
    int count = int(std::min(requests.size() - first, size_t(lane_count)));
    RayPacket rays{};
    Hit hits[RayPacket::lanes];
    uint32_t asked = 0, lambertian = 0;
    for (int i = 0; i < count; i++) {
      const Request& request = requests[first + size_t(i)];
      bool in_solid =
          transport.tables.any_solid && find_media(transport, request.ray.origin).count > 0;
      if (!transport.tables.any_lambertian || in_solid || request.ray.t_min != 0) continue;
      set_ray(request.ray, i, rays);
      asked |= 1u << i;
    }
    transport.world.intersect_each(rays, asked, hits);
    for (int i = 0; i < count; i++) {
      uint32_t number = uint32_t(first) + uint32_t(i);
      if (!(asked >> i & 1)) {
        seen.others.push_back(number);
      } else if (!hits[i].valid()) {
        samples[number] = Sample();
        describe_sky(transport, requests[number].ray.direction, vec3(1), samples[number]);
        seen.nothing.push_back(number);
      } else if (met_lambertian(transport, hits[i])) {
        lambertian |= 1u << i;
      } else {
        seen.others.push_back(number);
      }
    }
    if (lambertian) describe_lanes(transport, rays, hits, lambertian, first, samples, seen.eyes);
  }
  return seen;
}

}  // namespace wellspring::light
