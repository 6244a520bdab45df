// SPDX-License-Identifier: Apache-2.0
#include "volume/draw/preset.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace wellspring::volume {

TransferTable::TransferTable(const Preset& preset, const ShownVolume& volume)
    : mode_(preset.mode), entries_(steps), seen_(steps + 1) {
  const std::vector<PresetPoint>& points = preset.points;
  threshold_ = volume.code_of(points.front().value);
  const double unit = mode_ == VolumeMode::maximum ? 1 : 1000;  // per metre
  for (int i = 0; i < steps; i++) {
    const double value = volume.low + (volume.high - volume.low) * i / (steps - 1);
    const auto after = std::ranges::upper_bound(points, value, {}, &PresetPoint::value);
    const PresetPoint& b = after == points.end() ? points.back() : *after;
    const PresetPoint& a = after == points.begin() ? points.front() : *std::prev(after);
    const double way =
        b.value > a.value ? std::clamp((value - a.value) / (b.value - a.value), 0.0, 1.0) : 0;
    const vec3 color = a.color + (b.color - a.color) * float(way);
    entries_[size_t(i)] = {color.x, color.y, color.z,
                           float(unit * (a.density + (b.density - a.density) * way))};
  }
  for (int i = 0; i < steps; i++)
    seen_[size_t(i) + 1] = seen_[size_t(i)] + (entries_[size_t(i)].density > 0);
  std::vector<float>& each = largest_.emplace_back();
  for (const Entry& entry : entries_) each.push_back(entry.density);
  for (size_t half = 1; 2 * half <= size_t(steps); half *= 2) {
    std::vector<float> row(size_t(steps) - 2 * half + 1);
    for (size_t i = 0; i < row.size(); i++)
      row[i] = std::max(largest_.back()[i], largest_.back()[i + half]);
    largest_.push_back(std::move(row));
  }
}

Lanes3 TransferTable::look(const Lanes& codes, Lanes& density) const {
  const Lanes at = codes * (float(steps - 1) / most_code) + 0.5f;
  const LaneMask index = __builtin_convertvector(at, LaneMask);
  LaneBits red, green, blue, thick;
  transpose_records([&](int i) { return &entries_[size_t(index[i])].red; }, red, green, blue,
                    thick);
  density = lanes_as<Lanes>(thick);
  return {lanes_as<Lanes>(red), lanes_as<Lanes>(green), lanes_as<Lanes>(blue)};
}

TransferTable::EntryRange TransferTable::entries_of(const CodeRange& range) {
  // The entries next to the range are rounded to.
  const float scale = float(steps - 1) / most_code;
  return {int(float(range.least) * scale), std::min(int(float(range.most) * scale) + 1, steps - 1)};
}

float TransferTable::largest_density(const CodeRange& range) const {
  if (range.least > range.most) return 0;
  const auto [first, last] = entries_of(range);
  const int row = std::bit_width(unsigned(last - first + 1)) - 1;
  const std::vector<float>& largest = largest_[size_t(row)];
  return std::max(largest[size_t(first)], largest[size_t(last + 1 - (1 << row))]);
}

bool TransferTable::is_empty(const CodeRange& range) const {
  if (range.least > range.most) return true;
  if (mode_ == VolumeMode::surface) return float(range.most) < threshold_;
  const auto [first, last] = entries_of(range);
  return seen_[size_t(last) + 1] == seen_[size_t(first)];
}

namespace {

constexpr int bins = code_bins, most_classes = 4;
constexpr double least_share = 1e-5;  // a class with fewer of the samples is noise

struct Histogram {
  std::vector<double> count;
  double all = 0;
};

// Splits the bins into so many classes that the variance between classes is largest. Bins count by
// the square root of their samples: bone and metal are a small part of a scan. Returns the first
// bins of all classes but the first.
std::vector<int> split_bins(const Histogram& histogram, int classes) {
  std::vector<double> weight(bins + 1), moment(bins + 1);
  for (int i = 0; i < bins; i++) {
    const double w = std::sqrt(histogram.count[size_t(i)]);
    weight[size_t(i) + 1] = weight[size_t(i)] + w;
    moment[size_t(i) + 1] = moment[size_t(i)] + w * i;
  }
  auto gain = [&](int from, int to) {
    const double w = weight[size_t(to)] - weight[size_t(from)];
    const double m = moment[size_t(to)] - moment[size_t(from)];
    return w > 0 ? m * m / w : 0;
  };
  // best[k][i]: the largest sum of gains of the first i bins in k + 1 classes.
  std::vector<std::vector<double>> best(size_t(classes), std::vector<double>(bins + 1, -1));
  std::vector<std::vector<int>> cut(size_t(classes), std::vector<int>(bins + 1));
  for (int i = 1; i <= bins; i++) best[0][size_t(i)] = gain(0, i);
  for (size_t k = 1; k < size_t(classes); k++)
    for (int i = int(k) + 1; i <= bins; i++)
      for (int j = int(k); j < i; j++) {
        const double sum = best[k - 1][size_t(j)] + gain(j, i);
        if (sum > best[k][size_t(i)]) best[k][size_t(i)] = sum, cut[k][size_t(i)] = j;
      }
  std::vector<int> firsts(size_t(classes) - 1);
  for (int k = classes - 1, end = bins; k > 0; k--)
    firsts[size_t(k) - 1] = end = cut[size_t(k)][size_t(end)];
  return firsts;
}

constexpr double brightness = 1.5;  // a ray through a nebula is so much brighter than its picture
const vec3 linen(0.62f, 0.47f, 0.29f), bone(0.84f, 0.77f, 0.6f), gold(0.9f, 0.6f, 0.18f);

}  // namespace

std::vector<Preset> find_presets(const ShownVolume& volume) {
  if (!volume.levels.front().colors[0].empty()) {
    const double most = std::max(volume.high, 0.0);
    return {{"light",
             VolumeMode::glow,
             {{0, vec3(1), 0}, {most, vec3(1), brightness * most / (1000 * volume.voxel)}}}};
  }
  Histogram histogram;
  histogram.count.assign(volume.code_counts.begin(), volume.code_counts.end());
  for (const double count : histogram.count) histogram.all += count;
  const auto used = std::ranges::count_if(histogram.count, [](double n) { return n > 0; });
  const int classes = int(std::clamp<ptrdiff_t>(used, 1, most_classes));
  auto value_of = [&](double bin) { return volume.low + (volume.high - volume.low) * bin / bins; };
  std::vector<double> edges;  // values at which classes begin
  if (classes > 1)
    for (int first : split_bins(histogram, classes)) {
      double above = 0;
      for (int i = first; i < bins; i++) above += histogram.count[size_t(i)];
      if (above >= least_share * histogram.all) edges.push_back(value_of(first));
    }
  if (edges.empty()) edges.push_back(volume.low);
  const double soft = 0.02 * (volume.high - volume.low);  // width of an edge
  std::vector<Preset> presets;
  auto add = [&](const char* name, VolumeMode mode, std::vector<PresetPoint> points) {
    presets.push_back({name, mode, std::move(points)});
  };
  add("outside", VolumeMode::surface, {{edges[0], linen, 1}});
  if (edges.size() > 1)
    add("inside", VolumeMode::density,
        {{edges[0] - soft, linen, 0},
         {edges[0], linen, 0.006},
         {edges[1] - soft, linen, 0.012},
         {edges[1] + soft, bone, 1.5}});
  if (edges.size() > 1) add("bone", VolumeMode::surface, {{edges[1], bone, 1}});
  if (edges.size() > 2)
    add("metal", VolumeMode::density,
        {{edges[1] - soft, bone, 0},
         {edges[1], bone, 0.03},
         {edges[2] - soft, bone, 0.06},
         {edges[2] + soft, gold, 3}});
  add("x-ray", VolumeMode::maximum, {{edges[0], vec3(0), 0}, {volume.high, vec3(1), 1}});
  return presets;
}

}  // namespace wellspring::volume
