// SPDX-License-Identifier: Apache-2.0
#include "light/kept/bake_file.h"

#include <algorithm>
#include <cstring>

#include "base/rng.h"

namespace wellspring::light {
namespace {

constexpr uint64_t format = 0x334b414257535701;  // changes with what is written, and with charts

struct FieldBytes {
  std::vector<TileCells> cells;
  BakeField sums;
};

void list_fields(auto& to, auto& settings, auto& bake, auto& source, auto& direct, auto& gather) {
  to.array(source);
  to.value(settings);
  to.value(bake.tile);
  to.value(bake.refined);
  to.value(bake.passes);
  to.value(bake.cursor);
  to.array(bake.shards_done);
  for (auto* field : {&direct, &gather}) {
    to.array(field->cells);
    to.array(field->sums.asked);
    to.array(field->sums.count);
    to.array(field->sums.hidden);
    to.array(field->sums.squares);
    to.array(field->sums.light);
    to.array(field->sums.slope);
  }
  to.array(bake.pilots);
  to.array(bake.held_out.places);
  to.value(bake.held_out.samples);
}

bool take_field(const World& world, const BakeCharts& charts, int layers, FieldBytes& bytes,
                BakeField& field) {
  BakeField& sums = bytes.sums;
  if (bytes.cells.size() != charts.tiles || sums.asked.size() != charts.tiles) return false;
  for (TileCells c : bytes.cells)
    if (c.columns > most_cells_a_tile || c.rows > most_cells_a_tile || !c.columns != !c.rows)
      return false;
  const size_t nodes = node_count(bytes.cells);
  if (sums.count.size() != nodes || sums.hidden.size() != nodes || sums.squares.size() != nodes ||
      sums.light.size() != nodes * size_t(layers))
    return false;
  if (sums.slope.size() != (charts.sloped ? sums.light.size() : 0)) return false;
  field = make_field(world, charts, bytes.cells, layers);
  field.asked = std::move(sums.asked);
  field.count = std::move(sums.count);
  field.hidden = std::move(sums.hidden);
  field.squares = std::move(sums.squares);
  field.light = std::move(sums.light);
  field.slope = std::move(sums.slope);
  return true;
}

bool same_cells(const BakeField& a, const BakeField& b) {
  auto alike = [](const IlluminationTile& x, const IlluminationTile& y) {
    return x.first == y.first && x.columns == y.columns && x.rows == y.rows;
  };
  return a.layers == b.layers &&
         std::equal(a.tiles.begin(), a.tiles.end(), b.tiles.begin(), b.tiles.end(), alike);
}

}  // namespace

bool save_bake(const Bake& bake, const std::string& file, uint64_t key) {
  PutBytes put;
  const FieldBytes direct{cells_of(bake.direct), bake.direct},
      gather{cells_of(bake.gather), bake.gather};
  const std::vector<char> source(bake.source.begin(), bake.source.end());
  list_fields(put, bake.settings, bake, source, direct, gather);
  return write_keyed(file, format, key, put.bytes);
}

KeyedFile load_bake(const World& world, const std::string& file, uint64_t key, Bake& bake) {
  std::string bytes;
  KeyedFile found = read_keyed(file, format, key, bytes);
  if (found != KeyedFile::read) return found;
  Bake loaded;
  FieldBytes direct, gather;
  TakeBytes take{bytes};
  std::vector<char> source;
  list_fields(take, loaded.settings, loaded, source, direct, gather);
  loaded.source.assign(source.begin(), source.end());
  const int layers = int(find_layers(world.scene()).size());
  loaded.colors = find_layer_colors(world.scene());
  if (!take.complete() || !(loaded.tile > 0)) return KeyedFile::damaged;
  loaded.charts = make_charts(world, loaded.tile);
  loaded.places = tile_places(loaded.charts);
  if (loaded.cursor >= std::max(loaded.charts.tiles, 1u) ||
      loaded.pilots.size() != loaded.charts.tiles ||
      !restore(world, *loaded.charts.places, loaded.held_out) ||
      !take_field(world, loaded.charts, layers, direct, loaded.direct) ||
      !take_field(world, loaded.charts, layers, gather, loaded.gather))
    return KeyedFile::damaged;
  bake = std::move(loaded);
  return KeyedFile::read;
}

std::string read_bake_source(const std::string& file) {
  std::string bytes;
  if (read_keyed(file, format, any_key, bytes) != KeyedFile::read) return {};
  TakeBytes take{bytes};
  std::vector<char> source;
  take.array(source);
  return take.good ? std::string(source.begin(), source.end()) : std::string();
}

bool merge_bake(const Bake& part, Bake& bake) {
  const BakeSettings &a = part.settings, &b = bake.settings;
  auto done = [&](int shard) {
    return std::find(bake.shards_done.begin(), bake.shards_done.end(), shard) !=
           bake.shards_done.end();
  };
  if (a.shards != b.shards || a.seed != b.seed || a.shards < 2 || done(a.shard) || part.pilot() ||
      bake.pilot() || part.charts.tiles != bake.charts.tiles ||
      !same_cells(part.direct, bake.direct) || !same_cells(part.gather, bake.gather))
    return false;
  for (uint32_t tile = 0; tile < bake.charts.tiles; tile++) {
    if (tile % uint32_t(a.shards) != uint32_t(a.shard)) continue;
    if (bake.gather.tiles[tile].first == no_tile) continue;
    copy_tile(part.direct, tile, bake.direct, tile);
    copy_tile(part.gather, tile, bake.gather, tile);
  }
  bake.shards_done.push_back(a.shard);
  bake.passes = std::min(bake.passes, part.passes);
  if (int(bake.shards_done.size()) < b.shards) return true;
  // All shards are there: from now on the bake is as if it had been one.
  bake.settings.shard = 0, bake.settings.shards = 1, bake.cursor = 0;
  bake.shards_done = {0};
  return true;
}

namespace {

struct Hash {
  uint64_t value = 0;
  void bytes(const void* data, size_t size) {
    const char* p = static_cast<const char*>(data);
    value = mix64(value ^ size);
    for (size_t i = 0; i < size; i += 8) {
      uint64_t word = 0;
      std::memcpy(&word, p + i, std::min<size_t>(8, size - i));
      value = mix64(value ^ word);
    }
  }
  template <class... T>
  void add(const T&... v) {
    (bytes(&v, sizeof v), ...);
  }
  template <class T>
  void list(const std::vector<T>& v) {
    bytes(v.data(), v.size() * sizeof(T));
  }
};

void add_material(const Scene& scene, const Material& m, std::vector<char>& known, Hash& hash) {
  hash.add(m.base_color, m.metallic, m.roughness, m.normal_scale, m.emission, m.alpha_mode,
           m.alpha_cutoff, m.double_sided, m.unlit, m.ior, m.transmission, m.thickness,
           m.attenuation_color, m.attenuation_distance, m.dispersion, m.specular, m.specular_color,
           m.clearcoat, m.clearcoat_roughness, m.clearcoat_normal_scale, m.sheen_color,
           m.sheen_roughness, m.anisotropy, m.anisotropy_rotation, m.repaints);
  each_texture(m, [&](const TextureRef& reference) {
    hash.add(reference.texture, reference.uv_set, reference.uv_transform);
    if (reference.texture < 0) return;
    const Texture& texture = scene.textures[size_t(reference.texture)];
    hash.add(texture.image, texture.wrap_u, texture.wrap_v, texture.nearest);
    if (texture.image < 0 || known[size_t(texture.image)]) return;
    known[size_t(texture.image)] = 1;
    const Image& image = scene.images[size_t(texture.image)];
    // A large picture changes with its layers and years, whose light differs by little.
    if (image.large) return;
    hash.add(image.width, image.height, image.srgb);
    hash.list(image.texels8);
    hash.list(image.texels);
  });
}

}  // namespace

uint64_t hash_scene(const Scene& scene) {
  Hash hash;
  std::vector<char> images(scene.images.size(), 0), meshes(scene.meshes.size(), 0);
  for (const Instance& instance : scene.instances) {
    hash.add(instance.mesh, instance.to_world);
    if (meshes[size_t(instance.mesh)]) continue;
    meshes[size_t(instance.mesh)] = 1;
    const Mesh& mesh = scene.meshes[size_t(instance.mesh)];
    hash.list(mesh.positions), hash.list(mesh.normals), hash.list(mesh.tangents);
    hash.list(mesh.uv[0]), hash.list(mesh.uv[1]), hash.list(mesh.colors);
    hash.list(mesh.triangles);
    add_material(scene, scene.materials[size_t(mesh.material)], images, hash);
  }
  for (const PunctualLight& l : scene.lights)
    hash.add(l.type, l.position, l.direction, l.intensity, l.range, l.inner_cone, l.outer_cone);
  for (const Lamp& lamp : scene.lamps) hash.list(lamp.lights), hash.list(lamp.materials);
  for (const MapLayer& layer : find_layers(scene))
    if (layer.bin >= 0) hash.add(layer.lamp, layer.bin);
  const Environment& e = scene.environment;
  hash.add(e.radiance, e.image, e.sun.direction, e.sun.radiance, e.sun.angular_radius);
  if (e.image >= 0) {
    hash.list(scene.images[size_t(e.image)].texels8);
    hash.list(scene.images[size_t(e.image)].texels);
  }
  return hash.value;
}

}  // namespace wellspring::light
