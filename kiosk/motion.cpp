// SPDX-License-Identifier: Apache-2.0
#include "kiosk/motion.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/background_segm.hpp>

namespace wellspring::kiosk {

namespace {

constexpr float changed_levels = 12;  // grey levels between two frames that noise does not reach
constexpr double changed_memory = 1;  // seconds a change is remembered
constexpr int smallest_region = 40;   // pixels of the working picture

double median(cv::Mat values) {  // of an 8-bit picture
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
  cv::Mat reference;    // float: slow mean of the corrected pictures, what brightness is matched to
  cv::Mat previous;     // the last corrected picture
  cv::Mat changed_at;   // double: when each pixel last changed
  cv::Mat changed_now;  // 8 bit
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
    changed_now = cv::Mat::zeros(small.size(), CV_8U);
    last_time = time;
  }

  // The gain that brings most pixels of `small` to the reference: the median of their ratios, which
  // people covering less than half of the picture do not move.
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
  cv::threshold(difference, m.changed_now, changed_levels, 255, cv::THRESH_BINARY);
  m.previous = corrected;
  m.changed_at.setTo(frame.time, m.changed_now);

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

float MotionWatch::changed(const Box& box) const {
  const Impl& m = *impl_;
  if (m.changed_now.empty()) return 0;
  cv::Rect area(int(box.x * m.scale), int(box.y * m.scale), int(std::ceil(box.width * m.scale)),
                int(std::ceil(box.height * m.scale)));
  area &= cv::Rect(0, 0, m.changed_now.cols, m.changed_now.rows);
  return area.empty() ? 0 : float(cv::countNonZero(m.changed_now(area))) / float(area.area());
}

}  // namespace wellspring::kiosk
