// SPDX-License-Identifier: Apache-2.0
#include "object_samples.h"

#include <algorithm>
#include <atomic>
#include <bit>

#include "base/memory.h"
#include "base/parallel.h"
#include "fine_normal.h"
#include "level_lanes.h"

namespace wellspring::test {
namespace {

// Calls the function with every array of a list.
template <class Samples, class Function>
void each_array(Samples& list, const Function& function) {
  function(list.x);
  function(list.y);
  function(list.z);
  function(list.normal);
  function(list.facing);
  function(list.width);
  function(list.age);
  function(list.words);
}

// The others stay in their order. `drops(i)` is asked once for each i, in order. Returns how many
// went.
template <class Drops>
int drop_samples(LevelSamples& list, const Drops& drops) {
  size_t count = list.age.size(), first = 0;
  while (first < count && !drops(first)) first++;
  if (first == count) return 0;
  struct Run {
    size_t begin, end;
  };
  std::vector<Run> kept;  // samples of one age mostly lie side by side
  for (size_t i = first + 1; i < count; i++) {
    if (drops(i)) continue;
    if (kept.empty() || kept.back().end != i) kept.push_back({i, i});
    kept.back().end++;
  }
  each_array(list, [&](auto& array) {
    auto to = array.begin() + ptrdiff_t(first);
    for (Run run : kept)
      to = std::copy(array.begin() + ptrdiff_t(run.begin), array.begin() + ptrdiff_t(run.end), to);
    array.erase(to, array.end());
  });
  return int(count - list.age.size());
}

size_t slot_of(const SampleStore& store, uint32_t object) {
  auto found = std::lower_bound(store.objects.begin(), store.objects.end(), object,
                                [](const ObjectSamples& a, uint32_t id) { return a.object < id; });
  return size_t(found - store.objects.begin());
}
ObjectSamples* find_object(SampleStore& store, uint32_t object) {
  size_t slot = slot_of(store, object);
  bool known = slot < store.objects.size() && store.objects[slot].object == object;
  return known ? &store.objects[slot] : nullptr;
}
ObjectSamples& enter_object(SampleStore& store, uint32_t object) {
  if (ObjectSamples* known = find_object(store, object)) return *known;
  ObjectSamples samples;
  samples.object = object;
  samples.levels.resize(size_t(store.grid.levels));
  return *store.objects.insert(store.objects.begin() + ptrdiff_t(slot_of(store, object)),
                               std::move(samples));
}

// Drops the oldest until a little less than `bound` are left.
void keep_newest(std::span<ObjectSamples> objects, int count, int bound) {
  bound = std::max(bound, 0);
  if (count <= bound) return;
  std::vector<uint32_t> ages;
  ages.reserve(size_t(count));
  for (const ObjectSamples& object : objects)
    for (const LevelSamples& list : object.levels)
      ages.insert(ages.end(), list.age.begin(), list.age.end());
  size_t drop = size_t(count - (bound - bound / 16));
  uint32_t cut = ~0u;  // all that are older go, and of those that are as old the `rest`
  if (drop < ages.size()) {
    std::nth_element(ages.begin(), ages.begin() + ptrdiff_t(drop), ages.end());
    cut = ages[drop];
  }
  size_t older =
      size_t(std::count_if(ages.begin(), ages.end(), [&](uint32_t a) { return a < cut; }));
  size_t rest = drop - older, levels = objects.empty() ? 0 : objects[0].levels.size();
  for (size_t level = levels; level-- > 0;)
    for (ObjectSamples& object : objects) {
      LevelSamples& list = object.levels[level];
      drop_samples(list, [&](size_t i) {
        if (list.age[i] != cut) return list.age[i] < cut;
        bool goes = rest > 0;
        rest -= goes;
        return goes;
      });
    }
}

// Counts of one object by age difference, up to max_age.
struct AgeCounts {
  std::vector<uint32_t> total, invalid;
  std::vector<uint8_t> dead;
  bool any_dead = false;
};

void count_invalid(const LevelSamples& list, float delta, vec3 eye, uint32_t age, uint32_t max_age,
                   AgeCounts& counts) {
  for (int i = 0; i < list.count(); i += lane_count) {
    int here = std::min(lane_count, list.count() - i);
    Lanes3 to_eye = all_lanes(eye) - load_places(list, i, here);
    Lanes3 normal = unpack_fine_normal(load_some<LaneBits>(&list.normal[size_t(i)], here));
    Lanes facing = dot(normal, to_eye) / lanes_sqrt(dot(to_eye, to_eye));
    Lanes change = lanes_abs(facing - load_some(&list.facing[size_t(i)], here));
    // A comparison with NaN is false: an eye in the very place of a sample sees it no longer.
    unsigned valid = negative_lanes(change <= delta), all = (1u << here) - 1;
    const uint32_t* ages = &list.age[size_t(i)];
    auto count = [&](uint32_t then, unsigned lanes) {
      uint32_t difference = age > then ? age - then : 0;
      if (difference > max_age) return;
      counts.total[difference] += uint32_t(std::popcount(lanes));
      counts.invalid[difference] += uint32_t(std::popcount(lanes & ~valid));
    };
    if (std::all_of(ages, ages + here, [&](uint32_t a) { return a == ages[0]; }))
      count(ages[0], all);
    else
      for (int k = 0; k < here; k++) count(ages[k], 1u << k);
  }
}

int drop_aged(ObjectSamples& object, uint32_t age, uint32_t max_age, const AgeCounts& counts) {
  int dropped = 0;
  for (LevelSamples& list : object.levels) {
    uint32_t oldest = age;
    for (uint32_t then : list.age) oldest = std::min(oldest, then);
    if (!counts.any_dead && age - oldest <= max_age) continue;
    dropped += drop_samples(list, [&](size_t i) {
      uint32_t difference = age > list.age[i] ? age - list.age[i] : 0;
      return difference > max_age || counts.dead[difference];
    });
  }
  return dropped;
}

AgeingStats age_object(ObjectSamples& object, vec3 eye, uint32_t age,
                       const AgeingSettings& settings, AgeCounts& counts) {
  AgeingStats stats;
  uint32_t max_age = std::min(settings.max_age, 65535u);
  counts.total.assign(max_age + 1, 0);
  counts.invalid.assign(max_age + 1, 0);
  counts.dead.assign(max_age + 1, 0);
  counts.any_dead = false;
  auto first = std::find_if(object.levels.begin(), object.levels.end(), [&](const auto& list) {
    return list.count() >= std::max(settings.least_samples, 1);
  });
  for (auto list = object.levels.begin(); list != object.levels.end(); ++list)
    if (first == object.levels.end() || list == first)
      count_invalid(*list, object.delta, eye, age, max_age, counts);
  for (uint32_t i = 0; i <= max_age; i++) {
    stats.checked += int(counts.total[i]);
    stats.invalid += int(counts.invalid[i]);
    counts.dead[i] = 2 * counts.invalid[i] > counts.total[i];
    counts.any_dead |= counts.dead[i] != 0;
  }
  stats.dropped = drop_aged(object, age, max_age, counts);
  return stats;
}

}  // namespace

int ObjectSamples::count() const {
  int sum = 0;
  for (const LevelSamples& list : levels) sum += list.count();
  return sum;
}

int SampleStore::count() const {
  int sum = 0;
  for (const ObjectSamples& object : objects) sum += object.count();
  return sum;
}

int add_samples(SampleStore& store, const View& view, uint32_t age,
                std::span<const CorrectiveSample> samples) {
  int added = 0;
  std::vector<uint32_t> grown;
  float pixel = 2 * view.tan_half_fov / float(view.height);  // wide at a depth of 1
  for (const CorrectiveSample& sample : samples) {
    if (sample.object == 0 || sample.level < 1 || sample.level > store.grid.levels) continue;
    float length = glm::length(sample.normal),
          distance = glm::length(view.position - sample.position);
    float width = dot(sample.position - view.position, view.forward) * pixel;
    bool finite = is_finite(sample.position) && std::isfinite(length) && std::isfinite(distance);
    if (!finite || !(length > 0) || !(distance > 0) || !(width > 0)) continue;
    uint32_t normal = pack_fine_normal(sample.normal / length);
    vec3 as_kept = unpack_fine_normal(all_lane_bits(normal)).at(0);
    LevelSamples& list = enter_object(store, sample.object).levels[size_t(sample.level - 1)];
    list.x.push_back(sample.position.x);
    list.y.push_back(sample.position.y);
    list.z.push_back(sample.position.z);
    list.normal.push_back(normal);
    list.facing.push_back(dot(as_kept, view.position - sample.position) / distance);
    list.width.push_back(width);
    list.age.push_back(age);
    list.words.push_back(sample.words);
    if (grown.empty() || grown.back() != sample.object) grown.push_back(sample.object);
    added++;
  }
  std::sort(grown.begin(), grown.end());
  grown.erase(std::unique(grown.begin(), grown.end()), grown.end());
  for (uint32_t id : grown) {
    ObjectSamples& object = *find_object(store, id);
    keep_newest({&object, 1}, object.count(), store.limits.most_of_object);
  }
  if (added > 0) keep_newest(store.objects, store.count(), store.limits.most);
  return added;
}

float delta_of(float roughness) {
  if (!(roughness > 0)) return 0.05f;  // NaN, too
  return 0.05f + 0.15f * std::min(roughness, 1.0f);
}

void set_delta(SampleStore& store, uint32_t object, float delta) {
  if (object != 0 && std::isfinite(delta)) enter_object(store, object).delta = delta;
}

AgeingStats age_samples(SampleStore& store, vec3 eye, uint32_t age,
                        const AgeingSettings& settings) {
  std::atomic<int> checked = 0, invalid = 0, dropped = 0;
  parallel_ranges(int(store.objects.size()), 4, [&](int begin, int end) {
    AgeCounts counts;
    for (int i = begin; i < end; i++) {
      ObjectSamples& object = store.objects[size_t(i)];
      if (object.count() == 0) continue;
      AgeingStats stats = age_object(object, eye, age, settings, counts);
      checked += stats.checked;
      invalid += stats.invalid;
      dropped += stats.dropped;
    }
  });
  return {checked, invalid, dropped};
}

}  // namespace wellspring::test
