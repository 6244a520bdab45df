// SPDX-License-Identifier: Apache-2.0
// Runs `wellspring bake content/ID`: bakes illumination maps of an exhibit, and keeps them for its
// server. Exit status: 0 done, 1 the input is wrong, 2 the command line is wrong.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <charconv>
#include <csignal>
#include <filesystem>
#include <iostream>
#include <fmt/core.h>

#include "about/version.h"
#include "base/clock.h"
#include "base/log.h"
#include "light/kept/bake_file.h"
#include "light/kept/complete_map.h"
#include "light/kept/finish_bake.h"
#include "light/kept/map_file.h"
#include "main_shard.h"
#include "show/exhibit/load/exhibit_load.h"
#include "show/exhibit/exhibit_objects.h"
#include "show/exhibit/pieces/exhibit_volumes.h"

using namespace wellspring;
using namespace wellspring::program;

namespace {

constexpr double save_every = 60, look_every = 1, say_elsewhere = 10;  // seconds

constexpr size_t nodes_a_gather = BakeSettings{}.direct_nodes / BakeSettings{}.gather_nodes;

std::atomic<bool> interrupted = false;
void interrupt(int) { interrupted = true; }

struct Options {
  std::string package, time = "10m", cache = "build/cache", out;
  Shard shard;
  size_t nodes = BakeSettings{}.direct_nodes;
  uint64_t passes = 0;  // to be reached; 0: as many as there is time for
  std::vector<std::string> merge;
  bool resume = false, add = false, scene_number = false;
};

// Reads seconds from "90", "90s", "10m", "2h"; below 0: the text is no duration.
double parse_duration(const std::string& text) {
  double value = 0;
  auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  std::string unit(end, text.data() + text.size());
  double scale = unit.empty() || unit == "s" ? 1 : unit == "m" ? 60 : unit == "h" ? 3600 : -1;
  return error == std::errc() && std::isfinite(value) && value > 0 ? value * scale : -1;
}

using Failure = std::runtime_error;  // The input is wrong: printed on stderr, exit status 1

// Holds the exhibit that is baked, and the files that keep the result.
struct Bakery {
  Exhibit exhibit;
  uint64_t key;
  World world;
  std::string file, light;  // state of the bake, to go on with; finished map

  Bakery(const Options& options, const BakeSettings& settings)
      : exhibit(load_exhibit(options.package, options.cache)),
        key(hash_scene(exhibit.scene)),
        world(exhibit.scene),
        file(options.out),
        light(shipped_light(options.package)) {
    place_volumes(exhibit, world);
    if (!file.empty()) {
      light = std::filesystem::path(file).replace_extension(".maps").string();
      return;
    }
    file = options.cache + "/" + exhibit.id;
    if (settings.shards > 1)
      file += "." + std::to_string(settings.shard + 1) + "of" + std::to_string(settings.shards);
    file += ".bake";
  }
  void keep(const Bake& bake) const {
    if (!save_bake(bake, file, key)) throw Failure(file + ": cannot be written");
  }
  // Keeps the bake, and unless it is a shard its map, too.
  void finish(Bake& bake) const {
    keep(bake);
    std::cout << file << ": " << bake.passes << " passes, error " << 100 * bake_error(bake)
              << " %\n";
    if (bake.settings.shards > 1) return;
    std::shared_ptr<const IlluminationMap> map = finish_map(world, all_eye_places(exhibit), bake);
    if (!map) return;
    if (!save_map(world, *map, light, key)) throw Failure(light + ": cannot be written");
    std::cout << light << ": " << std::filesystem::file_size(light) << " bytes, error "
              << 100 * map->error << " %\n";
  }
};

Bake merge(const Bakery& bakery, const Options& options) {
  Bake whole;
  for (size_t i = 0; i < options.merge.size(); i++) {
    const std::string& file = options.merge[i];
    Bake part;
    switch (load_bake(bakery.world, file, bakery.key, part)) {
      case KeyedFile::read: break;
      case KeyedFile::missing: throw Failure(file + ": not found");
      case KeyedFile::damaged: throw Failure(file + ": damaged");
      case KeyedFile::another_key:
        throw Failure(file + ": stale: the scene of " + options.package + " has changed");
    }
    if (i == 0) whole = std::move(part);
    else if (!merge_bake(part, whole))
      throw Failure(file + ": not another shard of the same bake as " + options.merge[0]);
  }
  if (whole.settings.shards > 1)
    throw Failure("shards are missing: " + std::to_string(whole.shards_done.size()) + " of " +
                  std::to_string(whole.settings.shards) + " are there");
  whole.source = options.package;  // shards may have been baked elsewhere
  return whole;
}

// Returns the last bake's state, if it is wanted and can be used, else a new bake.
Bake begin(const Bakery& bakery, const Options& options, const BakeSettings& settings) {
  Bake bake;
  KeyedFile found =
      options.resume ? load_bake(bakery.world, bakery.file, bakery.key, bake) : KeyedFile::missing;
  if (found == KeyedFile::another_key)
    std::cerr << "wellspring bake: " << bakery.file
              << ": stale: the scene has changed; it begins anew\n";
  if (found == KeyedFile::damaged)
    std::cerr << "wellspring bake: " << bakery.file << ": damaged; it begins anew\n";
  if (found != KeyedFile::read) {
    bake = begin_bake(bakery.world, eye_places(bakery.exhibit), settings);
    bake.source = options.package;
  } else if (bake.settings.shard != settings.shard || bake.settings.shards != settings.shards ||
             bake.settings.direct_nodes != settings.direct_nodes) {
    throw Failure(bakery.file + ": is of another shard, or of other --nodes");
  }
  return bake;
}

// Goes on for so long, or up to a number of passes: then the bits are the same wherever it is
// baked, and however often it is interrupted.
void go_on_for(double seconds, uint64_t passes, const Bakery& bakery, Bake& bake) {
  if (passes > 0 && (bake.passes > passes || (bake.passes == passes && bake.cursor > 0)))
    throw Failure(fmt::format("{}: has more than {} passes", bakery.file, passes));
  const auto is_done = [&](double now, double until) {
    return interrupted || (passes > 0 ? bake.passes >= passes : now >= until);
  };
  const BakeScene scene = make_bake_scene(bakery.world, eye_places(bakery.exhibit));
  const double began = seconds_now();
  double saved = began;
  Progress progress("bake", say_elsewhere);
  for (double now = began; bake.charts.tiles > 0 && !is_done(now, began + seconds);
       now = seconds_now()) {
    const double until = std::min(now + look_every, passes > 0 ? 1e300 : began + seconds);
    go_on(scene, bake, [&] { return seconds_now() >= until || is_done(now, until); });
    const double part = bake.charts.tiles > 0 ? double(bake.cursor) / bake.charts.tiles : 0,
                 share = passes > 0
                             ? (double(bake.passes) + (bake.pilot() ? 0 : part)) / double(passes)
                             : (now - began) / seconds;
    progress.tell(share,
                  fmt::format("{} passes, error {:.1f} %", bake.passes, 100 * bake_error(bake)));
    if (now - saved < save_every) continue;
    bakery.keep(bake);
    saved = now;
  }
  if (!interrupted || passes == 0 || bake.passes >= passes) return;
  bakery.keep(bake);
  throw Failure(
      fmt::format("interrupted after {} of {} passes: --resume goes on", bake.passes, passes));
}

// Adds what light.maps lacks.
void add_to_map(const Bakery& bakery, const BakeSettings& settings, double seconds) {
  const LoadedMap known = load_map(bakery.world, bakery.light, bakery.key);
  if (!known.map) throw Failure(bakery.light + ": there is no light that could be added to");
  if (known.found == KeyedFile::read) {
    std::cout << bakery.light << ": nothing has changed\n";
    return;
  }
  BakeSettings alike = settings;
  alike.tile = known.map->places->tile;
  const std::vector<vec3> places = eye_places(bakery.exhibit);
  Bake bake = begin_bake(bakery.world, places, alike);
  bake.sampled = find_new_tiles(bakery.world, bake, known, reach_of_neighbours);
  std::cout << std::ranges::count(bake.sampled, char(1)) << " of " << bake.charts.tiles
            << " tiles are new or near new things\n";
  const BakeScene scene = make_bake_scene(bakery.world, places);
  Progress progress("bake", say_elsewhere);
  const double began = seconds_now();
  for (double now = began; !interrupted && (bake.passes == 0 || now - began < seconds);
       now = seconds_now()) {
    go_on(scene, bake, [&] { return interrupted || seconds_now() >= now + look_every; });
    progress.tell((now - began) / seconds, fmt::format("{} passes", bake.passes));
  }
  const auto fresh = finish_map(bakery.world, all_eye_places(bakery.exhibit), bake);
  if (!fresh) throw Failure("interrupted too early: " + bakery.light + " is as it was");
  const auto map = complete_map(bakery.world, bake, *known.map, *fresh,
                                find_new_tiles(bakery.world, bake, known));
  if (!save_map(bakery.world, *map, bakery.light, bakery.key))
    throw Failure(bakery.light + ": cannot be written");
  std::cout << bakery.light << ": " << std::filesystem::file_size(bakery.light) << " bytes\n";
}

void run(const Options& options, const BakeSettings& settings, double seconds) {
  const Bakery bakery(options, settings);
  if (options.scene_number) {
    std::cout << fmt::format("{:016x}\n", bakery.key);
    return;
  }
  if (options.add) return add_to_map(bakery, settings, seconds);
  Bake bake;
  if (!options.merge.empty()) {
    bake = merge(bakery, options);
  } else {
    bake = begin(bakery, options, settings);
    go_on_for(seconds, options.passes, bakery, bake);
    const size_t texels = bake.direct.nodes(), layers = size_t(bake.direct.layers);
    std::cout << bake.charts.surfaces.size() << " charts, " << texels << " texels, " << layers
              << " layers: " << texels * 4 * layers << " bytes, " << vertex_bytes(bake)
              << " at vertices of a mesh as fine\n";
    if (interrupted) std::cout << "interrupted: --resume goes on\n";
  }
  bakery.finish(bake);
}

}  // namespace

int main(int argc, char** argv) {
  if (answer_version(argc, argv)) return 0;
  log::start("bake");
  CLI::App app{"Bakes illumination maps: the diffuse light of what stands still."};
  Options options;
  app.add_option("package", options.package, "folder of the exhibit, e.g. content/castle");
  CLI::Option* time = app.add_option("--time", options.time, "how long: 90s, 10m, 8h");
  app.add_option("--passes", options.passes,
                 "how many, instead of a time: the same bits on all machines of one kind")
      ->check(CLI::Range(1, 1000000))
      ->excludes(time);
  app.add_option("--nodes", options.nodes, "places of direct light at most, about: size and time")
      ->check(CLI::Range(1000, 100'000'000))
      ->capture_default_str();
  app.add_flag("--resume", options.resume, "goes on where the last one ended");
  app.add_flag("--add", options.add,
               "keeps the light of light.maps where things stand as they did, and finds that of "
               "new things and what is near them");
  add_shard(app, options.shard, "i/N: every N-th part, for N machines; merge afterwards");
  app.add_option("--merge", options.merge, "files of all shards: one bake is made of them");
  app.add_flag("--scene-number", options.scene_number,
               "prints the number of the scene, by which files of its light know it");
  app.add_option("--cache", options.cache, "folder where servers look for it");
  app.add_option("--out", options.out, "file, instead of one in that folder");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  if (options.package.empty() && !options.merge.empty())
    options.package = read_bake_source(options.merge.front());
  if (options.package.empty()) {
    if (!options.merge.empty()) {
      std::cerr << "wellspring bake: " << options.merge.front() << ": not a bake\n";
      return 1;
    }
    std::cerr << "a folder such as content/castle is expected\n";
    return 2;
  }
  BakeSettings settings;
  const double seconds = parse_duration(options.time);
  if (!(seconds > 0)) {
    std::cerr << "--time " << options.time << ": a time such as 90s, 10m or 8h is expected\n";
    return 2;
  }
  settings.direct_nodes = options.nodes;
  settings.gather_nodes = options.nodes / nodes_a_gather;
  settings.shard = options.shard.index, settings.shards = options.shard.count;
  std::signal(SIGINT, interrupt);
  std::signal(SIGTERM, interrupt);
  try {
    run(options, settings, seconds);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "wellspring bake: " << error.what() << "\n";
    return 1;
  }
}
