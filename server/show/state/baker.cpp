// SPDX-License-Identifier: Apache-2.0
#include "show/state/baker.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <oneapi/tbb/task_arena.h>
#include <pthread.h>

#include "base/clock.h"
#include "base/log.h"
#include "base/worker.h"
#include "light/kept/bake_file.h"
#include "light/kept/finish_bake.h"
#include "light/kept/map_file.h"

namespace wellspring::show {
namespace {

constexpr double look_every = 0.05, save_every = 120, at_a_time = 1;  // seconds
// a map is shown if its error is at most this share of the last one's
constexpr float better = 0.97f;
constexpr uint32_t ahead = 16;  // passes that tiles in view may be ahead

// Does the work on all cores, or on one thread of the lowest priority, to which others leave what
// they do not need.
template <class Work>
void work_on(BakerCores cores, const Work& work) {
  if (cores == BakerCores::all) return work();
  std::exception_ptr failure;
  std::thread([&, token = cancel_token()] {
    const CancelScope scope(token);
    const sched_param lowest{};
    // if it is refused, the thread is only less polite
    pthread_setschedparam(pthread_self(), SCHED_IDLE, &lowest);
    try {
      tbb::task_arena(1).execute(work);
    } catch (...) {
      failure = std::current_exception();
    }
  }).join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace

Baker::Baker(const Scene& scene, BakerSettings settings)
    : scene_(scene), settings_(std::move(settings)) {
  thread_ = std::jthread([this](const std::stop_token& end) {
    const CancelScope scope(end);
    try {
      live(end);
    } catch (const Cancelled&) {}  // nothing had to be saved yet
  });
}

Baker::~Baker() = default;

std::shared_ptr<const IlluminationMap> Baker::take() {
  std::lock_guard lock(mutex_);
  return std::exchange(found_, nullptr);
}

BakerStatus Baker::status() const {
  std::lock_guard lock(mutex_);
  return status_;
}

bool Baker::wait_until_allowed(const std::stop_token& end) {
  while (cores_ == BakerCores::none && !end.stop_requested())
    std::this_thread::sleep_for(std::chrono::duration<double>(look_every));
  return !end.stop_requested();
}

void Baker::look(std::vector<Ray> rays) {
  std::lock_guard lock(mutex_);
  looks_ = std::move(rays);
}

// Bakes ahead what visitors look at. Returns false if that needs nothing before the rest.
bool Baker::go_ahead_where_looked(const BakeScene& scene, Bake& bake) {
  std::vector<Ray> rays;
  {
    std::lock_guard lock(mutex_);
    rays = looks_;
  }
  return !rays.empty() && go_ahead(scene, bake, find_tiles(scene.world, bake, rays), ahead);
}

// Publishes the map if it is better than the one that is shown.
void Baker::publish(const World& world, Bake& bake, uint64_t key, float& shown) {
  std::shared_ptr<const IlluminationMap> map = finish_map(world, settings_.eyes, bake);
  if (!map || map->error > better * shown) return;
  shown = map->error;
  if (!save_map(world, *map, settings_.file + ".maps", key))
    log::warn("{}.maps cannot be written: the next start knows less light", settings_.file);
  else if (settings_.as_kept)
    if (auto kept = load_map(world, settings_.file + ".maps", key).map) map = std::move(kept);
  std::lock_guard lock(mutex_);
  found_ = std::move(map);
}

void Baker::live(const std::stop_token& end) {
  World world(scene_);
  world.place_volumes(settings_.volumes);
  if (!wait_until_allowed(end)) return;
  const uint64_t key = hash_scene(scene_);
  const std::string file = settings_.file + ".bake";
  Bake bake;
  KeyedFile found = load_bake(world, file, key, bake);
  if (found == KeyedFile::another_key)
    log::info("{} is stale: the scene has changed; it is baked anew", file);
  if (found == KeyedFile::damaged) log::warn("{} is damaged; it is baked anew", file);
  if (found != KeyedFile::read || bake.settings.shards > 1)
    bake = begin_bake(world, settings_.places, settings_.bake);
  if (bake.charts.tiles == 0) return;  // nothing is diffuse
  bake.source = settings_.source;
  float error = bake.passes > 0 ? bake_error(bake) : 1;
  float shown = std::min(settings_.shown_error, most_sure_error);
  uint64_t next = bake.passes + 1;  // number of passes after which the map is looked at again
  double saved = seconds_now();
  auto tell = [&](bool works) {
    std::lock_guard lock(mutex_);
    status_ = {works, bake.passes, error};
  };
  tell(false);
  if (error <= settings_.least_error) return;
  BakeScene scene = make_bake_scene_of_paths(world);
  scene.known = settings_.known;
  while (wait_until_allowed(end) && error > settings_.least_error) {
    const double began = seconds_now();
    const BakerCores cores = cores_;
    tell(cores == BakerCores::all);
    auto stop = [&] {
      return cores_ != cores || end.stop_requested() || seconds_now() - began > at_a_time;
    };
    work_on(cores, [&] {
      if (cores == BakerCores::all || !go_ahead_where_looked(scene, bake)) go_on(scene, bake, stop);
      if (!bake.pilot() && bake.passes > 1) error = bake_error(bake);
      if (bake.pilot() || bake.passes < next) return;
      publish(world, bake, key, shown);
      next = 2 * bake.passes;
    });
    if (seconds_now() - saved > save_every) {
      if (!save_bake(bake, file, key)) log::warn("{} cannot be written", file);
      saved = seconds_now();
    }
    tell(false);
  }
  if (bake.passes > 0 && !save_bake(bake, file, key)) log::warn("{} cannot be written", file);
}

}  // namespace wellspring::show
