// SPDX-License-Identifier: Apache-2.0
#include "kiosk/camera.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>
#include <thread>

#include "base/clock.h"
#include "base/load_error.h"
#include "kiosk/figure.h"
#include "unit/folder.h"

namespace wellspring::test {
namespace {

std::unique_ptr<Camera> open(const std::string& source, bool loop = false) {
  CameraSettings settings{.source = source, .loop = loop};
  return make_camera(settings);
}

TEST(Camera, a_missing_file_and_a_file_that_is_no_video_are_named) {
  for (auto [name, content] : {std::pair<const char*, const char*>{"missing.mp4", nullptr},
                               {"empty.mp4", ""},
                               {"text.mp4", "not a video at all\n"}}) {
    const auto path = std::filesystem::path(testing::TempDir()) / (std::string("kiosk_") + name);
    std::filesystem::remove(path);
    if (content) std::ofstream(path) << content;
    try {
      open(path.string());
      ADD_FAILURE() << name << ": no error";
    } catch (const LoadError& error) {
      EXPECT_EQ(error.file, path.string());
      EXPECT_FALSE(error.what_.empty());
    }
    std::filesystem::remove(path);
  }
}

struct PictureFolder : testing::Test {
  test::Folder folder;
  void put(const std::string& name, int level) {
    cv::imwrite(folder.file(name), cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(level)));
  }
  void put_text(const std::string& name) { std::ofstream(folder.file(name)) << "no picture\n"; }
  std::string problem() {
    try {
      open(folder.path.string());
    } catch (const LoadError& error) {
      EXPECT_EQ(error.file, folder.path.string());
      return error.what_;
    }
    return "none";
  }
};

TEST_F(PictureFolder, PlaysInTheOrderOfNamesAtTheRateAndPassesOverWhatIsBroken) {
  put("b.png", 120);
  put("c.JPG", 180);
  put("a.jpeg", 60);
  put_text("aa.png");
  put_text("notes.txt");
  CameraSettings settings{.source = folder.path.string(), .rate = 8};
  for (int rounds : {1, 3}) {
    settings.loop = rounds > 1;
    auto camera = make_camera(settings);
    EXPECT_FALSE(camera->live());
    GrayFrame frame;
    for (int i = 0; i < 3 * rounds; i++) {
      ASSERT_EQ(camera->next(frame), Got::frame);
      EXPECT_EQ(frame.time, i / 8.0);
      EXPECT_EQ(frame.width, 64);
      EXPECT_EQ(frame.height, 48);
      EXPECT_NEAR(int(frame.pixels[1000]), 60 * (i % 3 + 1), 2);
      EXPECT_EQ(frame.bgr.size(), 64u * 48 * 3);
    }
    if (rounds == 1) {
      EXPECT_EQ(camera->next(frame), Got::end);
    }
  }
}

// A picture whose left half is dark and whose right half is bright; its upper left corner white.
cv::Mat two_halves() {
  cv::Mat picture(48, 64, CV_8UC3, cv::Scalar::all(40));
  picture(cv::Rect(32, 0, 32, 48)) = cv::Scalar::all(180);
  picture(cv::Rect(0, 0, 16, 16)) = cv::Scalar::all(255);
  return picture;
}

int level(const GrayFrame& frame, int x, int y) {
  return frame.pixels[size_t(y) * size_t(frame.width) + size_t(x)];
}

TEST_F(PictureFolder, OfACameraThatWasMountedOnItsSideIsTurnedUpright) {
  cv::imwrite(folder.file("a.png"), two_halves());
  struct Turn {
    float roll;
    bool mirrored;
    int width, x, y;  // place of the white corner
  };
  for (const Turn& turn : {Turn{0, false, 64, 2, 2},
                           {90, false, 48, 45, 2},
                           {-90, false, 48, 2, 61},
                           {180, false, 64, 61, 45},
                           {80, false, 48, 45, 2},
                           {90, true, 48, 2, 61}}) {
    CameraSettings settings{.source = folder.path.string()};
    settings.mount.roll = turn.roll * pi / 180, settings.mount.mirrored = turn.mirrored;
    GrayFrame frame;
    ASSERT_EQ(make_camera(settings)->next(frame), Got::frame);
    ASSERT_EQ(frame.width, turn.width) << turn.roll;
    EXPECT_EQ(frame.color_width, turn.width);
    EXPECT_GT(level(frame, turn.x, turn.y), 240) << turn.roll;
  }
}

TEST_F(PictureFolder, AFilmWithAQuarterTurnInItsHeaderIsShownUpright) {
  const std::string film = folder.file("film.mp4");
  cv::VideoWriter writer(film, cv::CAP_FFMPEG, cv::VideoWriter::fourcc('m', 'p', '4', 'v'), 10,
                         {64, 48});
  ASSERT_TRUE(writer.isOpened());
  for (int k = 0; k < 5; k++) writer.write(two_halves());
  writer.release();
  std::ifstream in(film, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(in)), {});
  // The matrix of the track's header (ISO/IEC 14496-12, 8.3.2), a quarter turn clockwise.
  const size_t header = bytes.find("tkhd");
  ASSERT_NE(header, std::string::npos);
  ASSERT_EQ(bytes[header + 4], 0) << "its version";
  constexpr uint32_t quarter[9] = {0, 0x10000, 0, 0xffff0000, 0, 0, 48 << 16, 0, 0x40000000};
  for (size_t k = 0; k < 36; k++)
    bytes[header + 44 + k] = char(quarter[k / 4] >> (8 * (3 - k % 4)));
  std::ofstream(film, std::ios::binary | std::ios::trunc) << bytes;
  GrayFrame frame;
  ASSERT_EQ(open(film)->next(frame), Got::frame);
  ASSERT_EQ(frame.width, 48);
  ASSERT_EQ(frame.height, 64);
  EXPECT_GT(level(frame, 45, 2), 200);
  EXPECT_LT(level(frame, 24, 10), 100);
  EXPECT_GT(level(frame, 24, 55), 120);
}

TEST_F(PictureFolder, WithoutAnyPictureIsAnError) {
  EXPECT_EQ(problem(), "no picture (.png, .jpg, .jpeg) in this folder");
  put_text("notes.txt");
  EXPECT_EQ(problem(), "no picture (.png, .jpg, .jpeg) in this folder");
  put_text("a.png");
  EXPECT_EQ(problem(), "no picture in this folder can be read");
  put("b.png", 9);
  EXPECT_EQ(problem(), "none");
}

TEST_F(PictureFolder, EndsOnceAllItsPicturesAreGone) {
  put("a.png", 50);
  auto camera = open(folder.path.string(), true);
  std::filesystem::remove(folder.file("a.png"));
  GrayFrame frame;
  EXPECT_EQ(camera->next(frame), Got::frame);
  EXPECT_EQ(camera->next(frame), Got::end);
}

TEST(Camera, a_device_that_is_not_there_is_lost_and_stays_patient) {
  auto camera = open("/dev/wellspring_no_such_camera");
  EXPECT_TRUE(camera->live());
  GrayFrame frame;
  EXPECT_EQ(camera->next(frame), Got::lost);
  EXPECT_EQ(camera->next(frame), Got::lost);
}

TEST(Camera, the_synthetic_one_repeats_itself_exactly_and_ends_on_demand) {
  CameraSettings settings{.source = "synthetic", .width = 160, .rate = 4, .synthetic_ends = true};
  auto a = make_camera(settings), b = make_camera(settings);
  GrayFrame x, y;
  int frames = 0;
  while (a->next(x) == Got::frame) {
    ASSERT_EQ(b->next(y), Got::frame);
    EXPECT_EQ(x.time, frames / 4.0);
    EXPECT_EQ(x.pixels, y.pixels);
    frames++;
  }
  EXPECT_EQ(frames, int(figure_round * 4));
}

TEST(Camera, the_synthetic_one_can_be_as_live_as_a_device) {
  CameraSettings settings{
      .source = "synthetic-live", .width = 160, .rate = 50, .synthetic_ends = true};
  auto camera = make_camera(settings);
  EXPECT_TRUE(camera->live());
  auto now = [] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch());
  };
  GrayFrame frame;
  double first = 0;
  for (int i = 0; i < 4; i++) {
    const double before = now().count();
    ASSERT_EQ(camera->next(frame), Got::frame);
    EXPECT_GE(frame.time, before);
    EXPECT_LE(frame.time, now().count());
    if (i == 0) first = frame.time;
    EXPECT_GE(frame.time, first + i / 50.0 - 1e-4) << "not before it is due";
  }
}

TEST(Camera, a_mirrored_mount_draws_the_mirror_image) {
  FigurePose pose{.visible = true, .position = {0.2f, 0, 0.8f}};
  Mount plain, mirrored;
  mirrored.mirrored = true;
  GrayFrame a = draw_figure({320, 240, 1, 0, 1}, plain, pose, 0);
  GrayFrame b = draw_figure({320, 240, 1, 0, 1}, mirrored, pose, 0);
  // The torso is dark: on the screen's right, so at the image's left, and the other way round in a
  // mirror.
  auto at = [](const GrayFrame& f, int x) { return int(f.pixels[size_t(230) * 320 + size_t(x)]); };
  EXPECT_LT(at(a, 90) + 10, at(a, 300));
  EXPECT_LT(at(b, 230) + 10, at(b, 20));
}

// A camera whose frames and failures a test decides.
struct Scripted : Camera {
  int frames = 5;
  double step = 0.05;
  bool is_live = false, hang = false;
  std::atomic<bool>* release = nullptr;
  int made = 0;
  Got next(GrayFrame& frame) override {
    while (hang && made == frames && !*release)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    if (made == frames) return is_live ? Got::lost : Got::end;
    frame = {made++ * step, 16, 16, std::vector<uint8_t>(256, 1)};
    return Got::frame;
  }
  bool live() const override { return is_live; }
};

TEST(Feed, without_pace_every_frame_arrives_in_order_however_slow_the_reader) {
  auto camera = std::make_unique<Scripted>();
  camera->frames = 20;
  Feed feed(std::move(camera), false);
  GrayFrame frame;
  for (int i = 0; i < 20; i++) {
    if (i % 5 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    ASSERT_EQ(feed.take(frame, 5), Fed::frame);
    EXPECT_DOUBLE_EQ(frame.time, i * 0.05);
  }
  EXPECT_EQ(feed.take(frame, 5), Fed::end);
  EXPECT_EQ(feed.take(frame, 5), Fed::end);
}

TEST(Feed, with_pace_a_file_takes_its_own_time_and_the_last_frame_arrives) {
  auto camera = std::make_unique<Scripted>();
  camera->frames = 6;
  const double begin = seconds_now();
  Feed feed(std::move(camera), true);
  GrayFrame frame;
  double last = -1;
  Fed fed;
  while ((fed = feed.take(frame, 5)) == Fed::frame) {
    EXPECT_GT(frame.time, last);
    last = frame.time;
  }
  EXPECT_EQ(fed, Fed::end);
  EXPECT_DOUBLE_EQ(last, 0.25);
  EXPECT_GE(seconds_now() - begin, 0.24);
}

TEST(Feed, a_camera_that_hangs_does_not_hang_the_reader) {
  static std::atomic<bool> release{false};
  auto camera = std::make_unique<Scripted>();
  camera->is_live = camera->hang = true;
  camera->frames = 1;
  camera->release = &release;
  Feed feed(std::move(camera), true);
  GrayFrame frame;
  EXPECT_EQ(feed.take(frame, 5), Fed::frame);
  EXPECT_EQ(feed.take(frame, 0.05), Fed::nothing);
  release = true;
}

}  // namespace
}  // namespace wellspring::test
