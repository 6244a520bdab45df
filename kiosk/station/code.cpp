// SPDX-License-Identifier: Apache-2.0
#include "kiosk/station/code.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <opencv2/objdetect.hpp>

namespace wellspring::kiosk {
namespace {

constexpr int most_version = 10;
constexpr float most_wrong = 0.12f;  // share of modules; codes of other texts differ in a half

// Returns the corners of a code, from its own upper left one clockwise; empty: there is none.
std::vector<vec2> find_code(int width, int height, const uint8_t* gray) {
  const cv::Mat picture(height, width, CV_8U, const_cast<uint8_t*>(gray));
  std::vector<cv::Point2f> corners;
  std::vector<vec2> out;
  try {
    if (!cv::QRCodeDetector().detect(picture, corners) || corners.size() != 4) return {};
  } catch (const cv::Exception&) {
    return {};  // some pictures are too much for it
  }
  for (const cv::Point2f& corner : corners) out.emplace_back(corner.x, corner.y);
  return out;
}

std::string sample(int width, int height, const uint8_t* gray, const std::vector<vec2>& corners,
                   int side) {
  constexpr int each = 6;  // pixels of a module
  const float whole = float(each * side);
  std::vector<cv::Point2f> from{{0, 0}, {whole, 0}, {whole, whole}, {0, whole}}, to;
  for (const vec2& corner : corners) to.emplace_back(corner.x, corner.y);
  const cv::Mat picture(height, width, CV_8U, const_cast<uint8_t*>(gray));
  cv::Mat flat, small, even;
  cv::warpPerspective(picture, flat, cv::getPerspectiveTransform(from, to),
                      {each * side, each * side}, cv::INTER_LINEAR | cv::WARP_INVERSE_MAP,
                      cv::BORDER_REPLICATE);
  cv::resize(flat, small, {side, side}, 0, 0, cv::INTER_AREA);
  cv::threshold(small, even, 0, 1, cv::THRESH_BINARY_INV | cv::THRESH_OTSU);
  std::string out;
  for (int y = 0; y < side; y++)
    for (int x = 0; x < side; x++) out += even.at<uint8_t>(y, x) ? '1' : '0';
  return out;
}

// Returns the share of wrong modules among those that every code of that size has.
float wrong_of_frame(const std::string& code, int side) {
  int wrong = 0, count = 0;
  auto check = [&](int x, int y, bool dark) {
    wrong += (code[size_t(y * side + x)] == '1') != dark;
    count++;
  };
  for (int i = 8; i < side - 8; i++) check(i, 6, i % 2 == 0), check(6, i, i % 2 == 0);
  for (int y = 0; y < 7; y++)
    for (int x = 0; x < 7; x++) {
      const int ring = std::max(std::abs(x - 3), std::abs(y - 3));
      for (const auto& [left, top] : {std::pair(0, 0), {side - 7, 0}, {0, side - 7}})
        check(left + x, top + y, ring != 2);
    }
  return float(wrong) / float(count);
}

}  // namespace

std::string read_code(int width, int height, const uint8_t* gray) {
  const auto corners = find_code(width, height, gray);
  if (corners.empty()) return {};
  std::string best;
  float least = 0.06f;
  for (int version = 1; version <= most_version; version++) {
    const int side = 17 + 4 * version;
    std::string code = sample(width, height, gray, corners, side);
    const float wrong = wrong_of_frame(code, side);
    if (wrong < least) least = wrong, best = std::move(code);
  }
  return best;
}

bool CodeSolver::sees(int node) {
  const std::string& own = tree_.data[size_t(node)].code;
  const GrayFrame& frame = *sight_.frame;
  if (own.empty()) return false;
  if (number_ != sight_.number) {
    number_ = sight_.number;
    corners_ = find_code(frame.width, frame.height, frame.pixels.data());
  }
  if (corners_.empty()) return false;
  const int side = int(std::lround(std::sqrt(double(own.size()))));
  const auto seen = sample(frame.width, frame.height, frame.pixels.data(), corners_, side);
  size_t wrong = 0;
  for (size_t i = 0; i < own.size(); i++) wrong += own[i] != seen[i];
  return float(wrong) <= most_wrong * float(own.size());
}

Answer CodeSolver::match(int, int child, ContextStore&) {
  return {sees(child) ? Verdict::sure : Verdict::no};
}

bool CodeSolver::verify(int node, ContextStore&) { return sees(node); }

}  // namespace wellspring::kiosk
