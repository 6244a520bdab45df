// SPDX-License-Identifier: Apache-2.0
#include "kiosk/people.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/background_segm.hpp>

#include "kiosk/face/face_path.h"

namespace wellspring::kiosk {

namespace {

constexpr int patch_side = 28;         // pixels of the remembered texture
constexpr float same_texture = 0.72f;  // correlation from which a patch is the same face
constexpr int hits_to_count = 3;       // number of detections before a face counts

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
    FacePath path;
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
    add_place(track.path, frame.time, face.box);
    track.patch = cut(frame, face.box, patch_side / face.box.width);
  }

  // Finds the texture of a face that turned away near its last place.
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

  // Looks for each face near where it is to be. The window of one who is hidden by another slides
  // onto the other: of two that find the same face the one that it fits less has lost its own.
  void follow_all(const GrayFrame& frame) {
    struct Found {
      std::optional<Face> face;
      float misfit = 1;
    };
    std::vector<Found> found(tracks.size());
    for (size_t k = 0; k < tracks.size(); k++) {
      const Followed& who = tracks[k].who;
      // A face lost for long is left to the search; its window would only meet others.
      if (frame.time - who.seen_time >= settings.carry) continue;
      const auto face = finder.follow(frame, who.face, tracks[k].roll);
      const auto off = face ? misfit(tracks[k].path, frame.time, face->box) : std::nullopt;
      if (off) found[k] = {face, *off};
    }
    auto same = [](const Box& a, const Box& b) { return overlap(a, b) > 0.4f; };
    for (size_t i = 0; i < found.size(); i++)
      for (size_t j = i + 1; j < found.size(); j++)
        if (found[i].face && found[j].face && same(found[i].face->box, found[j].face->box))
          found[found[i].misfit <= found[j].misfit ? j : i].face.reset();
    for (size_t k = 0; k < tracks.size(); k++) {
      tracks[k].who.seen = false;
      if (found[k].face) see(tracks[k], frame, *found[k].face);
    }
    for (Track& track : tracks) {
      if (track.who.seen) continue;
      carry(track, frame);
      for (const Track& other : tracks)
        if (other.who.seen && same(other.who.face.box, track.who.face.box))
          track.who.visible = false;
    }
  }

  void meet(const GrayFrame& frame, const Face& face) {
    for (Track& track : tracks) {
      Followed& who = track.who;
      if (who.seen && overlap(who.face.box, face.box) > 0.15f) return;
    }
    Track* known = nullptr;
    float best = 1;
    for (Track& track : tracks) {
      const auto off = track.who.seen ? std::nullopt : misfit(track.path, frame.time, face.box);
      if (off && *off < best) known = &track, best = *off;
    }
    if (!known) {
      if (int(tracks.size()) >= settings.most) return;
      tracks.emplace_back();
      known = &tracks.back();
      known->who.id = next_id++;
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

const std::vector<Followed>& People::step(const GrayFrame& frame, const Motion& motion) {
  Impl& m = *impl_;
  const double time = frame.time;
  if (time < m.last_time) m.tracks.clear(), m.searched = m.searched_thoroughly = -1e9;
  m.last_time = time;

  m.follow_all(frame);

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
    if (!motion.zones.empty()) {  // the box leaves room for the head above a body in plain clothes
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
  for (const Impl::Track& track : m.tracks)
    if (track.who.hits >= hits_to_count) m.result.push_back(track.who);
  std::sort(m.result.begin(), m.result.end(),
            [](auto& a, auto& b) { return a.face.box.width > b.face.box.width; });
  return m.result;
}

namespace {

constexpr float changed_levels = 12;  // grey levels between two frames that noise does not reach
constexpr double changed_memory = 1;  // seconds a change is remembered
constexpr int smallest_region = 40;   // pixels of the working picture

double median(cv::Mat values) {  // takes an 8-bit picture
  int counts[256] = {};
  for (int y = 0; y < values.rows; y++)
    for (int x = 0; x < values.cols; x++) counts[values.at<uint8_t>(y, x)]++;
  int left = values.rows * values.cols / 2, level = 0;
  while (level < 255 && (left -= counts[level]) >= 0) level++;
  return level;
}

}  // namespace

struct MotionWatch::Impl {
  MotionSettings settings;
  cv::Ptr<cv::BackgroundSubtractorMOG2> model;
  cv::Mat reference;   // float: slow mean of the corrected pictures, to which brightness is matched
  cv::Mat previous;    // the last corrected picture
  cv::Mat changed_at;  // double: time at which each pixel last changed
  double last_time = 0;
  float scale = 1;  // working pixels per frame pixel
  int frame_width = 0, frame_height = 0;

  void restart(const cv::Mat& small, double time) {
    model = cv::createBackgroundSubtractorMOG2(500, 25, false);
    cv::Mat mask;
    model->apply(small, mask, 1);
    small.convertTo(reference, CV_32F);
    previous = small.clone();
    changed_at = cv::Mat(small.size(), CV_64F, cv::Scalar(-1e9));
    last_time = time;
  }

  // Returns the gain that brings most pixels of `small` to the reference: the median of their
  // ratios, which people covering less than half of the picture do not move.
  double gain(const cv::Mat& small) const {
    cv::Mat now, ratio;
    small.convertTo(now, CV_32F, 1, 4);
    cv::divide(reference + 4, now, ratio, 64);
    ratio.convertTo(ratio, CV_8U);
    return std::clamp(median(ratio) / 64, 0.3, 3.0);
  }
};

MotionWatch::MotionWatch(const MotionSettings& settings) : impl_(std::make_unique<Impl>()) {
  impl_->settings = settings;
}
MotionWatch::~MotionWatch() = default;

Motion MotionWatch::step(const GrayFrame& frame) {
  Impl& m = *impl_;
  Motion result;
  if (frame.width < 16 || frame.height < 16) return result;
  const cv::Mat full(frame.height, frame.width, CV_8U, const_cast<uint8_t*>(frame.pixels.data()));
  m.scale = std::min(1.f, float(m.settings.width) / float(std::max(frame.width, frame.height)));
  cv::Mat small;
  cv::resize(full, small,
             {std::max(8, int(std::lround(frame.width * m.scale))),
              std::max(8, int(std::lround(frame.height * m.scale)))},
             0, 0, cv::INTER_AREA);
  cv::GaussianBlur(small, small, {3, 3}, 0);
  if (!m.model || frame.width != m.frame_width || frame.height != m.frame_height) {
    m.frame_width = frame.width;
    m.frame_height = frame.height;
    m.restart(small, frame.time);
    return result;
  }
  double step = std::clamp(frame.time - m.last_time, 0.0, 1.0);
  m.last_time = frame.time;

  cv::Mat corrected;
  small.convertTo(corrected, CV_8U, m.gain(small));
  const double rate = 1 - std::exp(-step / m.settings.adapt);
  cv::Mat foreground;
  m.model->apply(corrected, foreground, rate);
  cv::accumulateWeighted(corrected, m.reference, rate);

  cv::Mat difference;
  cv::absdiff(corrected, m.previous, difference);
  cv::Mat changed_now;
  cv::threshold(difference, changed_now, changed_levels, 255, cv::THRESH_BINARY);
  m.previous = corrected;
  m.changed_at.setTo(frame.time, changed_now);

  const float total = float(small.total());
  if (float(cv::countNonZero(foreground)) > m.settings.light_share * total) {
    m.restart(small, frame.time);
    result.light_changed = true;
    return result;
  }
  cv::morphologyEx(foreground, foreground, cv::MORPH_OPEN, cv::Mat::ones(3, 3, CV_8U));
  cv::morphologyEx(foreground, foreground, cv::MORPH_CLOSE, cv::Mat::ones(5, 5, CV_8U));
  cv::Mat labels, stats, centers;
  int count = cv::connectedComponentsWithStats(foreground, labels, stats, centers, 8, CV_32S);
  std::vector<int> lively(size_t(count), 0);
  for (int y = 0; y < labels.rows; y++) {
    const int* label = labels.ptr<int>(y);
    const double* at = m.changed_at.ptr<double>(y);
    for (int x = 0; x < labels.cols; x++)
      lively[size_t(label[x])] += std::abs(frame.time - at[x]) < changed_memory;
  }
  std::vector<std::pair<int, Box>> regions;
  for (int i = 1; i < count; i++) {
    int area = stats.at<int>(i, cv::CC_STAT_AREA);
    if (area < smallest_region || lively[size_t(i)] * 20 < area) continue;
    result.share += float(area) / total;
    regions.push_back({area, Box{stats.at<int>(i, cv::CC_STAT_LEFT) / m.scale,
                                 stats.at<int>(i, cv::CC_STAT_TOP) / m.scale,
                                 stats.at<int>(i, cv::CC_STAT_WIDTH) / m.scale,
                                 stats.at<int>(i, cv::CC_STAT_HEIGHT) / m.scale}});
  }
  std::sort(regions.begin(), regions.end(), [](auto& a, auto& b) { return a.first > b.first; });
  for (size_t i = 0; i < regions.size() && i < 4; i++) result.zones.push_back(regions[i].second);
  result.moving = result.share >= m.settings.moving_share;
  return result;
}

}  // namespace wellspring::kiosk
