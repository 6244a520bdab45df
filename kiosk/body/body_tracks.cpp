// SPDX-License-Identifier: Apache-2.0
#include "kiosk/body/body_tracks.h"

#include <algorithm>
#include <cmath>

namespace wellspring::kiosk {

namespace {

constexpr size_t most_tracks = 6;
constexpr int hits_to_count = 2;  // looks in which a body is found before it is told
// Mean scores and numbers of points from which a look finds a body, and from which a wide look,
// where bodies are small, makes a second one worth while. Bottles that a belt carries by get up to
// 13 points of 0.44 in a wide look, and then 6 of 0.4; people get 0.33 and more, and then 0.45.
constexpr float least_score = 0.44f, worth_score = 0.33f;
constexpr float least_wide = 0.55f;  // mean score that makes a second look needless
constexpr int least_points = 6, worth_points = 4;
constexpr size_t most_candidates = 4;
constexpr double way_kept = 1.5;       // seconds over which speed is measured
constexpr double least_way = 0.5;      // seconds that it takes at least
constexpr float walking = 0.3f;        // metres a second from which somebody comes or goes
constexpr float reach = 1.5f;          // metres within which a body could use the kiosk
constexpr double stays_after = 1;      // seconds for which somebody must have stayed there
constexpr double arms_last = 0.25;     // seconds for which forearms are told
constexpr float walked_share = 0.45f;  // a body may walk so much of its size between two looks
constexpr float seated_step = 0.5f;    // evidence of one look
constexpr float body_reach = 3;        // face sides to either side that its body may take
constexpr float stirred_share = 0.1f;  // share of a body's box that a moving zone must cover
constexpr float floor_memory = 0.1f;   // share of a new look in the floor's height

// Bearings are tangents, distances logarithms of metres, as a head's are.
constexpr OneEuroSettings bearing_filter{1.f, 4.f, 1.f};
constexpr OneEuroSettings distance_filter{0.6f, 1.f, 1.f};

struct Score {
  float mean = 0;
  int points = 0;
  bool passes(float least, int count) const { return mean >= least && points >= count; }
};

// Returns the mean over the points that are seen, and how many these are.
Score score_of(const BodyMarks& marks) {
  Score out;
  for (const BodyMark& mark : marks.points)
    if (mark.score >= least_point_score) out.mean += mark.score, out.points++;
  out.mean /= float(std::max(1, out.points));
  return out;
}

bool is_finite_body(const BodyMarks& marks) {
  return std::ranges::all_of(marks.points, [](const BodyMark& mark) {
    return std::isfinite(mark.pixel.x + mark.pixel.y + mark.score);
  });
}

Box box_of(const BodyMarks& marks) {
  const BodyBox box = body_box(marks);
  return {box.low.x, box.low.y, box.high.x - box.low.x, box.high.y - box.low.y};
}

// Returns the share of `box` that `zone` covers.
float share_of(const Box& box, const Box& zone) {
  const float w = std::min(box.x + box.width, zone.x + zone.width) - std::max(box.x, zone.x);
  const float h = std::min(box.y + box.height, zone.y + zone.height) - std::max(box.y, zone.y);
  return w > 0 && h > 0 ? w * h / std::max(1.f, box.width * box.height) : 0;
}

// Returns the square that holds the body below a near face as far as the picture shows it.
Cut cut_below(const Box& face) {
  constexpr float side = 8, below = 2.2f;  // face sides
  return {{face.center_x(), face.center_y() + below * face.width},
          side * face.width,
          side * face.width,
          0};
}

Cut cut_around(const Box& zone) {
  const float side = 1.4f * std::max(zone.width, zone.height);
  return {{zone.center_x(), zone.center_y()}, side, side, 0};
}

// Returns whether the body of a face may be all that moves there.
bool explains(const Box& face, const Box& zone) {
  const float low = face.center_x() - body_reach * face.width;
  const float high = face.center_x() + body_reach * face.width;
  const float common = std::min(high, zone.x + zone.width) - std::max(low, zone.x);
  return common > 0.6f * zone.width;
}

}  // namespace

BodyTracks::BodyTracks(const Mount& mount, const BodySettings& settings)
    : mount_(mount), settings_(settings) {}

bool BodyTracks::counts(const Track& track) const {
  return track.hits >= hits_to_count && track.stirred;
}

std::optional<BodyLook> BodyTracks::plan(double time, int width, int height,
                                         std::span<const Box> zones,
                                         std::span<const FaceInView> faces, bool arms) {
  zones_.assign(zones.begin(), zones.end());
  if (!std::isfinite(time) || width < 16 || height < 16) return {};
  if (time < last_time_) {
    tracks_.clear();
    candidates_.clear();
    looked_ = searched_ = arms_ = -1e9;
  }
  last_time_ = time;
  view_ = {focal_length(mount_, width, height), width, height};
  std::erase_if(tracks_, [&](const Track& t) {
    return time - t.seen > (counts(t) ? settings_.forget : settings_.search_every);
  });
  for (Track& track : tracks_)
    if (std::ranges::none_of(faces, [&](const FaceInView& f) { return f.id == track.face; }))
      track.face = 0;
  if (time - looked_ < settings_.look_every) return {};

  auto near_face = [&](uint32_t id) {
    return std::ranges::any_of(faces, [&](const FaceInView& face) {
      return face.id == id && face.depth < settings_.near;
    });
  };
  auto look = [&](const Cut& square, size_t most) {
    looked_ = time;
    wide_ = most > 1;
    return BodyLook{square, most};
  };
  // Who is near and has a face is asked for wrists only, in turn with all others.
  if (arms && !faces.empty() && faces[0].depth < settings_.near &&
      time - arms_ >= settings_.arm_every) {
    arms_ = time;
    return look(cut_below(faces[0].box), 1);
  }
  if (!candidates_.empty()) {
    const Cut square = candidates_.back();
    candidates_.pop_back();
    return look(square, 1);
  }
  Track* oldest = nullptr;
  for (Track& track : tracks_)
    if (!near_face(track.face) && time - track.looked >= settings_.follow_every &&
        (!oldest || track.looked < oldest->looked))
      oldest = &track;
  if (oldest) {
    oldest->looked = time;
    return look(body_cut(oldest->marks), 1);
  }
  // Something that moves and belongs to nobody near may be a body.
  std::vector<Box> open;
  for (const Box& zone : zones) {
    if (std::ranges::none_of(faces, [&](const FaceInView& face) {
          return face.depth < settings_.near && explains(face.box, zone);
        }))
      open.push_back(zone);
  }
  if (open.empty() || time - searched_ < settings_.search_every / 2) return {};
  searched_ = time;
  // The whole picture and the zones are looked at in turn.
  const size_t turn = next_zone_++ % (open.size() + 1);
  if (turn > 0) return look(cut_around(open[turn - 1]), 2);
  const auto side = float(std::max(width, height));
  return look({vec2(float(width), float(height)) / 2.f, side, side, 0}, 4);
}

// Returns the nearest track whose body is about as large and not too far to have walked here, but
// none of those that were found already in this look.
BodyTracks::Track* BodyTracks::find(const BodyMarks& marks, std::span<const uint32_t> taken) {
  const Box box = box_of(marks);
  const float size = std::max(box.width, box.height);
  Track* best = nullptr;
  float least = walked_share * size;
  for (Track& track : tracks_) {
    const Box other = box_of(track.marks);
    const float ratio = size / std::max(1.f, std::max(other.width, other.height));
    const float far =
        std::hypot(box.center_x() - other.center_x(), box.center_y() - other.center_y());
    if (ratio < 0.5f || ratio > 2 || far > least) continue;
    if (std::ranges::find(taken, track.body.id) != taken.end()) continue;
    least = far, best = &track;
  }
  return best;
}

void BodyTracks::see(Track& track, double time, const BodyMarks& marks,
                     const BodyMeasure& measure) {
  track.marks = marks;
  track.seen = time;
  track.hits++;
  const vec3 raw = measure.shoulders;
  const vec3 bearing =
      step_one_euro(track.bearing, bearing_filter, time, {raw.x / raw.z, raw.y / raw.z, 0});
  const vec3 away = step_one_euro(track.distance, distance_filter, time, {std::log(raw.z), 0, 0});
  track.body.position = camera_to_screen(mount_, vec3(bearing.x, bearing.y, 1) * std::exp(away.x));
  track.body.confidence = std::clamp(score_of(marks).mean, 0.f, 1.f);
  track.body.raised_hand = measure.raised_hand;
  if (measure.height > 0)
    track.body.height = track.body.height > 0
                            ? track.body.height + 0.3f * (measure.height - track.body.height)
                            : measure.height;
  if (measure.seated)
    track.seated =
        std::clamp(track.seated + (*measure.seated ? seated_step : -seated_step), -1.f, 1.f);
  if (std::abs(track.seated) >= 2 * seated_step) track.body.seated = track.seated > 0;
  track.way.push_back({time, track.body.position});
  while (time - track.way.front().time > way_kept) track.way.pop_front();
  judge_course(track, time);
}

void BodyTracks::judge_course(Track& track, double time) {
  const Step &from = track.way.front(), &to = track.way.back();
  const double passed = to.time - from.time;
  BodyCourse course = BodyCourse::stays;
  if (passed >= least_way) {
    const vec3 speed = (to.place - from.place) / float(passed);
    const vec2 place{to.place.x, to.place.z}, along{speed.x, speed.z};
    const float away = glm::dot(along, place) / std::max(0.1f, glm::length(place));
    const float aside = std::sqrt(std::max(0.f, glm::dot(along, along) - away * away));
    if (aside > walking && aside > std::abs(away)) course = BodyCourse::passes;
    else if (away < -walking) course = BodyCourse::comes;
    else if (away > walking) course = BodyCourse::leaves;
  }
  if (course == track.body.course) return;
  track.body.course = course;
  track.course_since = time;
}

void BodyTracks::take(double time, std::span<const BodyMarks> found,
                      std::span<const FaceInView> faces) {
  std::vector<uint32_t> taken;
  for (const BodyMarks& marks : found) {
    if (!is_finite_body(marks)) continue;
    Track* track = find(marks, taken);
    const Score score = score_of(marks);
    if (!score.passes(wide_ ? least_wide : least_score, least_points)) {
      if (wide_ && !track && score.passes(worth_score, worth_points) &&
          candidates_.size() < most_candidates)
        candidates_.push_back(body_cut(marks));
      continue;
    }
    KnownDepth known{.face = {}, .floor = floor_};
    uint32_t face_id = 0;
    for (const FaceInView& face : faces)
      if (has_face(marks, face.box)) known.face = face.depth, face_id = face.id;
    if (!track && face_id)  // a face that turned its body over to another square
      for (Track& other : tracks_)
        if (other.face == face_id) track = &other;
    const auto measure = measure_body(marks, view_, mount_, known);
    if (!measure) continue;
    if (known.face && measure->ankles)
      floor_ = floor_ ? *floor_ + floor_memory * (*measure->ankles - *floor_) : *measure->ankles;
    if (!track) {
      if (tracks_.size() >= most_tracks) continue;
      track = &tracks_.emplace_back();
      track->body.id = next_id_++;
      track->first = track->course_since = time;
    }
    taken.push_back(track->body.id);
    track->face = face_id;
    const Box box = box_of(marks);
    track->stirred |= face_id || std::ranges::any_of(zones_, [&](const Box& zone) {
                        return share_of(box, zone) > stirred_share;
                      });
    track->looked = time;
    see(*track, time, marks, *measure);
  }
  // Two squares that slide onto one body leave the older number.
  for (size_t i = 0; i < tracks_.size(); i++)
    for (size_t j = tracks_.size(); j-- > i + 1;)
      if (overlap(box_of(tracks_[i].marks), box_of(tracks_[j].marks)) > 0.6f)
        tracks_.erase(tracks_.begin() + long(j));
}

std::vector<wire::Body> BodyTracks::bodies(double time) const {
  std::vector<wire::Body> out;
  for (const Track& track : tracks_) {
    const double age = time - track.seen;
    if (!counts(track) || age < 0 || age > settings_.forget) continue;
    out.push_back(track.body);
    out.back().confidence *= float(1 - age / settings_.forget);
    if (age > 2 * settings_.follow_every) out.back().raised_hand = false;
  }
  std::ranges::sort(out, {}, [](const wire::Body& b) { return glm::dot(b.position, b.position); });
  return out;
}

bool BodyTracks::somebody_comes() const {
  return std::ranges::any_of(tracks_, [&](const Track& track) {
    return counts(track) && track.body.course == BodyCourse::comes;
  });
}

bool BodyTracks::somebody_stays_near(double time) const {
  return std::ranges::any_of(tracks_, [&](const Track& track) {
    return counts(track) && track.body.course == BodyCourse::stays &&
           time - track.seen < settings_.forget && time - track.course_since >= stays_after &&
           track.body.position.z < reach;
  });
}

std::vector<Forearm> BodyTracks::forearms(uint32_t face, double time) const {
  using enum BodyPoint;
  std::vector<Forearm> out;
  for (const Track& track : tracks_) {
    if (track.face != face || face == 0 || time - track.seen > arms_last) continue;
    const BodyPoint arms[2][2] = {{left_elbow, left_wrist}, {right_elbow, right_wrist}};
    for (const auto& [elbow, wrist] : arms) {
      const BodyMark &from = track.marks.at(elbow), &to = track.marks.at(wrist);
      if (to.score < least_point_score) continue;
      out.push_back({from.pixel, to.pixel, from.score >= least_point_score});
    }
  }
  return out;
}

}  // namespace wellspring::kiosk
