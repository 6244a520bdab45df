// SPDX-License-Identifier: Apache-2.0
// wellspring bake content/ID: illumination maps of an exhibit, kept where its server finds them.
// Exit status: 0 done, 1 the input is wrong, 2 the command line is wrong.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <cmath>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <iostream>

#include "base/clock.h"
#include "base/log.h"
#include "light/bake/bake_file.h"
#include "light/bake/finish_bake.h"
#include "light/bake/map_file.h"
#include "show/exhibit/exhibit_load.h"
#include "show/exhibit/eye_places.h"

using namespace wellspring;

namespace {

constexpr double save_every = 60, say_every = 1;  // seconds

std::atomic<bool> interrupted = false;
void interrupt(int) { interrupted = true; }

struct Options {
  std::string package, time = "10m", shard, cache = "build/cache", out;
  std::vector<std::string> merge;
  bool resume = false;
};

// "90", "90s", "10m", "2h"; below 0: it is none.
double parse_duration(const std::string& text) {
  double value = 0;
  auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  std::string unit(end, text.data() + text.size());
  double scale = unit.empty() || unit == "s" ? 1 : unit == "m" ? 60 : unit == "h" ? 3600 : -1;
  return error == std::errc() && std::isfinite(value) && value > 0 ? value * scale : -1;
}

bool parse_shard(const std::string& text, BakeSettings& settings) {
  int shard = 0, shards = 0, used = 0;
  if (std::sscanf(text.c_str(), "%d/%d%n", &shard, &shards, &used) != 2 ||
      size_t(used) != text.size() || shards < 1 || shards > 4096 || shard < 0 || shard > shards)
    return false;
  settings.shard = (shard + shards - 1) % shards;  // counted from 1, or from 0
  settings.shards = shards;
  return true;
}

void say(const Bake& bake, double left) {
  char line[160];
  std::snprintf(line, sizeof line, "bake: %.0f s left, %llu passes, error %.1f %%", left,
                (unsigned long long)bake.passes, 100.0 * double(bake_error(bake)));
  if (isatty(2)) std::cerr << "\r\033[K" << line << std::flush;
  else std::cerr << line << "\n";
}

void describe(const Bake& bake) {
  std::cout << bake.charts.surfaces.size() << " charts, " << bake.direct.nodes() << " texels, "
            << bake.direct.layers
            << " layers: " << bake.direct.nodes() * 4 * size_t(bake.direct.layers) << " bytes, "
            << vertex_bytes(bake) << " if the mesh were divided as finely\n";
}

[[nodiscard]] int fail(const std::string& what) {
  std::cerr << "wellspring bake: " << what << "\n";
  return 1;
}

// The bake, and unless it is a shard the map that comes of it. Empty, or what is wrong.
std::string save(const Bake& bake, const std::string& file, uint64_t key) {
  if (!save_bake(bake, file, key)) return file + ": cannot be written";
  std::shared_ptr<const IlluminationMap> map =
      bake.settings.shards > 1 ? nullptr : finish_map(bake);
  const std::string maps = std::filesystem::path(file).replace_extension(".maps").string();
  if (map && !save_map(*map, maps, key)) return maps + ": cannot be written";
  return {};
}

int run(const Options& options, const BakeSettings& settings, double seconds) {
  const Exhibit exhibit = load_exhibit(options.package);
  const std::vector<vec3> places = eye_places(exhibit);
  const uint64_t key = hash_scene(exhibit.scene);
  World world(exhibit.scene);
  std::string file = options.out;
  if (file.empty()) {
    file = options.cache + "/" + exhibit.id;
    if (settings.shards > 1)
      file += "." + std::to_string(settings.shard + 1) + "of" + std::to_string(settings.shards);
    file += ".bake";
  }
  Bake bake;
  if (!options.merge.empty()) {
    for (size_t i = 0; i < options.merge.size(); i++) {
      Bake part;
      KeyedFile found = load_bake(world, options.merge[i], key, part);
      if (found == KeyedFile::another_key)
        return fail(options.merge[i] + ": stale: the scene of " + options.package + " has changed");
      if (found != KeyedFile::read)
        return fail(options.merge[i] + (found == KeyedFile::missing ? ": not found" : ": damaged"));
      if (i == 0) bake = std::move(part);
      else if (!merge_bake(part, bake))
        return fail(options.merge[i] + ": not another shard of the same bake as " +
                    options.merge[0]);
    }
    if (bake.settings.shards > 1)
      return fail("shards are missing: " + std::to_string(bake.shards_done.size()) + " of " +
                  std::to_string(bake.settings.shards) + " are there");
    if (std::string wrong = save(bake, file, key); !wrong.empty()) return fail(wrong);
    std::cout << file << ": " << bake.passes << " passes, error " << 100 * bake_error(bake)
              << " %\n";
    return 0;
  }
  bool fresh = true;
  if (options.resume) {
    KeyedFile found = load_bake(world, file, key, bake);
    if (found == KeyedFile::another_key)
      std::cerr << "wellspring bake: " << file
                << ": stale: the scene has changed; it begins anew\n";
    else if (found == KeyedFile::damaged)
      std::cerr << "wellspring bake: " << file << ": damaged; it begins anew\n";
    fresh = found != KeyedFile::read;
    if (!fresh &&
        (bake.settings.shard != settings.shard || bake.settings.shards != settings.shards))
      return fail(file + ": is of another shard");
  }
  if (fresh) bake = begin_bake(world, places, settings);
  bake.source = options.package;
  const BakeScene scene = make_bake_scene(world, places);
  const double began = seconds_now();
  double said = 0, saved = began;
  while (!interrupted && bake.charts.tiles > 0 && seconds_now() - began < seconds) {
    const double until = std::min(seconds_now() + say_every, began + seconds);
    go_on(scene, bake, [&] { return interrupted || seconds_now() >= until; });
    if (double now = seconds_now(); now - said >= (isatty(2) ? say_every : 10 * say_every))
      say(bake, seconds - (now - began)), said = now;
    if (seconds_now() - saved < save_every) continue;
    if (!save_bake(bake, file, key)) return fail(file + ": cannot be written");
    saved = seconds_now();
  }
  if (isatty(2)) std::cerr << "\r\033[K";
  if (std::string wrong = save(bake, file, key); !wrong.empty()) return fail(wrong);
  describe(bake);
  std::cout << file << ": " << bake.passes << " passes, error " << 100 * bake_error(bake) << " %"
            << (interrupted ? ", interrupted: --resume goes on" : "") << "\n";
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  log::start("bake");
  CLI::App app{"Bakes illumination maps: the diffuse light of what stands still."};
  Options options;
  app.add_option("package", options.package, "folder of the exhibit, e.g. content/castle");
  app.add_option("--time", options.time, "how long: 90s, 10m, 8h");
  app.add_flag("--resume", options.resume, "goes on where the last one ended");
  app.add_option("--shard", options.shard,
                 "i/N: every N-th part, for N machines; merge afterwards");
  app.add_option("--merge", options.merge, "files of all shards: one bake is made of them");
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
    if (!options.merge.empty()) return fail(options.merge.front() + ": not a bake");
    std::cerr << "a folder such as content/castle is expected\n";
    return 2;
  }
  BakeSettings settings;
  const double seconds = parse_duration(options.time);
  if (!(seconds > 0)) {
    std::cerr << "--time " << options.time << ": a time such as 90s, 10m or 8h is expected\n";
    return 2;
  }
  if (!options.shard.empty() && !parse_shard(options.shard, settings)) {
    std::cerr << "--shard " << options.shard << ": i/N is expected, i from 1 to N\n";
    return 2;
  }
  std::signal(SIGINT, interrupt);
  std::signal(SIGTERM, interrupt);
  try {
    return run(options, settings, seconds);
  } catch (const std::exception& error) {
    return fail(error.what());
  }
}
