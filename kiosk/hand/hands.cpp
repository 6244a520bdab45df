// SPDX-License-Identifier: Apache-2.0
#include "kiosk/hand/hands.h"

#include <algorithm>
#include <cmath>

namespace wellspring::kiosk {

namespace {

constexpr float least_presence = 0.5f;  // a hand that is followed needs it
constexpr float found_presence = 0.6f;  // a new one needs more
constexpr double lost_after = 0.2;      // seconds without a read that succeeds
constexpr double retry_after = 0.4;     // seconds before a place without a hand is read again
constexpr int agree = 2;                // reads that must agree on a pose
constexpr float arms_reach = 1.1f;      // metres from the eyes to a hand that is one's own
constexpr OneEuroSettings place_filter{1.5f, 6.f, 1.f};   // metres
constexpr OneEuroSettings target_filter{0.8f, 3.f, 1.f};  // metres on the screen's plane

bool is_finite_hand(const HandMarks& marks) {
  return std::ranges::all_of(marks.points, [](vec3 p) { return is_finite(p); }) &&
         std::ranges::all_of(marks.metres, [](vec3 p) { return is_finite(p); });
}

vec2 middle_of(const HandMarks& marks) {
  return (vec2(marks.points[wrist_point]) + vec2(marks.points[middle_root_point])) / 2.f;
}

float size_of(const HandMarks& marks) {
  return std::max(4.f,
                  glm::length(vec2(marks.points[wrist_point] - marks.points[middle_root_point])));
}

}  // namespace

bool HandTracks::followed_at(vec2 middle, const Track* except) const {
  return std::ranges::any_of(tracks_, [&](const Track& track) {
    return &track != except && glm::length(middle_of(track.marks) - middle) < size_of(track.marks);
  });
}

// Takes what was read; false: this is no hand, or not this person's.
bool HandTracks::update(Track& track, const HandLook& look, HandMarks marks) {
  if (!is_finite_hand(marks)) return false;
  const float focal = focal_length(mount_, look.width, look.height);
  const auto place = place_hand(marks, focal, look.width, look.height);
  if (!place) return false;
  const vec3 palm = camera_to_screen(mount_, place->palm);
  if (glm::length(palm - look.eye) > arms_reach) return false;
  track.marks = std::move(marks);
  track.seen = look.time;
  track.shape = shape_of(track.marks);
  track.hand.position = step_one_euro(track.place, place_filter, look.time, palm);
  const int seen = 10 * int(track.shape.pose) + track.shape.fingers;
  track.agreed = seen == track.candidate ? track.agreed + 1 : 1;
  track.candidate = seen;
  if (track.agreed >= agree || !track.hand.fingers) {
    track.hand.pose = track.shape.pose;
    track.hand.fingers = track.shape.fingers;
  }
  track.hand.points_at.reset();
  if (track.hand.pose == HandPose::point) {
    // The line from the head over the hand is what people aim along (Nickel, Stiefelhagen 2007),
    // and it needs less of the landmarks than the finger's own direction.
    const vec3 tip = camera_to_screen(mount_, place->index_tip);
    if (const auto target = point_on_screen(look.eye, tip)) {
      const vec3 calm = step_one_euro(track.target, target_filter, look.time, vec3(*target, 0));
      track.hand.points_at = vec2(calm);
    }
  } else track.target = {};
  return true;
}

std::vector<Hand> HandTracks::step(const HandLook& look, const Read& read) {
  gesture_.clear();
  if (!std::isfinite(look.time) || look.width < 16 || look.height < 16) return {};
  if (look.time < last_time_) tracks_.clear(), failures_.clear();
  last_time_ = look.time;
  std::erase_if(failures_, [&](const Failure& f) { return look.time - f.time > retry_after; });

  size_t reads = 0;
  // With one read a frame, every fourth looks for the other hand.
  const bool seeks =
      look.most_reads == 1 && tracks_.size() == 1 && !look.places.empty() && turn_ % 4 == 3;
  for (size_t i = 0; !seeks && i < tracks_.size() && reads < look.most_reads; i++, reads++) {
    Track& track = tracks_[(turn_ + i) % tracks_.size()];
    HandMarks marks = read(hand_cut_of_marks(track.marks));
    if (marks.presence >= least_presence && !followed_at(middle_of(marks), &track))
      update(track, look, std::move(marks));
  }
  turn_++;
  std::erase_if(tracks_, [&](const Track& t) { return look.time - t.seen > lost_after; });

  for (const Cut& square : look.places) {
    if (reads >= look.most_reads || tracks_.size() >= 2) break;
    auto failed = [&](const Failure& f) {
      return glm::length(f.middle - square.middle) < 0.25f * square.width;
    };
    if (followed_at(square.middle) || std::ranges::any_of(failures_, failed)) continue;
    reads++;
    Track track;
    HandMarks marks = read(square);
    const bool found = marks.presence >= found_presence && !followed_at(middle_of(marks)) &&
                       update(track, look, std::move(marks));
    if (found) tracks_.push_back(std::move(track));
    else failures_.push_back({square.middle, look.time});
  }

  std::ranges::sort(tracks_, {}, [](const Track& t) { return -t.hand.position.y; });
  std::vector<Hand> hands;
  for (Track& track : tracks_) {
    hands.push_back(track.hand);
    if (track.seen != look.time) continue;
    // The visitor sees the picture's mirror image.
    const float clockwise = mount_.mirrored ? track.shape.roll : -track.shape.roll;
    const std::string found =
        track.gestures.step(look.time, track.shape, track.hand.position, clockwise);
    if (gesture_.empty()) gesture_ = found;
  }
  return hands;
}

std::optional<vec2> HandTracks::index_tip() const {
  if (tracks_.empty() || tracks_.front().seen != last_time_) return {};
  return vec2(tracks_.front().marks.points[index_tip_point]);
}

}  // namespace wellspring::kiosk
