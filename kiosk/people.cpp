// SPDX-License-Identifier: Apache-2.0
#include "kiosk/people.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace wellspring::kiosk {

namespace {

constexpr int patch_side = 28;          // pixels of the remembered texture
constexpr float same_texture = 0.72f;   // correlation from which a patch is the same face
constexpr float stirred_share = 0.01f;  // of the face's surroundings: less is noise
constexpr int hits_to_count = 3;        // detections before a face is believed

float distance(const Box& a, const Box& b) {
  return std::hypot(a.center_x() - b.center_x(), a.center_y() - b.center_y());
}

bool could_be(const Box& before, const Box& now, double gap) {
  float ratio = now.width / before.width;
  float reach = before.width * (0.6f + 1.5f * float(std::min(gap, 1.0)));
  return ratio > 0.6f && ratio < 1.65f && distance(before, now) < reach;
}

cv::Mat cut(const GrayFrame& frame, const Box& box, float scale) {
  cv::Mat full(frame.height, frame.width, CV_8U, const_cast<uint8_t*>(frame.pixels.data()));
  cv::Rect area(int(std::lround(box.x)), int(std::lround(box.y)), int(std::lround(box.width)),
                int(std::lround(box.height)));
  area &= cv::Rect(0, 0, frame.width, frame.height);
  int w = int(std::lround(area.width * scale)), h = int(std::lround(area.height * scale));
  cv::Mat out;
  if (w >= 8 && h >= 8) cv::resize(full(area), out, {w, h}, 0, 0, cv::INTER_AREA);
  return out;
}

}  // namespace

struct People::Impl {
  FaceFinder& finder;
  PeopleSettings settings;
  struct Track {
    Followed who;
    float roll = 0;
    cv::Mat patch;  // the face at patch_side when a detector last saw it
  };
  std::vector<Track> tracks;
  std::vector<Followed> result;
  uint32_t next_id = 1;
  double searched = -1e9, searched_thoroughly = -1e9, last_time = -1e9;

  void see(Track& track, const GrayFrame& frame, const Face& face) {
    Followed& who = track.who;
    float confidence =
        who.hits ? 0.8f * who.face.confidence + 0.2f * face.confidence : face.confidence;
    who.face = face;
    who.face.confidence = confidence;
    who.seen = who.visible = true;
    who.seen_time = frame.time;
    who.hits++;
    track.patch = cut(frame, face.box, patch_side / face.box.width);
  }

  // The face turned away: find its texture near where it was.
  void carry(Track& track, const GrayFrame& frame) {
    Followed& who = track.who;
    who.visible = false;
    if (track.patch.empty() || frame.time - who.seen_time > settings.carry ||
        who.hits < hits_to_count)
      return;
    const Box& b = who.face.box;
    Box around{b.x - 0.35f * b.width, b.y - 0.35f * b.height, 1.7f * b.width, 1.7f * b.height};
    cv::Mat window = cut(frame, around, patch_side / b.width);
    if (window.rows < track.patch.rows || window.cols < track.patch.cols) return;
    cv::Mat score;
    cv::matchTemplate(window, track.patch, score, cv::TM_CCOEFF_NORMED);
    double best = 0;
    cv::Point at;
    cv::minMaxLoc(score, nullptr, &best, nullptr, &at);
    if (!(best > same_texture)) return;
    float left = std::max(0.f, std::round(around.x)), top = std::max(0.f, std::round(around.y));
    who.face.box.x = left + float(at.x) * b.width / patch_side;
    who.face.box.y = top + float(at.y) * b.width / patch_side;
    who.face.eyes.reset();
    who.face.marks.reset();
    who.face.confidence *= 0.95f;
    who.visible = true;
  }

  void meet(const GrayFrame& frame, const Face& face) {
    for (Track& track : tracks) {
      Followed& who = track.who;
      if (who.seen && overlap(who.face.box, face.box) > 0.15f) return;
    }
    Track* known = nullptr;
    for (Track& track : tracks)
      if (!track.who.seen &&
          could_be(track.who.face.box, face.box, frame.time - track.who.seen_time))
        if (!known || track.who.seen_time > known->who.seen_time) known = &track;
    if (!known) {
      if (int(tracks.size()) >= settings.most) return;
      tracks.emplace_back();
      known = &tracks.back();
      known->who.id = next_id++;
      known->who.first_time = known->who.moved_time = frame.time;
    }
    see(*known, frame, face);
  }
};

People::People(FaceFinder& finder, const PeopleSettings& settings)
    : impl_(new Impl{finder, settings, {}, {}}) {}
People::~People() = default;

void People::tilt(uint32_t id, float roll) {
  for (Impl::Track& track : impl_->tracks)
    if (track.who.id == id) track.roll = roll;
}

const std::vector<Followed>& People::step(const GrayFrame& frame, const Motion& motion,
                                          const MotionWatch& watch) {
  Impl& m = *impl_;
  const double time = frame.time;
  if (time < m.last_time) m.tracks.clear(), m.searched = m.searched_thoroughly = -1e9;
  m.last_time = time;

  for (Impl::Track& track : m.tracks) {
    Followed& who = track.who;
    who.seen = false;
    // A face long lost is left to the search; its window would only meet others.
    auto face = time - who.seen_time < m.settings.carry
                    ? m.finder.follow(frame, who.face, track.roll)
                    : std::optional<Face>();
    if (face) m.see(track, frame, *face);
    else m.carry(track, frame);
  }
  // Two windows that slid onto one face: the older number stays.
  for (size_t i = 0; i < m.tracks.size(); i++)
    for (size_t j = m.tracks.size(); j-- > i + 1;)
      if (m.tracks[i].who.visible && m.tracks[j].who.visible &&
          overlap(m.tracks[i].who.face.box, m.tracks[j].who.face.box) > 0.4f)
        m.tracks.erase(m.tracks.begin() + long(j));

  bool somebody =
      std::any_of(m.tracks.begin(), m.tracks.end(), [](auto& t) { return t.who.visible; });
  if (time - m.searched >= (somebody ? m.settings.search_more : m.settings.search_alone)) {
    m.searched = time;
    for (const Face& face : m.finder.search(frame)) m.meet(frame, face);
    somebody = std::any_of(m.tracks.begin(), m.tracks.end(), [](auto& t) { return t.who.visible; });
  }
  const bool worth = !somebody || !motion.zones.empty();
  if (worth &&
      time - m.searched_thoroughly >= (somebody ? m.settings.thorough_more : m.settings.thorough)) {
    m.searched_thoroughly = time;
    Box zone{0, 0, float(frame.width), float(frame.height)};
    if (!motion.zones.empty()) {  // with room for the head above a body in plain clothes
      const Box& z = motion.zones.front();
      zone = {z.x - 0.1f * z.width, z.y - 0.2f * z.height, 1.2f * z.width, 1.25f * z.height};
    }
    for (const Face& face : m.finder.search_thoroughly(frame, zone)) m.meet(frame, face);
  }

  std::erase_if(m.tracks, [&](const Impl::Track& track) {
    const Followed& who = track.who;
    return time - who.seen_time > (who.hits >= hits_to_count ? m.settings.recall : 0.5);
  });
  m.result.clear();
  for (Impl::Track& track : m.tracks) {
    Followed& who = track.who;
    const Box& b = who.face.box;
    Box around{b.x - 0.3f * b.width, b.y - 0.2f * b.height, 1.6f * b.width, 1.6f * b.height};
    if (watch.changed(around) > stirred_share) who.moved_time = time;
    who.picture = time - who.moved_time > m.settings.still;
    if (who.hits >= hits_to_count) m.result.push_back(who);
  }
  std::sort(m.result.begin(), m.result.end(),
            [](auto& a, auto& b) { return a.face.box.width > b.face.box.width; });
  return m.result;
}

}  // namespace wellspring::kiosk
