// SPDX-License-Identifier: Apache-2.0
#include "cache/remember.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/parallel.h"
#include "base/rng.h"
#include "cache/packing.h"

namespace wellspring::cache {
namespace {

// Share of the distance; a point farther off is on another surface.
constexpr float same_place = 0.01f;
constexpr float same_normal = 0.8f;  // cosine
constexpr float same_albedo = 0.03f;
// A point whose samples repeat themselves begins anew if one sample does not: at once if all were
// alike, at the second time if all were nearly so. Few samples may be alike by chance.
constexpr float no_noise = 0.01f, little_noise = 0.1f;  // standard deviation over the mean
constexpr int few_samples = 2, many_samples = 8;
constexpr int enough_surprises = 2;
// Age added to unseen points, so that they are overwritten before seen ones.
constexpr float unseen_bonus = 96;
constexpr int noise_memory = 64;  // samples the noise estimate looks back on

bool is_usable(const Sample& sample) {
  return is_finite(sample.position) && is_finite(sample.normal) && is_finite(sample.albedo) &&
         is_finite(sample.smooth) && is_finite(sample.rest) && is_finite(sample.glow);
}

bool is_infinite(const Sample& sample) { return !(sample.flags & sample_hit); }

vec3 position_of(const PointCache& points, uint32_t i) {
  return {points.x[i], points.y[i], points.z[i]};
}

// An answer, and the part of its light that is kept.
struct Found {
  const Sample& sample;
  bool reference;
  vec3 rest;  // the sample's rest without its glow; not negative
};

// Returns whether the sample saw the surface that the point lies on, at the point (`exact`) or near
// it in the same pixel.
bool is_same_surface(const PointCache& points, uint32_t i, const View& view, const Found& found,
                     bool exact) {
  const Sample& sample = found.sample;
  bool infinite = points.flags[i] & point_infinite;
  if (infinite != is_infinite(sample) || points.color[i].object != sample.object) return false;
  if (infinite) return true;
  vec3 normal = unpack_normal(points.color[i].normal),
       offset = sample.position - position_of(points, i);
  if (dot(normal, sample.normal) < same_normal) return false;
  float distance = length(sample.position - view.position);
  float away = exact ? length(offset) : std::abs(dot(offset, normal));
  return away <= same_place * distance;
}

uint8_t flags_of(const Found& found) {
  const Sample& sample = found.sample;
  uint8_t flags = point_used;
  if (found.reference) flags |= point_reference;
  if (is_infinite(sample)) flags |= point_infinite;
  if (sample.flags & sample_specular) flags |= point_specular;
  if (sample.flags & sample_moving) flags |= point_moving;
  return flags;
}

void place_point(PointCache& points, uint32_t i, const View& view, const Found& found) {
  const Sample& sample = found.sample;
  vec3 p = sample.position, n = sample.normal;
  // At infinity, and if a technique gave no normal, the point faces the viewer.
  if (is_infinite(sample)) n = -p;
  else if (!(dot(n, n) > 0)) n = view.position - p;
  points.x[i] = p.x;
  points.y[i] = p.y;
  points.z[i] = p.z;
  points.normal[i] = points.color[i].normal = pack_normal(n);
  points.age[i] = 0;
  points.color[i].albedo = pack_albedo(sample.albedo);
}

void begin_point(PointCache& points, uint32_t i, const View& view, const Found& found,
                 uint32_t random) {
  const Sample& sample = found.sample;
  place_point(points, i, view, found);
  points.flags[i] = flags_of(found);
  points.count[i] = 1;
  points.color[i].noise = sample.flags & sample_sure ? sure_noise : uint8_t(0);
  points.color[i].doubts = 0;
  points.color[i].smooth = pack_rgb9e5(sample.smooth, random);
  points.color[i].rest = pack_rgb9e5(found.rest, random >> 4);
  points.color[i].object = sample.object;
}

// Holds what a sample did to the point that it was given to.
struct Effect {
  bool restarted = false;  // the point began anew, as its light has changed
  bool tells = false;      // change_sample is valid
  ChangeSample change_sample;
};

// Returns the standard deviation of one sample, after another that lies `step` off the mean of n.
float improve_deviation(float deviation, float step, int n) {
  if (n == 1) return std::sqrt(0.5f) * step;
  float memory = float(std::min(n, noise_memory));
  return std::sqrt((deviation * deviation * (memory - 1) + step * step * float(n) / float(n + 1)) /
                   memory);
}

// Holds the value before a sample, and the sample's own.
template <class T>
struct Heard {
  T before, now;
};
// Returns the change that a sample shows. `deviations`: standard deviations of one sample's smooth
// and rest. The change is NaN if all is black.
ChangeSample add_change_sample(uint32_t point, int n, vec3 reflectance, const Heard<vec3>& smooth,
                               const Heard<float>& rest, const vec2& deviations) {
  float before = luminance(reflectance * smooth.before) + rest.before,
        now = luminance(reflectance * max(smooth.now, vec3(0))) + rest.now,
        share = 1 / float(n + 1), mean = before + (now - before) * share;
  float noise = length(vec2(luminance(reflectance) * deviations.x, deviations.y));
  return {point, (now - before) / mean, n > 1 ? noise * std::sqrt(1 + 1 / float(n)) / mean : 0.0f};
}

// Adds one sample to the means.
Effect improve_point(PointCache& points, uint32_t i, const View& view, const Found& found,
                     bool exact, const RememberSettings& settings, uint32_t random) {
  const Sample& sample = found.sample;
  PointColor& color = points.color[i];
  vec3 smooth = unpack_rgb9e5(color.smooth), rest = unpack_rgb9e5(color.rest);
  int n = points.count[i];
  Effect effect;
  if (points.flags[i] & point_relit) {
    uint8_t shown = points.flags[i] & point_visible;
    begin_point(points, i, view, found, random);
    points.flags[i] |= shown;
    return effect;
  }
  float deviation = unpack_deviation(color.noise);
  float before = luminance(rest), now = luminance(found.rest), step = std::abs(now - before);
  float level = std::max(before, now);
  vec3 reflectance = unpack_albedo(color.albedo);
  float whole = luminance(reflectance * smooth) + level;
  // Elsewhere in the pixel a texture may differ, too: a sample shows a change of light only if the
  // reflectance is equal, and the reflectance of what a mirror shows is not known.
  effect.tells = !(points.flags[i] & point_specular) &&
                 (exact || max_component(abs(reflectance - sample.albedo)) <= same_albedo);
  float light = luminance(smooth), new_light = luminance(max(sample.smooth, vec3(0)));
  float varies = light * unpack_relative(color.doubts >> 2);
  // If two techniques differ, one of them may be biased.
  bool comparable = bool(points.flags[i] & point_reference) == settings.reference;
  effect.change_sample =
      add_change_sample(i, n, reflectance, {smooth, comparable ? sample.smooth : smooth},
                        {before, now}, {comparable ? varies : 0.0f, deviation});
  effect.tells &=
      std::isfinite(effect.change_sample.change);  // a point that stays black shows nothing
  int surprises = color.doubts & 3;
  bool alike = n >= few_samples && deviation <= no_noise * before;
  bool surprising = effect.tells && step > settings.color_change * whole && step > 4 * deviation &&
                    (alike || (n >= many_samples && deviation <= little_noise * before));
  surprises = surprising ? surprises + 1 : 0;
  if (surprising && (alike || surprises >= enough_surprises)) {
    begin_point(points, i, view, found, random);
    effect.restarted = true;
    return effect;
  }
  if (!surprising) color.noise = pack_deviation(improve_deviation(deviation, step, n), random >> 8);
  float share_new = 1 / float(n + 1), later = light + (new_light - light) * share_new;
  varies = later > 0 ? improve_deviation(varies, std::abs(new_light - light), n) / later : 0.0f;
  color.doubts = uint8_t(pack_relative(varies, random >> 12) << 2 | surprises);
  int longest =
      points.flags[i] & point_specular ? settings.longest_specular : settings.longest_mean;
  float share = 1 / float(std::min(n, longest - 1) + 1);
  smooth += (max(sample.smooth, vec3(0)) - smooth) * share;
  rest += (found.rest - rest) * share;
  if (exact) {
    points.age[i] = 0;
  } else {
    place_point(points, i, view, found);
    uint8_t kept = point_visible | point_reference;
    points.flags[i] = uint8_t((flags_of(found) & ~point_reference) | (points.flags[i] & kept));
  }
  points.count[i] = uint8_t(std::min(n + 1, longest));
  color.smooth = pack_rgb9e5(smooth, random);
  color.rest = pack_rgb9e5(rest, random >> 4);
  return effect;
}

constexpr size_t ahead = 8;  // samples by which their points are fetched early

void fetch_point(const PointCache& points, uint32_t i) {
  __builtin_prefetch(&points.color[i], 1);
  __builtin_prefetch(&points.x[i], 1);
  __builtin_prefetch(&points.y[i], 1);
  __builtin_prefetch(&points.z[i], 1);
  __builtin_prefetch(&points.normal[i], 1);
  __builtin_prefetch(&points.flags[i], 1);
  __builtin_prefetch(&points.age[i], 1);
  __builtin_prefetch(&points.count[i], 1);
}

// Returns the point of the group that will be missed least.
uint32_t choose_victim(const PointCache& points, uint32_t group) {
  uint32_t first = group * group_size, best = first;
  float best_score = -1;
  for (uint32_t i = first; i < first + group_size; i++) {
    float score = float(points.age[i]) + ((points.flags[i] & point_visible) ? 0 : unseen_bonus);
    if (!is_alive(points, i)) score = 1000;
    if (score > best_score) best = i, best_score = score;
  }
  return best;
}

// A point about to be overwritten must not show at its old place.
void hide_point(const PointCache& points, const View& view, uint32_t i, PointImage& image) {
  vec3 p = position_of(points, i);
  if (points.flags[i] & point_infinite) p += view.position;
  Projected at = project_point(view, p);
  int cx = int(std::clamp(at.x, 0.0f, float(image.width - 1)));
  int cy = int(std::clamp(at.y, 0.0f, float(image.height - 1)));
  for (int y = std::max(cy - 1, 0); y <= std::min(cy + 1, image.height - 1); y++)
    for (int x = std::max(cx - 1, 0); x <= std::min(cx + 1, image.width - 1); x++) {
      size_t pixel = size_t(y) * size_t(image.width) + size_t(x);
      if (image.point[pixel] != i) continue;
      image.point[pixel] = no_point;
      image.depth[pixel] = 0;
    }
}

void show_point(PointCache& points, const View& view, uint32_t i, size_t pixel, PointImage& image) {
  bool infinite = points.flags[i] & point_infinite;
  float depth =
      infinite ? infinite_depth : dot(position_of(points, i) - view.position, view.forward);
  if (!(depth > 0)) return;
  uint32_t before = image.point[pixel];
  if (before != no_point && before != i) points.flags[before] &= uint8_t(~point_visible);
  image.point[pixel] = i;
  image.depth[pixel] = depth;
  points.flags[i] |= point_visible | point_verified;
}

void add_anchors(PointCache& points, std::span<const Sample> samples,
                 const std::vector<uint32_t>& targets) {
  size_t most = size_t(max_anchors(points.capacity()));
  auto level = [](float v) { return uint16_t(std::clamp(v, 0.0f, 1.0f) * 65535 + 0.5f); };
  for (size_t i = 0; i < samples.size(); i++) {
    const Sample& s = samples[i];
    if (!(s.flags & sample_moving) || targets[i] == no_point) continue;
    if (points.anchors.size() < most)
      points.anchors.push_back(
          {targets[i], s.instance, s.triangle, level(s.barycentric.x), level(s.barycentric.y)});
    else
      points.age[targets[i]] =
          evicted_age;  // it shows in this frame, then goes: better a gap than a ghost
  }
}

}  // namespace

Remembered remember_samples(PointCache& points, const View& view, std::span<const Request> requests,
                            std::span<const Sample> samples, const RememberSettings& settings,
                            PointImage& image, std::vector<uint32_t>& targets) {
  size_t count = std::min(requests.size(), samples.size()), pixels = image.point.size();
  uint32_t capacity = uint32_t(points.capacity()), groups = capacity / group_size;
  Remembered result;
  targets.assign(count, no_point);
  if (groups == 0) return result;

  auto found = [&](size_t i) {
    return Found{samples[i], settings.reference, max(samples[i].rest - samples[i].glow, vec3(0))};
  };
  // This sorts out which samples have a point to join. Late answers find theirs only by its place.
  constexpr uint32_t reject = no_point - 1;  // a number beyond every capacity
  parallel_ranges(int(count), 512, [&](int begin, int end) {
    for (size_t i = size_t(begin); i < size_t(end); i++) {
      const Request& request = requests[i];
      bool here = settings.current && request.pixel < pixels;
      if (!is_usable(samples[i]) || (settings.current && !here && request.pixel != no_pixel)) {
        targets[i] = reject;
        continue;
      }
      uint32_t point = request.resample;
      if (point >= capacity || !is_alive(points, point)) point = no_point;
      if (here && point == no_point) point = image.point[request.pixel];
      if (!here && point != no_point && !is_same_surface(points, point, view, found(i), true))
        point = no_point;
      targets[i] = point;
    }
  });
  std::vector<uint32_t> additions;
  additions.reserve(count);
  for (size_t i = 0; i < count; i++) {
    if (targets[i] == no_point) additions.push_back(uint32_t(i));
    result.unplaced += targets[i] != reject && settings.current && requests[i].pixel == no_pixel;
    if (targets[i] != reject) continue;
    targets[i] = no_point;
    result.rejected++;
  }

  auto random_of = [&](size_t i) { return uint32_t(mix64(requests[i].seed ^ 0x72656d65)); };
  auto shows = [&](size_t i) { return settings.current && requests[i].pixel < pixels; };
  std::vector<Effect> effects(count);
  std::atomic<int> merged{0}, changed{0};
  parallel_ranges(int(count), 512, [&](int begin, int end) {
    int merged_here = 0, changed_here = 0;
    for (size_t i = size_t(begin); i < size_t(end); i++) {
      size_t later = i + ahead;
      if (later < size_t(end) && targets[later] != no_point) fetch_point(points, targets[later]);
      uint32_t point = targets[i];
      if (point == no_point) continue;
      bool exact = requests[i].resample == point;
      if (is_same_surface(points, point, view, found(i), exact)) {
        effects[i] = improve_point(points, point, view, found(i), exact, settings, random_of(i));
        merged_here++;
      } else {
        // The sample saw another surface than the point's: something has moved. At edges of things
        // at rest, places are not exact enough to show this.
        bool moves = ((points.flags[point] & point_moving) || (samples[i].flags & sample_moving)) &&
                     exact && !(samples[i].flags & sample_specular);
        begin_point(points, point, view, found(i), random_of(i));
        if (moves) effects[i] = {true, true, {point, 1, 0}};
      }
      changed_here += effects[i].restarted;
      if (shows(i)) show_point(points, view, point, requests[i].pixel, image);
    }
    merged += merged_here;
    changed += changed_here;
  });

  // Each new point looks at a group of its own; if there are more points than groups, they take
  // turns in rounds.
  for (size_t start = 0; start < additions.size(); start += groups) {
    size_t round = std::min(size_t(groups), additions.size() - start);
    parallel_ranges(int(round), 512, [&](int begin, int end) {
      for (size_t k = size_t(begin); k < size_t(end); k++) {
        size_t i = additions[start + k];
        uint32_t group = uint32_t((points.next_group + k) % groups);
        if (k + ahead < size_t(end))
          fetch_point(points, uint32_t((points.next_group + k + ahead) % groups) * group_size);
        uint32_t point = choose_victim(points, group);
        if (points.flags[point] & point_visible) hide_point(points, view, point, image);
        begin_point(points, point, view, found(i), random_of(i));
        if (shows(i)) show_point(points, view, point, requests[i].pixel, image);
        targets[i] = point;
      }
    });
    points.next_group = uint32_t((points.next_group + round) % groups);
  }
  // No more change samples are added than are kept, or memory would be as large as there are
  // samples.
  auto tell = size_t(std::count_if(effects.begin(), effects.begin() + ptrdiff_t(count),
                                   [](const auto& effect) { return effect.tells; }));
  size_t left_out = tell - std::min(tell, most_change_samples(image));
  keep_newest_change_samples(image, tell - left_out);
  for (size_t i = 0; i < count; i++) {
    if (effects[i].tells && (left_out == 0 || left_out-- == 0))
      image.change_samples.push_back(effects[i].change_sample);
    if (effects[i].restarted && shows(i)) image.renewed[requests[i].pixel] = 1;
  }
  add_anchors(points, samples.first(count), targets);
  result.kept = int(count) - result.rejected;
  result.merged = merged;
  result.changed = changed;
  result.added = int(additions.size());
  return result;
}

}  // namespace wellspring::cache
