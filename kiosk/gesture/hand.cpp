// SPDX-License-Identifier: Apache-2.0
#include "kiosk/gesture/hand.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "kiosk/gesture/skin.h"

namespace wellspring::kiosk {

namespace {

constexpr int cell = 4;               // pixels: hands are sought in a coarser picture
constexpr float reach = 4.2f;         // arm and hand from the shoulders, face sides: 0.75 m
constexpr float radius_share = 0.5f;  // radius of the kernel, face sides
constexpr int least_change = 14;      // grey levels from frame to frame that are motion
constexpr double moved_for = 0.25;    // seconds for which a pixel counts as moving
constexpr double still_for = 1.5;     // seconds after which another hand that moves is taken
constexpr float least_similar = 0.55f;
constexpr float least_skin = 0.2f;                  // share of the kernel's weight
constexpr float least_area = 0.08f, most_area = 3;  // region of skin, squared face sides

}  // namespace

struct HandTracker::Impl {
  bool mirrored;
  ChromaPicture picture;
  std::vector<uint8_t> last_y;
  std::vector<float> emphasis;   // one a pixel: 0 no skin, 1 skin, more where it moves
  std::vector<double> moved_at;  // time, one a pixel
  SkinColor skin;
  bool following = false;
  ChromaHistogram model{};
  vec2 place{0}, velocity{0};  // pixels; pixels a second
  double last_time = 0, stirred_time = 0;
  // These serve to find regions, on cells.
  std::vector<uint8_t> kind;  // 0 nothing, 1 skin, 2 skin that moves
  std::vector<int> stack, region;

  void reset() {
    following = false;
    last_y.clear();
    moved_at.assign(picture.y.size(), -1e9);
    skin = {};
  }

  // Marks skin and motion. The head and everything out of reach are left out.
  void mark(const HeadInView& head, double time) {
    const vec2 shoulders = head.center + vec2(0, 1.2f * head.side);
    const bool compare = last_y.size() == picture.y.size();
    emphasis.assign(picture.y.size(), 0);
    for (int y = 0; y < picture.height; y++)
      for (int x = 0; x < picture.width; x++) {
        const size_t i = size_t(y) * size_t(picture.width) + size_t(x);
        if (compare && std::abs(picture.y[i] - last_y[i]) > least_change) moved_at[i] = time;
        const vec2 p{float(x), float(y)}, off = (p - head.center) / head.side;
        // Hair and neck belong to the head.
        const bool is_head = off.x * off.x / 0.45f + (off.y - 0.1f) * (off.y - 0.1f) / 0.9f < 1;
        picture.use[i] = !is_head && glm::length(p - shoulders) < reach * head.side;
        if (picture.use[i] && skin.has(picture.y[i], picture.cb[i], picture.cr[i]))
          emphasis[i] = time - moved_at[i] < moved_for ? 3 : 1;
      }
    last_y = picture.y;
  }

  // Finds the upper end of the largest region of skin of which a quarter moves.
  std::optional<vec2> seek(const HeadInView& head) {
    const int columns = picture.width / cell, rows = picture.height / cell;
    kind.assign(size_t(columns * rows), 0);
    for (int y = 0; y < rows * cell; y++)
      for (int x = 0; x < columns * cell; x++) {
        const float e = emphasis[size_t(y * picture.width + x)];
        kind[size_t(y / cell * columns + x / cell)] += e > 1 ? 5 : e > 0 ? 1 : 0;
      }
    // At least half a cell's 16 pixels are skin; five of them move.
    for (uint8_t& k : kind) k = k >= 25 ? 2 : k >= 8 ? 1 : 0;
    const float unit = head.side * head.side / (cell * cell);
    std::optional<vec2> best;
    size_t most = 0;
    for (int start = 0; start < columns * rows; start++) {
      if (kind[size_t(start)] == 0) continue;
      size_t moving = 0;
      take_region(start, columns, rows, moving);
      const float area = float(region.size()) / unit;
      if (area < least_area || area > most_area || 4 * moving < region.size() || moving <= most)
        continue;
      most = moving;
      std::sort(region.begin(), region.end());  // top row first
      const size_t upper = std::min(region.size(), size_t(std::max(1.f, 0.5f * unit)));
      vec2 sum{0};
      for (size_t i = 0; i < upper; i++)
        sum += vec2(float(region[i] % columns), float(region[i] / columns)) + 0.5f;
      best = sum * float(cell) / float(upper);
    }
    return best;
  }

  void take_region(int start, int columns, int rows, size_t& moving) {
    region.clear();
    stack.assign(1, start);
    auto take = [&](int at) {
      moving += kind[size_t(at)] == 2;
      kind[size_t(at)] = 0;
      region.push_back(at);
    };
    take(start);
    while (!stack.empty()) {
      const int at = stack.back(), x = at % columns, y = at / columns;
      stack.pop_back();
      const int next[4] = {x > 0 ? at - 1 : -1, x + 1 < columns ? at + 1 : -1,
                           y > 0 ? at - columns : -1, y + 1 < rows ? at + columns : -1};
      for (int n : next)
        if (n >= 0 && kind[size_t(n)] != 0) {
          take(n);
          stack.push_back(n);
        }
    }
  }

  struct Share {
    float skin = 0, moving = 0;
  };
  Share share_at(vec2 center, float radius) const {
    Share out;
    int all = 0;
    for (int y = std::max(0, int(center.y - radius));
         y < std::min(picture.height, int(center.y + radius)); y++)
      for (int x = std::max(0, int(center.x - radius));
           x < std::min(picture.width, int(center.x + radius)); x++) {
        const float e = emphasis[size_t(y * picture.width + x)];
        all++;
        out.skin += e > 0;
        out.moving += e > 1;
      }
    if (all > 0) out.skin /= float(all), out.moving /= float(all);
    return out;
  }

  std::optional<HandSeen> follow(const HeadInView& head, double time, vec2 from) {
    const float radius = std::max(4.f, radius_share * head.side);
    const Shifted now = mean_shift(picture, model, from, radius, emphasis);
    const Share share = share_at(now.center, radius);
    if (now.similarity < least_similar || share.skin < least_skin) return {};
    if (share.moving > 0.02f) stirred_time = time;
    const float passed = std::max(1e-3f, float(time - last_time));
    velocity = 0.5f * (velocity + (now.center - place) / passed);
    place = now.center;
    HandSeen seen{place, (place - head.center) / (shoulder_width * head.side), now.similarity,
                  now.iterations};
    if (!mirrored) seen.place.x = -seen.place.x;
    return seen;
  }

  std::optional<HandSeen> begin(const HeadInView& head, double time, vec2 at) {
    const float radius = std::max(4.f, radius_share * head.side);
    // Skin alone makes the first model: the background round the hand belongs to no histogram of
    // it.
    for (size_t i = 0; i < picture.use.size(); i++)
      picture.use[i] = picture.use[i] && emphasis[i] > 0;
    model = make_histogram(picture, at, radius);
    place = at;
    velocity = vec2(0);
    stirred_time = time;
    return follow(head, time, at);
  }
};

HandTracker::HandTracker(bool mirrored) : impl_(std::make_unique<Impl>()) {
  impl_->mirrored = mirrored;
}
HandTracker::~HandTracker() = default;

std::optional<HandSeen> HandTracker::step(const ColorView& view, const HeadInView& head,
                                          double time) {
  Impl& m = *impl_;
  const bool valid = view.bgr && view.width >= 4 * cell && view.height >= 4 * cell &&
                     head.side >= 8 && std::isfinite(head.center.x + head.center.y + head.side);
  if (!valid) return {};
  if (m.picture.width != view.width || m.picture.height != view.height) {
    make_chroma(view, m.picture);
    m.reset();
  } else make_chroma(view, m.picture);
  m.skin.learn(m.picture, head.center, head.side);
  m.mark(head, time);
  std::optional<HandSeen> seen;
  if (m.following) {
    const float passed = float(std::clamp(time - m.last_time, 0.0, 0.2));
    seen = m.follow(head, time, m.place + passed * m.velocity);
    if (!seen) seen = m.follow(head, time, m.place);
  }
  const bool still = seen && time - m.stirred_time > still_for;
  if (!seen || still)
    if (const auto at = m.seek(head))
      if (auto found = m.begin(head, time, *at)) seen = found;
  m.following = seen.has_value();
  m.last_time = time;
  return seen;
}

}  // namespace wellspring::kiosk
