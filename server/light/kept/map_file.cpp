// SPDX-License-Identifier: Apache-2.0
#include "light/kept/map_file.h"

#include <zstd.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/parallel.h"
#include "base/rng.h"
#include "base/worker.h"
#include "light/kept/bake_field.h"
#include "light/kept/binned_light.h"
#include "light/kept/finish_bake.h"

namespace wellspring::light {
namespace {

constexpr uint64_t format = 0x33504d4c57535702;  // changes with what is written, and with charts
constexpr int zstd_level = 19;
constexpr float light_steps = 24;     // steps to a unit of the light's logarithm to base 2
constexpr float least_share = 1e-3f;  // share of the mean light, below which steps are even
// Steps to a colour's share of 1, and to a slope of 1.
constexpr float color_steps = 63, slope_steps = 5;

// A node is written as light, two of its colour's shares, and a slope.
constexpr int light_planes = 3, slope_planes = 3;
using NodeCodes = std::array<int, light_planes + slope_planes>;

struct Quantiser {
  float least = 1;  // light in a step at 0, times light_steps
  bool sloped = false;
  int planes() const { return light_planes + (sloped ? slope_planes : 0); }
  NodeCodes code(const IlluminationNodes& nodes, size_t i) const {
    NodeCodes codes{};
    const vec3 light = unpack_rgb9e5(nodes.light[i]);
    const float sum = light.x + light.y + light.z;
    codes[0] = int(std::lrint(light_steps * std::log2(1 + luminance(light) / least)));
    if (codes[0] == 0) return codes;
    codes[1] = int(std::lrint(color_steps * light.x / sum));
    codes[2] = int(std::lrint(color_steps * light.z / sum));
    if (!sloped) return codes;
    const vec3 slope = unpack_slope(nodes.slope[i]) * slope_steps;
    for (int k = 0; k < 3; k++) codes[size_t(light_planes + k)] = int(std::lrint(slope[k]));
    return codes;
  }
  void put(const NodeCodes& codes, IlluminationNodes& nodes, size_t i) const {
    const float red = float(codes[1]) / color_steps, blue = float(codes[2]) / color_steps;
    const vec3 color(red, std::max(1 - red - blue, 0.0f), blue);
    const float light = least * (std::exp2(float(codes[0]) / light_steps) - 1);
    nodes.light[i] = pack_rgb9e5(color * (light / std::max(luminance(color), 1e-3f)));
    if (sloped)
      nodes.slope[i] =
          pack_slope(vec3(float(codes[3]), float(codes[4]), float(codes[5])) / slope_steps);
  }
};

// Returns what a node's neighbours to the left and below, and the one between these, let expect.
int expected(int left, int below, int corner) {
  if (corner >= std::max(left, below)) return std::min(left, below);
  if (corner <= std::min(left, below)) return std::max(left, below);
  return left + below - corner;
}

// Holds the codes of a tile's nodes. A dark node has no colour and no slope: it gets those that its
// neighbours let expect.
struct TileCodes {
  std::vector<NodeCodes> codes;
  int stride = 1;
  NodeCodes expect(size_t i) const {
    const size_t row = i / size_t(stride), column = i % size_t(stride);
    NodeCodes all{};
    for (size_t k = 0; k < all.size(); k++) {
      auto at = [&](size_t back) { return codes[i - back][k]; };
      if (row == 0) all[k] = column == 0 ? 0 : at(1);
      else if (column == 0) all[k] = at(size_t(stride));
      else all[k] = expected(at(1), at(size_t(stride)), at(size_t(stride) + 1));
    }
    return all;
  }
};

// Folds a difference so that small ones of either sign become small numbers; light takes two bytes.
uint32_t fold(int x) { return x < 0 ? uint32_t(-2 * x - 1) : uint32_t(2 * x); }
int unfold(uint32_t x) { return x & 1 ? -int((x + 1) / 2) : int(x / 2); }

std::string compress(const std::string& bytes) {
  std::string packed(ZSTD_compressBound(bytes.size()), '\0');
  const size_t size =
      ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), zstd_level);
  packed.resize(ZSTD_isError(size) ? 0 : size);
  return packed;
}

// Returns false if `packed` is not `size` bytes, packed.
bool decompress(const std::vector<char>& packed, size_t size, std::string& bytes) {
  bytes.resize(size);
  const size_t found = ZSTD_decompress(bytes.data(), size, packed.data(), packed.size());
  return !ZSTD_isError(found) && found == size;
}

// Returns the size of a layer's differences, plane after plane; light's low bytes, then its high
// ones.
size_t layer_bytes(size_t nodes, const Quantiser& quantiser) {
  return nodes * size_t(quantiser.planes() + 1);
}

std::string write_layer(const std::vector<IlluminationTile>& tiles, const IlluminationNodes& nodes,
                        const Quantiser& quantiser) {
  const size_t count = nodes.light.size();
  std::string bytes(layer_bytes(count, quantiser), '\0');
  TileCodes tile_codes;
  for (const IlluminationTile& tile : tiles) {
    tile_codes.codes.assign(tile.nodes(), {});
    tile_codes.stride = tile.columns + 1;
    for (size_t i = 0; i < tile.nodes(); i++) {
      NodeCodes& codes = tile_codes.codes[i];
      const NodeCodes guess = tile_codes.expect(i);
      codes = quantiser.code(nodes, tile.first + i);
      if (codes[0] == 0) std::copy(guess.begin() + 1, guess.end(), codes.begin() + 1);
      const size_t at = tile.first + i;
      const uint32_t light = std::min(fold(codes[0] - guess[0]), 0xffffu);
      bytes[at] = char(light & 255), bytes[count + at] = char(light >> 8);
      for (int k = 1; k < quantiser.planes(); k++)
        bytes[size_t(k + 1) * count + at] =
            char(uint8_t(fold(int8_t(codes[size_t(k)] - guess[size_t(k)]))));
    }
  }
  return bytes;
}

void read_layer(const std::vector<IlluminationTile>& tiles, const std::string& bytes,
                const Quantiser& quantiser, IlluminationNodes& nodes) {
  const size_t count = bytes.size() / size_t(quantiser.planes() + 1);
  nodes.light.resize(count);
  if (quantiser.sloped) nodes.slope.resize(count);
  TileCodes tile_codes;
  for (const IlluminationTile& tile : tiles) {
    tile_codes.codes.assign(tile.nodes(), {});
    tile_codes.stride = tile.columns + 1;
    for (size_t i = 0; i < tile.nodes(); i++) {
      const NodeCodes guess = tile_codes.expect(i);
      NodeCodes& codes = tile_codes.codes[i];
      const size_t at = tile.first + i;
      const uint32_t light = uint8_t(bytes[at]) | uint32_t(uint8_t(bytes[count + at])) << 8;
      codes[0] = std::clamp(guess[0] + unfold(light), 0, 0x7fff);
      for (int k = 1; k < quantiser.planes(); k++) {
        const int sum = guess[size_t(k)] + unfold(uint8_t(bytes[size_t(k + 1) * count + at]));
        codes[size_t(k)] = k < light_planes ? int(uint8_t(sum)) : int(int8_t(sum));
      }
      quantiser.put(codes, nodes, at);
    }
  }
}

// Holds how a thing stands, and how many tiles it has: its light is found again by both.
struct StandingThing {
  uint64_t hash = 0;
  uint64_t tiles = 0;
  bool operator==(const StandingThing&) const = default;
};

uint64_t hash_of(const void* data, size_t size, uint64_t hash) {
  const char* p = static_cast<const char*>(data);
  for (size_t i = 0; i < size; i += 8) {
    uint64_t word = 0;
    std::memcpy(&word, p + i, std::min<size_t>(8, size - i));
    hash = mix64(hash ^ word);
  }
  return hash;
}

std::vector<StandingThing> find_things(const World& world, const BakeCharts& charts) {
  const Scene& scene = world.scene();
  std::vector<StandingThing> things(scene.instances.size());
  for (size_t i = 0; i < things.size(); i++) {
    const Mesh& mesh = scene.meshes[size_t(scene.instances[i].mesh)];
    uint64_t hash = hash_of(mesh.positions.data(), mesh.positions.size() * sizeof(vec3), 1);
    hash = hash_of(mesh.triangles.data(), mesh.triangles.size() * sizeof(uvec3), hash);
    things[i].hash = hash_of(&scene.instances[i].to_world, sizeof(mat4), hash);
  }
  for (size_t c = 0; c < charts.surfaces.size(); c++) {
    const IlluminationChart& chart = charts.places->charts[c];
    things[charts.surfaces[c].instance].tiles += uint64_t(chart.columns) * uint64_t(chart.rows);
  }
  return things;
}

struct MapHead {
  float tile = 0, error = 1, least = 1;
  uint32_t sloped = 0, layers = 0, tiles = 0;
};

// Returns tiles as the file has them, one after the other; empty: they make no sense.
std::vector<IlluminationTile> read_tiles(const std::string& cells) {
  std::vector<IlluminationTile> tiles(cells.size() / 2);
  size_t nodes = 0;
  for (size_t t = 0; t < tiles.size(); t++) {
    const int columns = uint8_t(cells[2 * t]), rows = uint8_t(cells[2 * t + 1]);
    if (columns == 0 && rows == 0) continue;
    if (columns == 0 || rows == 0 || columns > most_cells_a_tile || rows > most_cells_a_tile)
      return {};
    tiles[t] = {uint32_t(nodes), uint16_t(columns), uint16_t(rows)};
    nodes += tiles[t].nodes();
    if (nodes > most_map_nodes) return {};
  }
  return tiles;
}

size_t count_nodes(std::span<const IlluminationTile> tiles) {
  size_t sum = 0;
  for (const IlluminationTile& tile : tiles) sum += tile.nodes();
  return sum;
}

// Fits the map of another scene, or of one that is cut into the same tiles, to the charts of this
// one: keeps the tiles of things that stand as they stood.
void take_standing(std::span<const StandingThing> theirs, std::span<const StandingThing> ours,
                   const BakeCharts& charts, IlluminationMap& map) {
  // First tile of each thing in the file.
  std::multimap<std::pair<uint64_t, uint64_t>, uint64_t> first_of;
  uint64_t first = 0;
  for (const StandingThing& thing : theirs) {
    first_of.insert({{thing.hash, thing.tiles}, first});
    first += thing.tiles;
  }
  const std::vector<IlluminationTile> tiles = std::move(map.tiles);
  map.tiles.assign(charts.tiles, {});
  auto places = std::make_shared<IlluminationCharts>(*charts.places);
  size_t at = 0;
  for (size_t i = 0; i < ours.size(); i++) {
    const auto found = first_of.find({ours[i].hash, ours[i].tiles});
    if (found == first_of.end()) {
      places->first_triangle[2 * i] = places->first_triangle[2 * i + 1] = no_chart;
    } else {
      std::copy_n(tiles.data() + found->second, ours[i].tiles, map.tiles.data() + at);
      first_of.erase(found);
    }
    at += ours[i].tiles;
  }
  map.places = places;
}

// Names what the layers of a scene's map hold, a line each; the first belongs to no lamp. A layer
// of bins has the number of the first behind a tab.
std::string layer_names(const Scene& scene) {
  std::string names;
  for (const MapLayer& layer : find_layers(scene)) {
    if (layer.lamp < 0) continue;
    names += '\n';
    for (char c : scene.lamps[size_t(layer.lamp)].name) names += c == '\n' || c == '\t' ? ' ' : c;
    if (layer.bin >= 0) names += '\t' + std::to_string(layer.bin);
  }
  return names;
}

// Returns the layers of this scene out of those of a map whose layers have other names: lamps are
// found again by their names, and a lamp that is new has no light yet: its layers go to `dark`.
std::vector<IlluminationNodes> take_layers(const std::string& theirs, const std::string& ours,
                                           std::vector<IlluminationNodes>& layers,
                                           std::vector<size_t>& dark) {
  auto split = [](const std::string& names) {
    std::vector<std::string> lines(1);
    for (char c : names)
      if (c == '\n') lines.emplace_back();
      else lines.back() += c;
    return lines;
  };
  const std::vector<std::string> known = split(theirs), wanted = split(ours);
  std::vector<IlluminationNodes> taken{layers[0]};
  for (size_t i = 1; i < wanted.size(); i++) {
    const auto found = std::find(known.begin() + 1, known.end(), wanted[i]);
    const size_t at = size_t(found - known.begin());
    IlluminationNodes& layer = taken.emplace_back();
    if (at < layers.size()) {
      layer = layers[at];
    } else {
      dark.push_back(i);
      layer.light.assign(layers[0].light.size(), pack_rgb9e5(vec3(0)));
      layer.slope.assign(layers[0].slope.size(), pack_slope(vec3(0)));
    }
  }
  return taken;
}

}  // namespace

bool save_map(const World& world, const IlluminationMap& map, const std::string& file,
              uint64_t key) {
  const BakeCharts charts = make_charts(world, map.places->tile);
  MapHead head{map.places->tile,
               map.error,
               std::max(least_share * map.mean, 1e-20f),
               !map.nodes.slope.empty(),
               uint32_t(map.layers->size()),
               uint32_t(map.tiles.size())};
  std::string cells;
  const std::vector<IlluminationTile>& tiles = map.tiles;
  for (const IlluminationTile& tile : tiles) {
    const bool is_there = tile.first != no_tile;
    cells += char(is_there ? tile.columns : 0);
    cells += char(is_there ? tile.rows : 0);
  }
  const Quantiser quantiser{head.least, head.sloped != 0};
  std::vector<std::string> layers(map.layers->size());
  parallel_each(int(layers.size()), [&](int i) {
    layers[size_t(i)] = compress(write_layer(tiles, (*map.layers)[size_t(i)], quantiser));
  });
  PutBytes put;
  put.value(head);
  put.array(find_things(world, charts));
  auto put_packed = [&](const std::string& packed) {
    put.array(std::vector<char>(packed.begin(), packed.end()));
  };
  const std::string names = layer_names(world.scene());
  put.array(std::vector<char>(names.begin(), names.end()));
  put_packed(compress(cells));
  for (const std::string& layer : layers) put_packed(layer);
  return write_keyed(file, format, key, put.bytes);
}

KeyedFile find_map(const std::string& file, uint64_t key) {
  std::string bytes;
  return read_keyed(file, format, key, bytes);
}

LoadedMap load_map(const World& world, const std::string& file, uint64_t key) {
  std::string bytes;
  LoadedMap loaded;
  loaded.found = read_keyed(file, format, key, bytes);
  const bool stale = loaded.found == KeyedFile::another_key;
  if (stale && read_keyed(file, format, any_key, bytes) != KeyedFile::read) return loaded;
  if (!stale && loaded.found != KeyedFile::read) return loaded;
  const auto refuse = [] { return LoadedMap{nullptr, KeyedFile::damaged}; };
  TakeBytes take{bytes};
  MapHead head;
  std::vector<StandingThing> things;
  std::vector<char> packed, names;
  take.value(head);
  take.array(things);
  take.array(names);
  take.array(packed);
  uint64_t their_tiles = 0;
  for (const StandingThing& thing : things)
    their_tiles += std::min<uint64_t>(thing.tiles, head.tiles + uint64_t(1));
  if (!take.good || !(head.tile > 0) || !std::isfinite(head.tile) || !(head.least > 0) ||
      !std::isfinite(head.least) || !(head.error >= 0) || head.layers == 0 ||
      their_tiles != head.tiles || head.tiles > most_map_nodes)
    return refuse();
  std::string cells, codes;
  if (!decompress(packed, size_t(head.tiles) * 2, cells)) return refuse();
  auto map = std::make_shared<IlluminationMap>();
  map->tiles = read_tiles(cells);
  if (map->tiles.size() != head.tiles) return refuse();
  const std::string theirs(names.begin(), names.end()), own = layer_names(world.scene());
  if (head.layers != 1 + size_t(std::ranges::count(names, '\n')) || (!stale && theirs != own))
    return refuse();
  map->error = head.error;
  check_cancelled();
  const Quantiser quantiser{head.least, head.sloped != 0};
  const size_t nodes = count_nodes(map->tiles);
  auto layers = std::make_shared<std::vector<IlluminationNodes>>(head.layers);
  for (IlluminationNodes& layer : *layers) {
    take.array(packed);
    if (!take.good || !decompress(packed, layer_bytes(nodes, quantiser), codes)) return refuse();
    read_layer(map->tiles, codes, quantiser, layer);
  }
  if (!take.complete()) return refuse();
  check_cancelled();
  const BakeCharts charts = make_charts(world, head.tile);
  const std::vector<StandingThing> ours = find_things(world, charts);
  if (stale) take_standing(things, ours, charts, *map);
  else if (things != ours) return refuse();
  else map->places = charts.places;
  if (theirs != own) {
    std::vector<size_t> dark;
    *layers = take_layers(theirs, own, *layers, dark);
    const std::vector<MapLayer> all = find_layers(world.scene());
    for (size_t layer : dark)
      if (all[layer].bin <= 0) loaded.dark_lamps.push_back(all[layer].lamp);
  }
  map->layers = layers;
  if (head.sloped)
    map->normals = pack_normals(
        unpack_normals(charts, map->tiles, node_normals(world, charts, map->tiles, nodes)));
  *map = sum_of_layers(std::move(*map), find_layer_colors(world.scene()));
  loaded.map = map;
  return loaded;
}

}  // namespace wellspring::light
