// SPDX-License-Identifier: Apache-2.0
// How often pictures of faces are taken for visitors.
#include "main_measure.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <functional>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "base/rng.h"
#include "kiosk/face/face_finder.h"
#include "kiosk/figure.h"

namespace wellspring::test {

namespace fs = std::filesystem;

namespace {

constexpr double print_rate = 15;
constexpr int width = 640, height = 480;

GrayFrame to_frame(const cv::Mat& picture, double time) {
  GrayFrame frame{time, picture.cols, picture.rows, {}};
  cv::Mat gray, small;
  cv::cvtColor(picture, gray, cv::COLOR_BGR2GRAY);
  frame.pixels.assign(gray.data, gray.data + gray.total());
  cv::resize(picture, small, {320, 320 * picture.rows / picture.cols}, 0, 0, cv::INTER_AREA);
  frame.color_width = small.cols, frame.color_height = small.rows;
  frame.bgr.assign(small.data, small.data + 3 * small.total());
  return frame;
}

// How a sheet is held: sizes in radians and pixels, paces in radians a second.
struct Hold {
  float yaw = 0, yaw_pace = 0, roll = 0, roll_pace = 0, across = 0, across_pace = 0, up = 0;
};

Hold held_by_hand(Rng& random) {
  auto between = [&](float low, float high) { return low + (high - low) * random.uniform(); };
  return {between(0.2f, 0.6f), between(0.8f, 2.5f), between(0, 0.3f), between(0.4f, 1.5f),
          between(20, 110),    between(0.5f, 1.5f), between(5, 40)};
}

// A sheet of paper before a blurred room, seen by a sensor with noise.
cv::Mat see_sheet(const cv::Mat& sheet, const Hold& hold, double time, cv::RNG& noise) {
  cv::Mat out(height, width, CV_8UC3, cv::Scalar(120, 130, 140));
  for (int k = 0; k < 9; k++)  // a room with some furniture
    cv::rectangle(out, {k * 83 % 600, 40 + k * 131 % 300, 60 + 9 * k, 50 + 13 * k},
                  cv::Scalar::all(60 + 20 * k), cv::FILLED);
  cv::GaussianBlur(out, out, {0, 0}, 3);
  const double yaw = hold.yaw * std::sin(hold.yaw_pace * time + 1);
  const double roll = hold.roll * std::sin(hold.roll_pace * time);
  const double across = hold.across * std::sin(hold.across_pace * time);
  const double up = hold.up * std::sin(1.7 * hold.across_pace * time);
  const float w = float(sheet.cols), h = float(sheet.rows);
  const std::vector<cv::Point2f> from = {{0, 0}, {w, 0}, {w, h}, {0, h}};
  std::vector<cv::Point2f> to;
  for (const cv::Point2f& corner : from) {
    const double x = corner.x - w / 2, y = corner.y - h / 2;
    const double away = 900 + x * std::sin(yaw), flat = x * std::cos(yaw);
    to.emplace_back(float(320 + across + 700 * (flat * std::cos(roll) - y * std::sin(roll)) / away),
                    float(240 + up + 700 * (flat * std::sin(roll) + y * std::cos(roll)) / away));
  }
  const cv::Mat homography = cv::getPerspectiveTransform(from, to);
  cv::Mat laid, where;
  cv::warpPerspective(sheet, laid, homography, out.size());
  cv::warpPerspective(cv::Mat(sheet.size(), CV_8U, cv::Scalar(255)), where, homography, out.size(),
                      cv::INTER_NEAREST);
  laid.copyTo(out, where);
  cv::Mat sensor(out.size(), CV_16SC3), seen;
  noise.fill(sensor, cv::RNG::NORMAL, 0, 4);
  out.convertTo(seen, CV_16SC3);
  seen += sensor;
  seen.convertTo(out, CV_8UC3);
  return out;
}

cv::Mat fitted(const cv::Mat& photo) {
  cv::Mat out;
  const double scale = 500. / std::max(photo.cols, photo.rows);
  cv::resize(photo, out, {}, scale, scale, cv::INTER_AREA);
  return out;
}

// Photographs of the data where they are present, and the synthetic visitor's.
std::vector<cv::Mat> photographs(const MeasureOptions& options) {
  std::vector<cv::Mat> out;
  FigurePose pose{.visible = true};
  const GrayFrame drawn = draw_figure({width, height, 1, 0, 1}, {}, pose, 0);
  cv::Mat gray(height, width, CV_8U, const_cast<uint8_t*>(drawn.pixels.data())), color;
  cv::cvtColor(gray, color, cv::COLOR_GRAY2BGR);
  out.push_back(fitted(color));
  std::vector<fs::path> files;
  std::error_code none;
  for (const char* folder : {"5_faces/dlib/faces", "5_faces/tracking_js"})
    for (const auto& entry : fs::directory_iterator(fs::path(options.data) / folder, none))
      if (entry.path().extension() == ".jpg") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files)
    if (const cv::Mat photo = cv::imread(file.string()); !photo.empty())
      out.push_back(fitted(photo));
  return out;
}

// A page that has the eyes of the photograph's largest face six times and nothing else of it.
cv::Mat page_of_eyes(const cv::Mat& photo, FaceFinder& finder) {
  std::vector<Face> faces;
  for (int k = 0; k < 8 && faces.empty(); k++) faces = finder.search(to_frame(photo, k));
  if (faces.empty()) return {};
  const Box& box = faces.front().box;
  const cv::Rect eyes(int(box.x), int(box.y + 0.12f * box.height), int(box.width),
                      int(0.36f * box.height));
  const cv::Rect inside = eyes & cv::Rect({}, photo.size());
  if (inside.width < 20 || inside.height < 8) return {};
  cv::Mat strip, page(480, 360, CV_8UC3, cv::Scalar::all(225));
  cv::resize(photo(inside), strip, {150, 54}, 0, 0, cv::INTER_CUBIC);
  for (int row = 0; row < 3; row++)
    for (int column = 0; column < 2; column++)
      strip.copyTo(page(cv::Rect(20 + 170 * column, 50 + 140 * row, 150, 54)));
  return page;
}

}  // namespace

void measure_prints(const MeasureOptions& options) {
  const auto finder = make_network_finder(options.weights);
  std::vector<cv::Mat> photos = photographs(options);
  if (options.quick && photos.size() > 4) photos.resize(4);
  Rng random(3);
  cv::RNG noise(5);
  auto watch = [&](const std::string& how, const std::function<cv::Mat(const cv::Mat&)>& sheet_of,
                   bool by_hand) {
    Mean people;
    int sheets = 0;
    for (const cv::Mat& photo : photos) {
      const cv::Mat sheet = sheet_of(photo);
      if (sheet.empty()) continue;
      const Hold hold = by_hand ? held_by_hand(random) : Hold{};
      Observer observer(settings_of(options, "networks"));
      for (int k = 0; k < int((options.quick ? 6 : 12) * print_rate); k++) {
        const double time = k / print_rate;
        const auto seen = observer.step(to_frame(see_sheet(sheet, hold, time, noise), time));
        people.add(!seen.people.empty());
      }
      sheets++;
    }
    tell("kiosk.printed_faces", people.value(), "1", {{"how", how}, {"prints", sheets}});
  };
  const auto whole = [](const cv::Mat& photo) { return photo; };
  watch("a print moved by hand", whole, true);
  watch("a poster on the wall", whole, false);
  watch(
      "a book with printed eyes",
      [&](const cv::Mat& photo) { return page_of_eyes(photo, *finder); }, true);
}

}  // namespace wellspring::test
