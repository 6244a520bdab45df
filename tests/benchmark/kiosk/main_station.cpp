// SPDX-License-Identifier: Apache-2.0
// wellspring_kiosk_station: how quickly and how surely a station tells what is held, for
// `wellspring bench --only kiosk.station`, which starts it. Prints one JSON object a result.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/objdetect.hpp>

#include "about/version.h"
#include "base/log.h"
#include "benchmark/kiosk/made_objects.h"
#include "kiosk/camera.h"
#include "kiosk/station/box.h"
#include "kiosk/station/code.h"
#include "kiosk/station/station.h"
#include "tell.h"

namespace {

using namespace wellspring;
using namespace wellspring::test;
namespace fs = std::filesystem;
using nlohmann::json;

double process_ms() {
  timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e3 * double(now.tv_sec) + 1e-6 * double(now.tv_nsec);
}

double part_of(std::vector<double> values, double part) {
  if (values.empty()) return 0;
  std::ranges::sort(values);
  return values[std::min(values.size() - 1, size_t(part * double(values.size())))];
}

std::string id_of(const Station& station, const Recognition& found) {
  return found.node < 0 ? "" : station.tree().nodes[size_t(found.node)].id;
}

GrayFrame show(const cv::Mat& face, const Held& held, unsigned seed, double time) {
  cv::Mat picture = make_room(seed);
  put_face(picture, face, held);
  put_fingers(picture, held);
  return to_frame(picture, time, 0.8, 4, unsigned(time * 1000) + seed);
}

// Sums up a station while people without objects were before the camera.
struct Watched {
  double seconds = 0, ms = 0;  // seconds of recordings; time of the processor
  int names = 0;               // names told
};

// Plays recordings at their own rates, one after the other, until they have lasted `seconds`.
Watched watch_people(Station& station, const std::string& data, double seconds) {
  std::vector<fs::path> files;
  if (!data.empty())
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(data) / "5_faces"))
      if (const auto end = entry.path().extension(); end == ".mp4" || end == ".mkv")
        files.push_back(entry.path());
  std::ranges::sort(files);
  constexpr double longest = 60;  // seconds of one recording
  Watched out;
  station.forget();
  for (double round = -1; out.seconds > round && out.seconds < seconds;) {
    round = out.seconds;  // no recording can be read: nothing is added
    for (const fs::path& file : files) {
      CameraSettings source;
      source.source = file.string();
      std::unique_ptr<Camera> camera;
      try {
        camera = make_camera(source);
      } catch (const std::exception&) {
        continue;
      }
      const double begins = out.seconds;
      bool told = false;
      for (GrayFrame frame; camera->next(frame) == Got::frame && frame.time < longest;) {
        frame.time += begins;
        out.seconds = std::max(out.seconds, frame.time);
        if (out.seconds > seconds) return out;
        const double before = process_ms();
        const bool now = station.step(frame).has_value();
        out.ms += process_ms() - before;
        out.names += now && !told;
        told = now;
      }
    }
  }
  return out;
}

void measure_objects(int count, bool quick, const std::string& data) {
  std::vector<cv::Mat> faces;
  std::vector<LearnObject> objects;
  for (int i = 0; i < count; i++) {
    faces.push_back(make_face(unsigned(i)));
    objects.push_back(make_object(std::to_string(i), {{faces.back(), "front"}}));
  }
  Station station(learn_tree(std::move(objects), "made").tree);
  const json fields{{"objects", count}};
  std::vector<double> cold, coherent, empty, matches;
  int named = 0, wrong = 0, tries = 0;
  for (int i = 0; i < count; i++) {
    station.forget();
    Held held = random_held(unsigned(i) + 300);
    const GrayFrame first = show(faces[size_t(i)], held, unsigned(i), 0);
    double before = process_ms();
    const Recognition found = station.look(first);
    cold.push_back(process_ms() - before);
    matches.push_back(found.matches);
    tries++;
    const std::string id = id_of(station, found);
    named += id == std::to_string(i);
    wrong += !id.empty() && id != std::to_string(i);
    for (int k = 1; k < (quick ? 3 : 6) && found.node >= 0; k++) {
      held.x += 3, held.roll += 0.01f;
      const GrayFrame next = show(faces[size_t(i)], held, unsigned(i), k / 30.0);
      before = process_ms();
      const Recognition again = station.look(next);
      if (again.kept) coherent.push_back(process_ms() - before);
    }
  }
  // One that is held up again and again is found with fewer matches, the way to it is learnt.
  std::vector<double> often;
  for (int i = 0; i < 8; i++) {
    station.forget();
    const int last = count - 1;
    const GrayFrame frame = show(faces[size_t(last)], random_held(unsigned(i) + 900), 5, 0);
    if (const Recognition found = station.look(frame); found.node >= 0 && i >= 3)
      often.push_back(found.matches);
  }
  int frames = 0, false_names = 0;
  for (unsigned seed = 0; seed < (quick ? 20u : 100u); seed++) {
    station.forget();
    // Every other frame holds an object that was not learnt.
    const GrayFrame frame = seed % 2 ? show(make_face(5000 + seed), random_held(seed), seed, 0)
                                     : to_frame(make_room(1000 + seed), 0);
    const double before = process_ms();
    false_names += station.look(frame).node >= 0;
    empty.push_back(process_ms() - before);
    frames++;
  }
  tell("kiosk.station.cold_ms", part_of(cold, 0.5), "ms", fields);
  tell("kiosk.station.cold_p95_ms", part_of(cold, 0.95), "ms", fields);
  tell("kiosk.station.coherent_ms", part_of(coherent, 0.5), "ms", fields);
  tell("kiosk.station.empty_ms", part_of(empty, 0.5), "ms", fields);
  tell("kiosk.station.named", double(named) / tries, "1", fields);
  tell("kiosk.station.wrong", wrong, "1", fields);
  json with_frames = fields;
  with_frames["frames"] = frames;
  tell("kiosk.station.false", false_names, "1", with_frames);
  tell("kiosk.station.matches", part_of(matches, 0.5), "1", fields);
  tell("kiosk.station.often_matches", part_of(often, 0.5), "1", fields);
  tell("kiosk.station.most_matches", part_of(matches, 1), "1", fields);
  if (data.empty()) return;
  const Watched people = watch_people(station, data, quick ? 30 : 600);
  if (people.seconds <= 0) return;
  tell("kiosk.station.people_seconds", people.seconds, "s", fields);
  tell("kiosk.station.people_names", people.names, "1", fields);
  tell("kiosk.station.people_cores", people.ms / 1000 / people.seconds, "cores", fields);
}

// Counts the codes that are read, by their size in the picture.
void measure_codes(int tries) {
  cv::Mat code, large;
  cv::QRCodeEncoder::create()->encode("https://museum.example/coin/17", code);
  cv::resize(code, large, {}, 8, 8, cv::INTER_NEAREST);
  cv::copyMakeBorder(large, large, 32, 32, 32, 32, cv::BORDER_CONSTANT, cv::Scalar::all(255));
  cv::cvtColor(large, large, cv::COLOR_GRAY2BGR);
  for (const float size : {90.f, 130.f, 180.f}) {
    int read = 0;
    double ms = 0;
    for (int i = 0; i < tries; i++) {
      Held held = random_held(unsigned(9000 + i));
      held.size = size;
      const GrayFrame frame = show(large, held, unsigned(i), 0);
      const double before = process_ms();
      read += !read_codes(frame.width, frame.height, frame.pixels.data()).empty();
      ms += process_ms() - before;
    }
    const json fields{{"pixels", size}};
    tell("kiosk.station.codes", double(read) / tries, "1", fields);
    tell("kiosk.station.codes_ms", ms / tries, "ms", fields);
  }
}

// Boxes without texture in full rooms, and rooms without them; each picture is looked at alone.
void measure_boxes(int tries) {
  RecognitionTree tree;
  NodeData box;
  box.box = vec3(0.12f, 0.08f, 0.05f);
  tree.data = {box};
  int found = 0, false_names = 0;
  double ms = 0, off = 0;
  for (unsigned seed = 0; seed < unsigned(tries); seed++) {
    const vec3 middle(0.03f, -0.02f, 0.4f);
    for (const bool held : {true, false}) {
      cv::Mat picture = make_room(seed);
      if (held) put_box(picture, middle, random_axes(seed), box.box, seed);
      Sight sight;
      BoxSolver solver(tree, sight);
      ContextStore context;
      const GrayFrame frame = to_frame(picture, 0, 0.7, 4, seed);
      look_at(sight, frame, made_focal);
      const double before = process_ms();
      const bool sure = solver.match(0, 0, context).verdict == Verdict::sure;
      ms += process_ms() - before;
      if (held && sure) off += double(glm::distance(solver.pose()->position, middle));
      (held ? found : false_names) += sure;
    }
  }
  const json fields{{"seen", "three faces"}};
  tell("kiosk.station.boxes", double(found) / tries, "1", fields);
  tell("kiosk.station.boxes_false", false_names, "1", fields);
  tell("kiosk.station.boxes_off", 1000 * off / std::max(found, 1), "mm", fields);
  tell("kiosk.station.boxes_ms", ms / (2 * tries), "ms", fields);
}

// Pairs that are equal in front and differ at the back. A visitor shows the front first and does
// what hints say.
void measure_twins(bool by_edges, int pairs) {
  std::vector<std::array<cv::Mat, 4>> faces;  // fronts, then backs
  std::vector<LearnObject> objects;
  for (int i = 0; i < pairs; i++) {
    const cv::Mat front = make_face(unsigned(2000 + i)), back = make_face(unsigned(3000 + i));
    cv::Mat one = back.clone(), other = back.clone();
    if (by_edges) {
      draw_emblem(one, unsigned(2 * i), {160, 110});
      draw_emblem(other, unsigned(2 * i + 1), {160, 110});
    } else {
      cv::rectangle(one, {60, 120, 280, 60}, {40, 40, 200}, -1);
      cv::rectangle(other, {60, 120, 280, 60}, {60, 128, 40}, -1);
    }
    faces.push_back({front, front, one, other});
    for (int k = 0; k < 2; k++)
      objects.push_back(make_object(std::to_string(i) + (k ? "b" : "a"),
                                    {{front, "front"}, {k ? other : one, "back"}}));
  }
  Station station(learn_tree(std::move(objects), "made").tree);
  int named = 0, wrong = 0, hints = 0;
  double time = 0;
  for (int i = 0; i < pairs; i++)
    for (int k = 0; k < 2; k++) {
      station.forget();
      time += 100;
      Held held = random_held(unsigned(7000 + 2 * i + k));
      bool back = false;
      int asked = 0;
      std::string told_id;
      for (int steps = 0; asked <= 2 && told_id.empty() && steps < 3; steps++) {
        std::optional<Holding> told;
        for (int frame = 0; frame < 30 && told_id.empty(); frame++) {
          held.roll += 0.002f;
          time += 1 / 30.0;
          told =
              station.step(show(faces[size_t(i)][size_t(2 * back + k)], held, unsigned(i), time));
          if (told && !told->id.empty()) told_id = told->id;
        }
        if (!told || told->hint.empty() || !told_id.empty()) continue;
        asked++;
        const std::string& hint = told->hint.at("en");
        if (hint.starts_with("Turn")) back = !back;
        else if (hint.starts_with("A little closer")) held.size *= 1.4f;
        else held.tilt_x *= 0.3f, held.tilt_y *= 0.3f;
      }
      hints += asked;
      named += told_id == std::to_string(i) + (k ? "b" : "a");
      wrong += !told_id.empty() && told_id != std::to_string(i) + (k ? "b" : "a");
    }
  const json fields{{"told by", by_edges ? "structure" : "colour"}};
  tell("kiosk.station.twins", double(named) / (2 * pairs), "1", fields);
  tell("kiosk.station.twins_wrong", wrong, "1", fields);
  tell("kiosk.station.hints", double(hints) / (2 * pairs), "1", fields);
}

}  // namespace

int main(int argc, char** argv) {
  if (answer_version(argc, argv)) return 0;
  CLI::App app{"Measures a kiosk's station for wellspring bench."};
  std::string weights, data;
  bool quick = false;
  app.add_option("--weights", weights, "not needed");
  app.add_option("--data", data, "folder of real recordings");
  app.add_flag("--quick", quick, "fewer objects and shorter recordings");
  CLI11_PARSE(app, argc, argv);
  log::start("measure");
  cv::setNumThreads(1);
  try {
    for (const int count : quick ? std::vector{60} : std::vector{15, 60, 120})
      measure_objects(count, quick, count == 60 ? data : "");
    measure_codes(quick ? 20 : 100);
    measure_boxes(quick ? 20 : 100);
    for (const bool by_edges : {true, false}) measure_twins(by_edges, quick ? 4 : 12);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
