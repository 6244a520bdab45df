// SPDX-License-Identifier: Apache-2.0
// kiosk.gestures: how well gestures of persons are recognised whom no model has seen. Persons and
// movements are made up (kiosk/gesture/writer.h): no recordings of visitors exist yet. The rule of
// the paper (Elmezain et al. 2009, section 3.3), as it is printed, stands beside the kiosk's own.
#include <cstdio>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>

#include "base/clock.h"
#include "judge/score.h"
#include "kiosk/gesture/train.h"
#include "report.h"
#include "wire/json.h"

namespace wellspring::test {
namespace {

namespace fs = std::filesystem;
using Spotter = std::function<std::vector<SpottedGesture>(const HandPath&)>;

constexpr uint64_t first_writer = 5000;  // settings were chosen on others

std::vector<HandPath> training_set(bool digits_alone) {
  std::vector<HandPath> paths = write_set(WriterGroup::training, 21, 2, 1);
  if (digits_alone)
    std::erase_if(paths, [](const HandPath& path) { return path.label.size() > 1; });
  return paths;
}

// Begins where the difference over the newest `window` codes becomes positive, ends where it
// becomes negative, and tells the likeliest gesture of all codes in between; any state may be last.
std::vector<SpottedGesture> spot_literally(const GestureModels& models, const HandPath& path,
                                           int window) {
  std::vector<GestureModel> gestures = models.gestures;
  for (GestureModel& gesture : gestures) gesture.hmm.ends_in_last = false;
  std::vector<SpottedGesture> out;
  for (const auto& steps : code_motions(path)) {
    const std::vector<Code> codes = codes_of(steps);
    std::optional<size_t> begin;
    for (size_t end = size_t(window); end <= codes.size(); end++) {
      const std::span<const Code> newest(&codes[end - size_t(window)], size_t(window));
      double best = -INFINITY;
      for (const GestureModel& gesture : gestures)
        best = std::max(best, viterbi(gesture.hmm, newest));
      const bool gesture_now = best > viterbi(models.other, newest);
      if (gesture_now && !begin) begin = end - size_t(window);
      if (!begin || (gesture_now && end < codes.size())) continue;
      const std::span<const Code> all(&codes[*begin], end - *begin);
      const GestureModel* likeliest = nullptr;
      double most = -INFINITY;
      for (const GestureModel& gesture : gestures)
        if (double p = viterbi(gesture.hmm, all); p > most) most = p, likeliest = &gesture;
      if (likeliest)
        out.push_back({likeliest->label, steps[*begin].begin, steps[end - 1].end, most});
      begin.reset();
    }
  }
  return out;
}

struct Sequences {
  std::vector<WrittenPath> paths;
  double frames = 0;
};
// One to three gestures each, of the first `labels` labels.
Sequences make_sequences(size_t labels, int count) {
  Sequences made;
  for (int i = 0; i < count; i++) {
    Rng rng(mix64(50000 + uint64_t(i)));
    std::vector<std::string> asked;
    for (uint32_t k = 1 + rng.next() % 3; k > 0; k--)
      asked.push_back(gesture_labels()[rng.next() % labels]);
    const HandWriter writer = make_writer(WriterGroup::held_out, first_writer + uint64_t(i % 14));
    made.paths.push_back(write_gestures(writer, asked, 70000 + uint64_t(i)));
    made.frames += double(made.paths.back().path.places.size());
  }
  return made;
}

SpotCounts count_all(const Sequences& sequences, const Spotter& spot) {
  SpotCounts counts;
  for (const WrittenPath& written : sequences.paths)
    counts += count_spotted(written.gestures, spot(written.path));
  return counts;
}

void add_counts(BenchReport& report, const SpotCounts& counts, const nlohmann::json& fields) {
  report.add("kiosk.gesture.spotting", reliability(counts), "1", fields);
  report.add("kiosk.gesture.tests", counts.tests, "1", fields);
  report.add("kiosk.gesture.inserted", counts.inserted, "1", fields);
  report.add("kiosk.gesture.deleted", counts.deleted, "1", fields);
  report.add("kiosk.gesture.substituted", counts.substituted, "1", fields);
}

void report_isolated(BenchReport& report, const GestureModels& models, int writers,
                     const char* vocabulary) {
  for (double evidence : {1.0, 0.0}) {
    std::map<std::string, std::pair<int, int>> each;  // right, tests
    int right = 0, tests = 0;
    for (const HandPath& path : write_set(WriterGroup::held_out, writers, 2, first_writer)) {
      const bool known = std::any_of(models.gestures.begin(), models.gestures.end(),
                                     [&](const GestureModel& m) { return m.label == path.label; });
      if (!known) continue;
      const bool hit = recognise(models, path, evidence) == path.label;
      each[path.label].first += hit, each[path.label].second++;
      right += hit, tests++;
    }
    const char* method = evidence > 0 ? "kiosk" : "codes alone";
    report.add("kiosk.gesture.isolated", recognition_ratio(right, tests), "1",
               {{"vocabulary", vocabulary}, {"method", method}, {"isolated_tests", tests}});
    if (evidence > 0)
      for (const auto& [label, count] : each)
        report.add("kiosk.gesture.isolated_each", recognition_ratio(count.first, count.second), "1",
                   {{"vocabulary", vocabulary}, {"gesture", label}});
  }
}

// One gesture in each sequence, so that what is inserted belongs to it.
void report_each(BenchReport& report, const GestureModels& models, int sequences,
                 const char* vocabulary) {
  for (size_t g = 0; g < gesture_labels().size(); g++) {
    const std::string& label = gesture_labels()[g];
    if (std::none_of(models.gestures.begin(), models.gestures.end(),
                     [&](const GestureModel& m) { return m.label == label; }))
      continue;
    SpotCounts counts;
    for (int i = 0; i < sequences; i++) {
      const HandWriter writer = make_writer(WriterGroup::held_out, first_writer + uint64_t(i % 14));
      const WrittenPath written = write_gestures(writer, {label}, 20000 + 1000 * g + uint64_t(i));
      counts += count_spotted(written.gestures, spot_path(models, {}, written.path));
    }
    report.add("kiosk.gesture.spotting_each", reliability(counts), "1",
               {{"vocabulary", vocabulary}, {"gesture", label}});
  }
}

void report_other_motion(BenchReport& report, const GestureModels& models, int minutes,
                         const char* vocabulary) {
  size_t found = 0;
  for (int i = 0; i < minutes; i++)
    found += spot_path(models, {},
                       write_other(make_writer(WriterGroup::held_out, first_writer + uint64_t(i)),
                                   60, 300 + uint64_t(i)))
                 .size();
  report.add("kiosk.gesture.false_a_minute", double(found) / minutes, "1/min",
             {{"vocabulary", vocabulary}, {"method", "kiosk"}, {"minutes", minutes}});
}

// Holds what the kiosk program says of a video: seconds and gestures.
struct Watched {
  double seconds = 0;
  int gestures = 0;
};
Watched watch(const std::string& program, const fs::path& video) {
  const std::string command =
      "'" + program + "' --camera '" + video.string() + "' --print --no-pace 2>/dev/null";
  std::unique_ptr<FILE, int (*)(FILE*)> out(popen(command.c_str(), "r"), pclose);
  Watched watched;
  std::string line, before;
  char part[4096];
  while (out && std::fgets(part, sizeof part, out.get())) {
    line += part;
    if (line.back() != '\n') continue;
    const auto message = read_observation(line);
    line.clear();
    const auto* seen = std::get_if<Observation>(&message);
    if (!seen) continue;
    watched.seconds = seen->time;
    std::string now;
    for (const Person& person : seen->people) now += person.gesture;
    watched.gestures += !now.empty() && now != before;
    before = now;
  }
  return watched;
}

void report_sign_language(BenchReport& report, const BenchOptions& options) {
  const fs::path folder = fs::absolute(options.content).parent_path().parent_path() / "shared" /
                          "data" / "5_faces" / "intel_sample_videos" / "asl_gestures";
  if (!fs::is_directory(folder)) {
    std::printf("kiosk.gestures: %s is not here: no clips of sign language\n", folder.c_str());
    return;
  }
  Watched all;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".mkv") continue;
    const Watched one = watch(options.programs + "/wellspring_kiosk", entry.path());
    all.seconds += one.seconds;
    all.gestures += one.gestures;
  }
  if (all.seconds > 0)
    report.add("kiosk.gesture.false_signing_a_minute", all.gestures / all.seconds * 60, "1/min",
               {{"vocabulary", "all"}, {"method", "kiosk"}, {"minutes", all.seconds / 60}});
}

}  // namespace

void bench_kiosk_gestures(BenchReport& report, const BenchOptions& options) {
  const int sequences = options.quick ? 70 : 280, minutes = options.quick ? 10 : 60;
  for (const bool digits_alone : {true, false}) {
    const char* vocabulary = digits_alone ? "digits" : "all";
    const double began = seconds_now();
    const GestureModels models = train_gestures(training_set(digits_alone));
    report.add("kiosk.gesture.training_seconds", seconds_now() - began, "s",
               {{"vocabulary", vocabulary}});
    report_isolated(report, models, options.quick ? 9 : 36, vocabulary);
    const Sequences made = make_sequences(digits_alone ? 10 : 16, sequences);
    auto ours = [&](const SpotSettings& settings) {
      return count_all(made, [&](const HandPath& p) { return spot_path(models, settings, p); });
    };
    const double start = seconds_now();
    add_counts(report, ours({}), {{"vocabulary", vocabulary}, {"method", "kiosk"}});
    report.add("kiosk.gesture.us_a_frame", (seconds_now() - start) / made.frames * 1e6, "us",
               {{"vocabulary", vocabulary}, {"method", "kiosk"}});
    SpotSettings codes;
    codes.evidence = 0;
    add_counts(report, ours(codes), {{"vocabulary", vocabulary}, {"method", "codes alone"}});
    add_counts(report,
               count_all(made, [&](const HandPath& p) { return spot_literally(models, p, 5); }),
               {{"vocabulary", vocabulary}, {"method", "the paper's rule"}});
    for (int window = 1; window <= 8; window++) {
      SpotSettings settings;
      settings.window = window;
      report.add("kiosk.gesture.by_window", reliability(ours(settings)), "1",
                 {{"vocabulary", vocabulary}, {"window", window}, {"method", "kiosk"}});
      const SpotCounts literal =
          count_all(made, [&](const HandPath& p) { return spot_literally(models, p, window); });
      report.add("kiosk.gesture.by_window", reliability(literal), "1",
                 {{"vocabulary", vocabulary}, {"window", window}, {"method", "the paper's rule"}});
    }
    for (double margin : {0.0, 0.15, 0.3, 0.45, 0.6, 0.75}) {
      SpotSettings settings;
      settings.margin = margin;
      const SpotCounts counts = ours(settings);
      const nlohmann::json fields = {{"vocabulary", vocabulary}, {"margin", margin}};
      report.add("kiosk.gesture.by_margin", reliability(counts), "1", fields);
      report.add("kiosk.gesture.found", recognition_ratio(counts.correct, counts.tests), "1",
                 fields);
      report.add("kiosk.gesture.inserted_share", recognition_ratio(counts.inserted, counts.tests),
                 "1", fields);
    }
    report_each(report, models, options.quick ? 14 : 42, vocabulary);
    report_other_motion(report, models, minutes, vocabulary);
  }
  report_sign_language(report, options);
}

}  // namespace wellspring::test
