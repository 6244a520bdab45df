// SPDX-License-Identifier: Apache-2.0
#include "light/bake/bake_file.h"

#include <algorithm>

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
  const int layers = int(layer_count(world.scene()));
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
  // All are there: from now on it is as if it had been one.
  bake.settings.shard = 0, bake.settings.shards = 1, bake.cursor = 0;
  bake.shards_done = {0};
  return true;
}

}  // namespace wellspring::light
