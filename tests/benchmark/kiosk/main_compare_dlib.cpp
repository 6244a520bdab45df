// SPDX-License-Identifier: Apache-2.0
// Debian's libdlib-dev and libdlib-data, where they are installed: an ensemble of regression trees
// (Kazemi, Sullivan, CVPR 2014) as another opinion on landmarks. Nothing of the product needs it.
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "base/clock.h"
#include "kiosk/camera.h"
#include "kiosk/face/face_finder.h"
#include "main_compare.h"

#ifdef WELLSPRING_DLIB
#include <dlib/image_processing.h>
#include <dlib/image_processing/frontal_face_detector.h>
#endif

namespace wellspring::test {

#ifdef WELLSPRING_DLIB
namespace {

constexpr const char* model_file = "/usr/share/dlib/shape_predictor_68_face_landmarks.dat";

struct Landmarks {
  dlib::frontal_face_detector detector = dlib::get_frontal_face_detector();
  dlib::shape_predictor predictor;
  std::vector<double> all, inner, detector_ms, trees_ms, network_ms;
  int faces = 0, unseen = 0;

  void look(FaceFinder& finder, const GrayFrame& frame, const Face& last) {
    double began = seconds_now();
    const auto face = finder.follow(frame, last);
    if (!face || !face->marks) return;
    network_ms.push_back(1000 * (seconds_now() - began));
    faces++;
    dlib::array2d<unsigned char> picture(frame.height, frame.width);
    std::copy(frame.pixels.begin(), frame.pixels.end(), &picture[0][0]);
    began = seconds_now();
    const auto found = detector(picture);
    detector_ms.push_back(1000 * (seconds_now() - began));
    const auto same = std::find_if(found.begin(), found.end(), [&](const dlib::rectangle& one) {
      return overlap({float(one.left()), float(one.top()), float(one.width()), float(one.height())},
                     face->box) > 0.3f;
    });
    if (same == found.end()) return void(unseen++);
    began = seconds_now();
    const auto shape = predictor(picture, *same);
    trees_ms.push_back(1000 * (seconds_now() - began));
    compare(*face->marks, shape);
  }

  void compare(const FaceMarks& ours, const dlib::full_object_detection& theirs) {
    vec2 left{0}, right{0};
    for (size_t k = 36; k < 42; k++) left += ours[k] / 6.f, right += ours[k + 6] / 6.f;
    const double eyes = glm::length(right - left);
    for (size_t k = 0; k < ours.size(); k++) {
      const dlib::point at = theirs.part(k);
      const double off = glm::length(ours[k] - vec2(float(at.x()), float(at.y()))) / eyes;
      all.push_back(off);
      if (k >= 17) inner.push_back(off);
    }
  }
};

}  // namespace

void compare_landmarks(const CompareOptions& options) {
  if (!std::filesystem::exists(model_file))
    return void(std::fprintf(stderr, "no other landmarks: libdlib-data is not installed\n"));
  if (!std::filesystem::exists(options.weights))
    return void(std::fprintf(stderr, "no other landmarks: no weights of the kiosk's own\n"));
  Landmarks marks;
  dlib::deserialize(model_file) >> marks.predictor;
  FaceSettings settings;
  settings.weights = options.weights;
  for (const char* clip : {"headtrackr/capture4.mp4", "tracking_js/franck.mp4",
                           "intel_sample_videos/preview/head-pose-face-detection-male.gif"}) {
    CameraSettings source;
    source.source = (std::filesystem::path(options.data) / "5_faces" / clip).string();
    if (!std::filesystem::exists(source.source)) continue;
    const auto camera = make_camera(source);
    const auto finder = make_face_finder(settings);
    GrayFrame frame;
    const int every = 10, most = options.quick ? 200 : 900;  // frames
    std::optional<Face> last;
    for (int k = 0; k < most && camera->next(frame) == Got::frame; k++) {
      if (last && k % every == 0) marks.look(*finder, frame, *last);
      if (last) last = finder->follow(frame, *last);
      if (!last)
        if (auto found = finder->search(frame); !found.empty()) last = found[0];
    }
  }
  if (marks.faces == 0)
    return void(std::fprintf(stderr, "no other landmarks: no recordings of faces\n"));
  tell("kiosk.marks.faces", marks.faces, "1");
  tell("kiosk.marks.unseen", double(marks.unseen) / marks.faces, "1");
  tell("kiosk.marks.apart", mean(marks.all), "1", {{"points", "all 68"}});
  tell("kiosk.marks.apart", mean(marks.inner), "1", {{"points", "without the jaw"}});
  tell("kiosk.marks.ms", mean(marks.detector_ms), "ms", {{"step", "dlib: find the face"}});
  tell("kiosk.marks.ms", mean(marks.trees_ms), "ms", {{"step", "dlib: landmarks"}});
  tell("kiosk.marks.ms", mean(marks.network_ms), "ms", {{"step", "kiosk: follow a face"}});
}
#else
void compare_landmarks(const CompareOptions&) {
  std::fprintf(stderr, "no other landmarks: libdlib-dev was not installed when this was built\n");
}
#endif

}  // namespace wellspring::test
