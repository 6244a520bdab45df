// SPDX-License-Identifier: Apache-2.0
#include "kiosk/camera.h"

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <optional>
#include <thread>

#include "base/clock.h"
#include "base/load_error.h"
#include "base/log.h"
#include "kiosk/figure.h"

namespace wellspring::kiosk {

namespace {

// Makes the small picture in colour; a grey picture gives none.
void to_color(const cv::Mat& picture, GrayFrame& frame) {
  constexpr int width = 320;
  frame.color_width = frame.color_height = 0;
  frame.bgr.clear();
  if (picture.channels() != 3) return;
  cv::Mat small = picture;
  if (picture.cols > width)
    cv::resize(picture, small, {width, std::max(16, picture.rows * width / picture.cols)}, 0, 0,
               cv::INTER_AREA);
  frame.color_width = small.cols;
  frame.color_height = small.rows;
  frame.bgr.resize(size_t(small.cols) * size_t(small.rows) * 3);
  small.copyTo(cv::Mat(small.rows, small.cols, CV_8UC3, frame.bgr.data()));
}

// Turns a picture clockwise by quarter turns; below 0: the other way.
cv::Mat turned(const cv::Mat& picture, int quarters) {
  constexpr cv::RotateFlags ways[] = {cv::ROTATE_90_CLOCKWISE, cv::ROTATE_180,
                                      cv::ROTATE_90_COUNTERCLOCKWISE};
  const int turns = (quarters % 4 + 4) % 4;
  if (turns == 0) return picture;
  cv::Mat out;
  cv::rotate(picture, out, ways[turns - 1]);
  return out;
}

// Makes luminance of a camera's picture, upright and at no more than settings.width pixels across.
// False for data that is no picture.
bool to_gray(const cv::Mat& taken, const CameraSettings& settings, GrayFrame& frame) {
  if (taken.empty() || taken.cols < 16 || taken.rows < 16 || taken.depth() != CV_8U) return false;
  const Mount& mount = settings.mount;
  const cv::Mat picture = turned(taken, quarter_turns(mount) * (mount.mirrored ? -1 : 1));
  const int width = settings.width;
  cv::Mat gray = picture;
  if (picture.channels() == 3) cv::cvtColor(picture, gray, cv::COLOR_BGR2GRAY);
  else if (picture.channels() == 4) cv::cvtColor(picture, gray, cv::COLOR_BGRA2GRAY);
  else if (picture.channels() != 1) return false;
  if (gray.cols > width) {
    cv::Mat small;
    int height = std::max(16, int(std::lround(double(gray.rows) * width / gray.cols)));
    cv::resize(gray, small, {width, height}, 0, 0, cv::INTER_AREA);
    gray = small;
  }
  frame.width = gray.cols;
  frame.height = gray.rows;
  frame.pixels.resize(size_t(gray.cols) * size_t(gray.rows));
  gray.copyTo(cv::Mat(gray.rows, gray.cols, CV_8U, frame.pixels.data()));
  to_color(picture, frame);
  return true;
}

// OpenCV 4.6 turns films the other way than their header says (its issue 22088; mended in 4.7).
constexpr bool turns_films_wrongly = CV_VERSION_MAJOR == 4 && CV_VERSION_MINOR == 6;

class FileCamera : public Camera {
 public:
  explicit FileCamera(const CameraSettings& settings) : settings_(settings) {
    const std::string& path = settings.source;
    std::error_code ec;
    if (!std::filesystem::exists(path, ec)) throw LoadError(path, "", "no such file");
    if (!std::filesystem::is_regular_file(path, ec)) throw LoadError(path, "", "not a file");
    open();
    if (!read(first_)) throw LoadError(path, "", "not a video that can be read");
    has_first_ = true;
  }
  bool live() const override { return false; }

  Got next(GrayFrame& frame) override {
    if (has_first_) {
      has_first_ = false;
      std::swap(frame, first_);
      return Got::frame;
    }
    if (read(frame)) return Got::frame;
    if (!settings_.loop) return Got::end;
    begin_ = last_ + step();
    open();
    return read(frame) ? Got::frame : Got::end;
  }

 private:
  void open() {
    index_ = 0;
    // Readers are named: left to itself OpenCV would go on to look for cameras on the USB bus.
    for (int reader : {cv::CAP_FFMPEG, cv::CAP_GSTREAMER, cv::CAP_OPENCV_MJPEG}) {
      try {
        if (capture_.open(settings_.source, reader)) break;
      } catch (const cv::Exception&) {}
    }
    turn_ = 0;
    if (turns_films_wrongly && capture_.set(cv::CAP_PROP_ORIENTATION_AUTO, 0))
      turn_ = 4 - int(capture_.get(cv::CAP_PROP_ORIENTATION_META)) / 90;
    double fps = capture_.isOpened() ? capture_.get(cv::CAP_PROP_FPS) : 0;
    fps_ = std::isfinite(fps) && fps >= 1 && fps <= 1000 ? fps : 25;
  }
  double step() const { return 1 / fps_; }

  // Reads the next frame that can be decoded. Its time is the file's own if that grows, else the
  // frame rate's.
  bool read(GrayFrame& frame) {
    try {
      for (int bad = 0; bad < 100 && capture_.isOpened() && capture_.read(picture_); bad++) {
        double own = capture_.get(cv::CAP_PROP_POS_MSEC) / 1000;
        double time = index_ == 0 ? begin_ : last_ + step();
        if (index_ > 0 && std::isfinite(own) && begin_ + own > last_ + 1e-4 &&
            begin_ + own < last_ + 10)
          time = begin_ + own;
        if (!to_gray(turned(picture_, turn_), settings_, frame)) continue;
        index_++;
        frame.time = last_ = time;
        return true;
      }
    } catch (const cv::Exception&) {  // a broken stream ends where it breaks
    }
    return false;
  }

  CameraSettings settings_;
  cv::VideoCapture capture_;
  cv::Mat picture_;
  GrayFrame first_;
  bool has_first_ = false;
  long index_ = 0;
  int turn_ = 0;  // quarter turns, clockwise, that are left to be done by us
  double begin_ = 0, last_ = 0, fps_ = 25;
};

bool is_picture_name(const std::filesystem::path& path) {
  std::string end = path.extension().string();
  std::transform(end.begin(), end.end(), end.begin(), ::tolower);
  return end == ".png" || end == ".jpg" || end == ".jpeg";
}

class FolderCamera : public Camera {
 public:
  explicit FolderCamera(const CameraSettings& settings) : settings_(settings) {
    const std::string& path = settings.source;
    std::error_code ec;
    for (std::filesystem::directory_iterator at(path, ec), end; !ec && at != end; at.increment(ec))
      if (is_picture_name(at->path())) files_.push_back(at->path().string());
    if (ec) throw LoadError(path, "", "cannot be read: " + ec.message());
    if (files_.empty()) throw LoadError(path, "", "no picture (.png, .jpg, .jpeg) in this folder");
    std::sort(files_.begin(), files_.end());
    if (!read(first_)) throw LoadError(path, "", "no picture in this folder can be read");
    has_first_ = true;
  }
  bool live() const override { return false; }

  Got next(GrayFrame& frame) override {
    if (has_first_) {
      has_first_ = false;
      std::swap(frame, first_);
      return Got::frame;
    }
    if (read(frame)) return Got::frame;
    if (!settings_.loop) return Got::end;
    next_ = 0;
    return read(frame) ? Got::frame : Got::end;
  }

 private:
  // Reads the next picture that can be read. Others are named once and left out.
  bool read(GrayFrame& frame) {
    while (next_ < files_.size()) {
      cv::Mat picture;
      try {
        picture = cv::imread(files_[next_], cv::IMREAD_COLOR);
      } catch (const cv::Exception&) {  // damaged, or larger than OpenCV takes
      }
      if (to_gray(picture, settings_, frame)) {
        next_++;
        frame.time = double(index_++) / settings_.rate;
        return true;
      }
      log::warn("{} is no picture that can be read: passed over", files_[next_]);
      files_.erase(files_.begin() + ptrdiff_t(next_));
    }
    return false;
  }

  CameraSettings settings_;
  std::vector<std::string> files_;
  GrayFrame first_;
  bool has_first_ = false;
  size_t next_ = 0;
  long index_ = 0;
};

class DeviceCamera : public Camera {
 public:
  explicit DeviceCamera(const CameraSettings& settings) : settings_(settings) {
    setenv("OPENCV_VIDEOIO_V4L_SELECT_TIMEOUT", "2", 0);  // seconds; OpenCV's own default is 10
    const std::string& source = settings.source;
    bool number = std::all_of(source.begin(), source.end(), ::isdigit);
    path_ = number ? "/dev/video" + source : source;
  }
  bool live() const override { return true; }
  std::string name() const override { return path_; }

  Got next(GrayFrame& frame) override {
    try {
      if (!capture_.isOpened() && !open()) return Got::lost;
      if (!capture_.read(picture_) || !to_gray(picture_, settings_, frame)) return lose();
    } catch (const cv::Exception&) {
      return lose();
    }
    frame.time = seconds_now();
    // A sensor's noise never repeats: a picture that repeats comes from a driver that has stopped.
    if (frame.pixels == last_) {
      if (frame.time - changed_ > 2) return lose();
    } else {
      last_ = frame.pixels;
      changed_ = frame.time;
    }
    return Got::frame;
  }

 private:
  bool open() {
    std::error_code ec;
    if (!std::filesystem::exists(path_, ec) || !capture_.open(path_, cv::CAP_V4L2)) return false;
    capture_.set(cv::CAP_PROP_FRAME_WIDTH, settings_.width);
    capture_.set(cv::CAP_PROP_FRAME_HEIGHT, settings_.width * 3 / 4);
    capture_.set(cv::CAP_PROP_FPS, settings_.rate);
    capture_.set(cv::CAP_PROP_BUFFERSIZE, 1);
    changed_ = seconds_now();
    last_.clear();
    return true;
  }
  Got lose() {
    capture_.release();
    return Got::lost;
  }

  CameraSettings settings_;
  std::string path_;
  cv::VideoCapture capture_;
  cv::Mat picture_;
  std::vector<uint8_t> last_;
  double changed_ = 0;
};

class SyntheticCamera : public Camera {
 public:
  SyntheticCamera(const CameraSettings& settings, bool live) : settings_(settings), live_(live) {
    room_.width = std::clamp(settings.width, 160, 1280);
    room_.height = room_.width * 3 / 4;
    if (quarter_turns(settings.mount) % 2 != 0) std::swap(room_.width, room_.height);
  }
  bool live() const override { return live_; }
  Got next(GrayFrame& frame) override {
    double time = double(index_++) / settings_.rate;
    if (settings_.synthetic_ends && !live_ && time >= figure_round) return Got::end;
    frame = draw_figure(room_, settings_.mount, figure_at(time), time);
    if (!live_) return Got::frame;
    // It acts as a device: at its rate, and a late frame is not made up for.
    auto now = [] { return duration(std::chrono::steady_clock::now().time_since_epoch()).count(); };
    std::this_thread::sleep_for(duration(due_ - now()));
    frame.time = now();
    if (frame.time - due_ > 1 / settings_.rate) due_ = frame.time;
    due_ += 1 / settings_.rate;
    return Got::frame;
  }

 private:
  using duration = std::chrono::duration<double>;
  CameraSettings settings_;
  bool live_;
  FigureRoom room_;
  long index_ = 0;
  double due_ = 0;  // time of the next frame on the steady clock
};

}  // namespace

std::unique_ptr<Camera> make_camera(const CameraSettings& settings) {
  // Errors are reported in our own words.
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", 0);
  const std::string& source = settings.source;
  if (source == "synthetic" || source == "synthetic-live")
    return std::make_unique<SyntheticCamera>(settings, source == "synthetic-live");
  bool number =
      !source.empty() && source.size() < 4 && std::all_of(source.begin(), source.end(), ::isdigit);
  if (number || source.rfind("/dev/", 0) == 0) return std::make_unique<DeviceCamera>(settings);
  std::error_code ec;
  if (std::filesystem::is_directory(source, ec)) return std::make_unique<FolderCamera>(settings);
  return std::make_unique<FileCamera>(settings);
}

namespace {

constexpr int every = 4;         // pixels from one looked at to the next, both ways
constexpr int darkest = 16;      // levels: in a black picture hardly any pixel exceeds this
constexpr double rate_over = 5;  // seconds over which the rate is measured

}  // namespace

CameraState CameraWatch::step(const GrayFrame& frame) {
  now_.clear();
  for (int y = 0; y < frame.height; y += every)
    for (int x = 0; x < frame.width; x += every)
      now_.push_back(frame.pixels[size_t(y) * size_t(frame.width) + size_t(x)]);
  if (times_.empty() || frame.time < times_.back()) {
    times_.clear();
    begun_ = dark_since_ = same_since_ = frame.time;
    before_.clear();
  }
  const auto bright =
      std::count_if(now_.begin(), now_.end(), [](uint8_t level) { return level > darkest; });
  if (bright * 200 > ptrdiff_t(now_.size())) dark_since_ = frame.time;
  if (now_ != before_) same_since_ = frame.time;
  std::swap(now_, before_);
  times_.push_back(frame.time);
  while (times_.front() < frame.time - rate_over) times_.pop_front();
  if (frame.time - dark_since_ >= told_after) return CameraState::dark;
  if (frame.time - same_since_ >= told_after) return CameraState::frozen;
  const bool known = frame.time - begun_ >= rate_over;
  if (known && double(times_.size()) < least_rate * rate_over) return CameraState::slow;
  return CameraState::good;
}

CameraState CameraWatch::step_blind() {
  times_.clear();
  return CameraState::missing;
}

namespace {
std::chrono::duration<double> seconds(double s) { return std::chrono::duration<double>(s); }
}  // namespace

struct Feed::Shared {
  std::mutex mutex;
  std::condition_variable changed;
  std::unique_ptr<Camera> camera;
  bool pace = false, stop = false, ended = false, finished = false;
  std::optional<GrayFrame> slot;

  // Sleeps; false when it is time to stop.
  bool rest(double length) {
    std::unique_lock lock(mutex);
    return !changed.wait_for(lock, seconds(length), [&] { return stop; });
  }

  void deliver(GrayFrame frame) {
    std::unique_lock lock(mutex);
    // Paced and live cameras overwrite frames that nobody took; an unpaced one waits for its
    // reader.
    if (!camera->live() && !pace) changed.wait(lock, [&] { return stop || !slot; });
    if (stop) return;
    slot = std::move(frame);
    changed.notify_all();
  }

  void run() {
    const bool live = camera->live();
    bool lost = false;
    double begin = 0;
    bool first = true;
    for (;;) {
      {
        std::lock_guard lock(mutex);
        if (stop) break;
      }
      GrayFrame frame;
      Got got = camera->next(frame);
      if (got == Got::end) break;
      if (got == Got::lost) {
        if (!lost) log::warn("{} gives no picture; trying again every second", camera->name());
        lost = true;
        if (!rest(1)) break;
        continue;
      }
      if (lost) log::info("{} is back", camera->name());
      lost = false;
      if (!live && pace) {
        if (first) begin = seconds_now() - frame.time;
        double wait = begin + frame.time - seconds_now();
        if (wait > 0 && !rest(wait)) break;
      }
      first = false;
      deliver(std::move(frame));
    }
    std::lock_guard lock(mutex);
    ended = finished = true;
    changed.notify_all();
  }
};

Feed::Feed(std::unique_ptr<Camera> camera, bool pace) : shared_(std::make_shared<Shared>()) {
  shared_->camera = std::move(camera);
  shared_->pace = pace;
  std::thread([shared = shared_] { shared->run(); }).detach();
}

Feed::~Feed() {
  std::unique_lock lock(shared_->mutex);
  shared_->stop = true;
  shared_->changed.notify_all();
  shared_->changed.wait_for(lock, seconds(3), [&] { return shared_->finished; });
}

Fed Feed::take(GrayFrame& frame, double wait) {
  std::unique_lock lock(shared_->mutex);
  Shared& s = *shared_;
  s.changed.wait_for(lock, seconds(wait), [&] { return s.slot || s.ended; });
  if (s.slot) {
    frame = std::move(*s.slot);
    s.slot.reset();
    s.changed.notify_all();
    return Fed::frame;
  }
  return s.ended ? Fed::end : Fed::nothing;
}

}  // namespace wellspring::kiosk
