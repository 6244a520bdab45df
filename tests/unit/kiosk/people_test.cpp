// SPDX-License-Identifier: Apache-2.0
// People who cross before the camera, seen by a finder that knows where they are and errs as
// windows do: one that hides another takes its window, too.
#include "kiosk/people.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>

#include "base/rng.h"

namespace wellspring::test {
namespace {

constexpr double rate = 15;

struct Walker {
  std::function<Box(double)> box;  // by time
};

class ScriptedFinder : public FaceFinder {
 public:
  explicit ScriptedFinder(std::vector<Walker> walkers) : walkers_(std::move(walkers)) {}
  std::vector<Face> search(const GrayFrame& frame) override { return seen(frame.time); }
  std::vector<Face> search_thoroughly(const GrayFrame& frame, const Box&) override {
    return seen(frame.time);
  }
  std::optional<Face> follow(const GrayFrame& frame, const Face& last, float) override {
    std::optional<Face> best;
    auto off = [&](const Face& face) {
      return std::hypot(face.box.center_x() - last.box.center_x(),
                        face.box.center_y() - last.box.center_y());
    };
    for (const Face& face : seen(frame.time))
      if (off(face) < 0.8f * last.box.width && (!best || off(face) < off(*best))) best = face;
    return best;
  }
  bool finds_landmarks() const override { return false; }

  // The walker whose face is there; nobody's: -1.
  int owner(const Box& box, double time) const {
    for (size_t k = 0; k < walkers_.size(); k++)
      if (overlap(walkers_[k].box(time), box) > 0.5f) return int(k);
    return -1;
  }

 private:
  // Whoever is not hidden by a larger (nearer) face.
  std::vector<Face> seen(double time) const {
    std::vector<Face> out;
    for (const Walker& one : walkers_) {
      const Box box = one.box(time);
      bool hidden = box.x < 0 || box.x + box.width > 640;
      for (const Walker& other : walkers_)
        hidden |= other.box(time).width > box.width && overlap(other.box(time), box) > 0.15f;
      if (!hidden) out.push_back({.box = box, .confidence = 0.8f});
    }
    return out;
  }
  std::vector<Walker> walkers_;
};

Walker walk(float from, float to, float width, double begin, double seconds, float sway) {
  return {[=](double time) {
    const float at = float(std::clamp((time - begin) / seconds, 0.0, 1.0));
    const float x = from + (to - from) * at;
    const float y = 200 + sway * std::sin(6 * float(time));
    return Box{x - width / 2, y - width / 2, width, width};
  }};
}

TEST(People, TwentyCrossingsWithoutASwap) {
  Rng random(7);
  for (int crossing = 0; crossing < 20; crossing++) {
    auto between = [&](float low, float high) { return low + (high - low) * random.uniform(); };
    // One nearer than the other; they meet in the middle, quickly or slowly, or one stands.
    const float near = between(80, 120), far = near / between(1.35f, 2);
    const bool stands = crossing % 4 == 0;
    const double slow = between(1.5f, 4);
    ScriptedFinder finder({walk(stands ? 320 : 120, stands ? 320 : 520, near, 1, slow, 4),
                           walk(540, 100, far, 1, between(1.5f, 4), 3)});
    People people(finder);
    std::map<uint32_t, int> owners;
    size_t most = 0;
    for (int k = 0; k < int(6 * rate); k++) {
      const GrayFrame frame{k / rate, 640, 480, std::vector<uint8_t>(640 * 480, 90)};
      Motion motion;
      motion.zones = {{0, 0, 640, 480}};
      for (const Followed& who : people.step(frame, motion)) {
        if (!who.visible) continue;
        const int owner = finder.owner(who.face.box, frame.time);
        if (owner < 0) continue;  // it is hidden, and carried on
        const auto [known, is_new] = owners.try_emplace(who.id, owner);
        EXPECT_EQ(known->second, owner) << "crossing " << crossing << " at " << frame.time;
      }
      most = std::max(most, owners.size());
    }
    EXPECT_EQ(most, 2u) << "crossing " << crossing << ": numbers given";
  }
}

TEST(People, WhoLeavesAndComesBackSoonKeepsTheirNumber) {
  ScriptedFinder finder({{[](double time) {
    return time > 2 && time < 3.5 ? Box{-500, 0, 80, 80}
                                  : Box{260, 160, 80 + float(time), 80 + float(time)};
  }}});
  People people(finder);
  uint32_t id = 0;
  for (int k = 0; k < int(6 * rate); k++) {
    const GrayFrame frame{k / rate, 640, 480, std::vector<uint8_t>(640 * 480, 90)};
    for (const Followed& who : people.step(frame, {}))
      if (who.seen) {
        if (id == 0) id = who.id;
        EXPECT_EQ(who.id, id) << "at " << frame.time;
      }
  }
  EXPECT_NE(id, 0u);
}

}  // namespace
}  // namespace wellspring::test
