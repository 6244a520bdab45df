// SPDX-License-Identifier: Apache-2.0
// Computes light of illumination maps on a run's pixels: VisibleRun::known(). For pieces of one
// triangle each the place of their light is found; then nodes, pictures and gloss are read eight
// pixels at a time, as pieces are mostly shorter than that.
#include <algorithm>
#include <bit>

#include "base/rgb9e5.h"
#include "light/material/bsdf_gloss.h"
#include "light/visible/visibility_impl.h"

namespace wellspring::light {
namespace {

// If the nodes around a place differ by more than that share of its light, their light has an edge
// between them.
constexpr float most_even_spread = 0.4f;
constexpr Lanes lane{0, 1, 2, 3, 4, 5, 6, 7};

// Holds the four nodes around each of a run's pixels: `node`, the next, and those `stride` on; u
// and v lie between them. A stride of 0: there are none.
struct NodePlaces {
  uint32_t node[RunSurface::most], stride[RunSurface::most];
  float u[RunSurface::most], v[RunSurface::most];
};

// Finds where the light of a triangle lies; returns false if the charts do not have it.
bool place_light(const World& world, const IlluminationMap& map, Facet& f) {
  const IlluminationCharts& charts = *map.places;
  if (f.charts == &charts) return f.chart != no_chart;
  f.charts = &charts;
  f.chart = charts.find(f.instance, f.triangle, f.front);
  if (f.chart == no_chart) return false;
  const IlluminationChart& chart = charts.charts[f.chart];
  const Face face = make_face(*f.placed, f.triangle);
  auto along = [&](vec3 way) { return vec2(dot(way, chart.along_u), dot(way, chart.along_v)); };
  f.light_corner = along(face.corner - chart.origin);
  f.light_edge1 = along(face.edge1), f.light_edge2 = along(face.edge2);
  if (!map.nodes.slope.empty()) place_relief(world, f);
  return true;
}

// Finds the nodes of eight pixels from `i` on, for those `asked`, at places of a chart counted in
// tiles.
void place_nodes(const IlluminationMap& map, const IlluminationChart& chart, Lanes u, Lanes v,
                 const LaneMask& asked, int i, NodePlaces& to) {
  const Lanes zero{};
  u = lanes_min(lanes_max(u, zero), all_lanes(float(chart.columns)));
  v = lanes_min(lanes_max(v, zero), all_lanes(float(chart.rows)));
  const LaneBits column = to_whole(lanes_min(u, all_lanes(float(chart.columns - 1)))),
                 row = to_whole(lanes_min(v, all_lanes(float(chart.rows - 1)))),
                 tile = row * uint32_t(chart.columns) + column;
  u = lanes_min(u - to_float(column), all_lanes(1));
  v = lanes_min(v - to_float(row), all_lanes(1));
  LaneBits node{}, stride{};
  Lanes across{}, down{};
  // Neighbours mostly lie in one tile, else in two.
  for (unsigned left = negative_lanes(asked); left != 0;) {
    const uint32_t first = tile[std::countr_zero(left)];
    const LaneMask here = lanes_of_bits(left) & (tile == first);
    left &= ~negative_lanes(here);
    const IlluminationTile& at = map.tiles[chart.first_tile + first];
    if (at.first == no_tile) continue;
    const Lanes x = u * float(at.columns), y = v * float(at.rows);
    const LaneBits n = to_whole(lanes_min(x, all_lanes(float(at.columns - 1)))),
                   m = to_whole(lanes_min(y, all_lanes(float(at.rows - 1))));
    const uint32_t wide = at.columns + 1u;
    node = here ? at.first + m * wide + n : node;
    stride = here ? LaneBits{} + wide : stride;
    across = here ? x - to_float(n) : across, down = here ? y - to_float(m) : down;
  }
  store_lanes(to.node + i, node), store_lanes(to.stride + i, stride);
  store_lanes(to.u + i, across), store_lanes(to.v + i, down);
}

// Returns from[at[i]] in lane i.
LaneBits gather_words(const uint32_t* from, const LaneBits& at) {
#ifdef __AVX2__
  return LaneBits(_mm256_i32gather_epi32(reinterpret_cast<const int*>(from), __m256i(at), 4));
#else
  LaneBits words;
  for (int i = 0; i < lane_count; i++) words[i] = from[at[i]];
  return words;
#endif
}

// Holds the nodes around eight places, and their weights.
struct NodeTaps {
  LaneBits node[4];
  Lanes weight[4];
  LaneMask there;
  NodeTaps(const NodePlaces& at, int i) {
    const LaneBits first = load_lanes<LaneBits>(at.node + i),
                   stride = load_lanes<LaneBits>(at.stride + i);
    const Lanes u = load_lanes(at.u + i), v = load_lanes(at.v + i);
    there = stride != 0u;
    node[0] = first, node[1] = first + 1u;
    node[2] = first + stride, node[3] = node[1] + stride;
    weight[0] = (1.0f - u) * (1.0f - v), weight[1] = u * (1.0f - v);
    weight[2] = (1.0f - u) * v, weight[3] = u * v;
  }
};

struct Light {
  Lanes red{}, green{}, blue{};
  Lanes spread{};  // spread of the sum of the three, among the nodes around
};
Light read_light(const IlluminationNodes& nodes, const NodeTaps& taps) {
  Light light;
  Lanes least = all_lanes(INFINITY), most{};
  for (int k = 0; k < 4; k++) {
    Lanes r, g, b;
    unpack_rgb9e5(gather_words(nodes.light.data(), taps.node[k]), r, g, b);
    light.red += taps.weight[k] * r, light.green += taps.weight[k] * g;
    light.blue += taps.weight[k] * b;
    least = lanes_min(least, r + g + b), most = lanes_max(most, r + g + b);
  }
  light.spread = most - least;
  for (Lanes* one : {&light.red, &light.green, &light.blue, &light.spread})
    *one = keep_lanes(taps.there, *one);
  return light;
}

// Reads vectors that nodes keep, packed.
template <void (*unpack)(const LaneBits&, Lanes&, Lanes&, Lanes&)>
Lanes3 read_vectors(const std::vector<uint32_t>& of, const NodeTaps& taps) {
  Lanes3 sum;
  for (int k = 0; k < 4; k++) {
    Lanes3 one;
    unpack(gather_words(of.data(), taps.node[k]), one.x, one.y, one.z);
    sum = sum + one * taps.weight[k];
  }
  return {keep_lanes(taps.there, sum.x), keep_lanes(taps.there, sum.y),
          keep_lanes(taps.there, sum.z)};
}

// Holds vectors of a run's pixels.
struct Vectors {
  float x[RunSurface::most], y[RunSurface::most], z[RunSurface::most];
  void put(int i, const Lanes3& v) {
    store_lanes(x + i, v.x), store_lanes(y + i, v.y), store_lanes(z + i, v.z);
  }
  Lanes3 at(int i) const { return {load_lanes(x + i), load_lanes(y + i), load_lanes(z + i)}; }
};

// Describes a run's pixels before light is read.
struct Mapped {
  // A bit each: plain by their material; with a map of normals; of a bent chart.
  uint64_t pixels = 0, plain = 0, relief = 0, bent = 0;
  NodePlaces nodes;
  float f0[RunSurface::most], roughness[RunSurface::most],
      share[RunSurface::most];  // for plain ones
  // Maps of normals: the places where they are read, and the texels there.
  Stretches pictures;
  Vectors normal;
};

uint64_t bits_between(int begin, int end) {
  return (end - begin < 64 ? (uint64_t(1) << (end - begin)) - 1 : ~uint64_t(0)) << begin;
}

}  // namespace

uint64_t VisibleRun::known(const IlluminationMap& map, const RunSurface& surface,
                           RunKnown& to) const {
  to.plain = 0;
  if (seen_ || map.nodes.light.size() < 2) return 0;
  const RasterRun& r = *impl_->run;
  const bool sloped = !map.nodes.slope.empty();
  Mapped mapped;
  auto skip = [&](int i) {
    store_lanes(mapped.nodes.node + i, LaneBits{}),
        store_lanes(mapped.nodes.stride + i, LaneBits{});
    store_lanes(mapped.nodes.u + i, Lanes{}), store_lanes(mapped.nodes.v + i, Lanes{});
  };
  for (int p = 0, begin = 0; p < r.pieces; begin = r.end[p++]) {
    const int end = r.end[p];
    Facet* f = r.instance[begin] == RasterRun::nothing ? nullptr : &impl_->facet(begin);
    if (!f || f->placed->moving || !place_light(impl_->visibility.world, map, *f)) {
      for (int i = begin; i < end; i += lane_count) skip(i);
      continue;
    }
    const uint64_t these = bits_between(begin, end);
    mapped.pixels |= these;
    const IlluminationChart& chart = map.places->charts[f->chart];
    const int material = f->placed->mesh->material;
    const bool plain = impl_->visibility.plain[size_t(material)] != 0,
               relief = sloped && f->relief.known;
    if (plain) mapped.plain |= these;
    if (relief) mapped.relief |= these;
    if (sloped && chart.bent && map.normals) mapped.bent |= these;
    const GlossFactors gloss = gloss_factors(*f->material);
    for (int i = begin; i < end; i += lane_count) {
      const Lanes a = load_lanes(r.u + i), b = load_lanes(r.v + i);
      place_nodes(map, chart, f->light_corner.x + f->light_edge1.x * a + f->light_edge2.x * b,
                  f->light_corner.y + f->light_edge1.y * a + f->light_edge2.y * b,
                  lane < float(end - i), i, mapped.nodes);
      if (plain) {
        store_lanes(mapped.f0 + i, all_lanes(gloss.f0));
        store_lanes(mapped.roughness + i, all_lanes(gloss.roughness));
        store_lanes(mapped.share + i, all_lanes(gloss.share));
      }
      if (!relief) continue;
      mapped.pictures.base.put(f->relief, a, b, i);
      mapped.pictures.add({i, std::min(i + lane_count, end), f->material, material,
                           impl_->relief_texels(*f, i, end), 0, false});
    }
  }
  if (!mapped.pixels) return 0;
  skip(count);  // pixels beyond the last piece are read, too
  for (int k = 0; k < mapped.pictures.count; k++) {
    const Stretch& s = mapped.pictures.of[k];
    for (int i = s.begin; i < s.end; i += lane_count)
      mapped.normal.put(
          i, impl_->read_relief(mapped.pictures.base, *s.material, s.base_texels, i, s.end));
  }
  const uint64_t turned = mapped.relief | mapped.bent;
  Vectors slope;
  float own[RunSurface::most];  // as eval_turn() has it, for bent charts
  for (int i = 0; i < count; i += lane_count) {
    if (!(mapped.pixels >> i & 0xff)) continue;
    const NodeTaps taps(mapped.nodes, i);
    const Light light = read_light(map.nodes, taps);
    store_lanes(to.red + i, light.red), store_lanes(to.green + i, light.green);
    store_lanes(to.blue + i, light.blue);
    const unsigned plain = mapped.plain >> i & 0xff;
    if (plain) {
      const Lanes all = light.red + light.green + light.blue;
      to.plain |= uint64_t(plain & negative_lanes(light.spread <= most_even_spread * all)) << i;
      store_lanes(to.gloss + i, impl_->read_gloss(surface, i, load_lanes(mapped.f0 + i),
                                                  load_lanes(mapped.roughness + i),
                                                  load_lanes(mapped.share + i)));
    }
    if (!(turned >> i & 0xff)) continue;
    const Lanes3 leans = read_vectors<unpack_slope>(map.nodes.slope, taps);
    slope.put(i, leans);
    if (mapped.bent >> i & 0xff)
      store_lanes(own + i, dot(leans, read_vectors<unpack_node_normal>(*map.normals, taps)));
  }
  for (int p = 0, begin = 0; p < r.pieces; begin = r.end[p++]) {
    if (!(turned >> begin & 1)) continue;
    const int end = r.end[p];
    Facet& f = impl_->facet(begin);
    place_light(impl_->visibility.world, map, f);  // others may have taken its place meanwhile
    const bool relief = mapped.relief >> begin & 1, bent = mapped.bent >> begin & 1;
    for (int i = begin; i < end; i += lane_count) {
      const Lanes3 said = relief ? mapped.normal.at(i) : Lanes3{};
      const Lanes from = bent ? load_lanes(own + i) : Lanes{};
      Lanes factor = eval_turn(f, load_lanes(r.u + i), load_lanes(r.v + i), slope.at(i),
                               relief ? &said : nullptr, bent ? &from : nullptr);
      factor = lane < float(end - i) ? factor : all_lanes(1);
      for (float* channel : {to.red + i, to.green + i, to.blue + i})
        store_lanes(channel, load_lanes(channel) * factor);
    }
  }
  const Lanes more = all_lanes(map.least_known());
  for (float* channel : {to.red, to.green, to.blue})
    for (int i = 0; i < count; i += lane_count)
      store_lanes(channel + i, load_lanes(channel + i) + more);
  return mapped.pixels;
}

}  // namespace wellspring::light
