// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>
#include <unistd.h>

#include "show/http/answer.h"

namespace wellspring {

namespace {

void metric(std::string& out, const char* name, const char* type, const char* help, double value) {
  out += fmt::format("# HELP wellspring_{0} {1}\n# TYPE wellspring_{0} {2}\nwellspring_{0} {3}\n",
                     name, help, type, value);
}

// As the value of a label: quotes, or a backslash, would end it.
std::string label(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '"' || c == '\\' || c == '\n'; }, '\'');
  return text;
}

// Which of its states something is in: 1 for that one, 0 for the others.
template <class State>
void states(std::string& out, const char* name, const char* help, std::initializer_list<State> all,
            State now) {
  out += fmt::format("# HELP wellspring_{0} {1}\n# TYPE wellspring_{0} gauge\n", name, help);
  for (State state : all)
    out += fmt::format("wellspring_{}{{state=\"{}\"}} {}\n", name, to_string(state),
                       int(state == now));
}

template <class Value>
void per_visitor(std::string& out, const ShowReport& report, const char* name, const char* help,
                 const Value& value) {
  if (report.visitors.empty()) return;
  out += fmt::format("# HELP wellspring_visitor_{0} {1}\n# TYPE wellspring_visitor_{0} gauge\n",
                     name, help);
  for (const VisitorReport& one : report.visitors) {
    std::string kiosk = one.name.empty() ? "" : fmt::format(",kiosk=\"{}\"", label(one.name));
    out += fmt::format("wellspring_visitor_{}{{visitor=\"{}\",role=\"{}\"{}}} {}\n", name, one.id,
                       one.kiosk ? "kiosk" : "visitor", kiosk, value(one));
  }
}

void per_limit(std::string& out, const ShowReport& report) {
  if (report.visitors.empty()) return;
  out +=
      "# HELP wellspring_visitor_limit Why pictures are fewer, or less fine, than asked for\n"
      "# TYPE wellspring_visitor_limit gauge\n";
  for (const VisitorReport& one : report.visitors)
    for (const char* name : limit_names)
      out += fmt::format("wellspring_visitor_limit{{visitor=\"{}\",limit=\"{}\"}} {}\n", one.id,
                         name, int(name == limit_names[size_t(one.limit)]));
}

void per_kiosk(std::string& out, const ShowReport& report) {
  if (report.kiosks.empty()) return;
  out +=
      "# HELP wellspring_kiosk_stage How far the guest before a kiosk has come\n"
      "# TYPE wellspring_kiosk_stage gauge\n";
  for (const KioskReport& kiosk : report.kiosks)
    for (Stage stage : {Stage::sleep, Stage::awake, Stage::person, Stage::engaged, Stage::farewell})
      out += fmt::format("wellspring_kiosk_stage{{kiosk=\"{}\",stage=\"{}\"}} {}\n",
                         label(kiosk.name), to_string(stage), int(stage == kiosk.stage));
  auto gauge = [&](const char* name, const char* help, const auto& value) {
    out += fmt::format("# HELP wellspring_{0} {1}\n# TYPE wellspring_{0} gauge\n", name, help);
    for (const KioskReport& kiosk : report.kiosks)
      out +=
          fmt::format("wellspring_{}{{kiosk=\"{}\"}} {}\n", name, label(kiosk.name), value(kiosk));
  };
  gauge("kiosk_people", "People before a kiosk", [](auto& kiosk) { return kiosk.people; });
  gauge("kiosk_storyteller", "The storyteller is with its guests",
        [](auto& kiosk) { return int(kiosk.storyteller); });
}

double resident_bytes() {
  std::ifstream in("/proc/self/statm");
  double total = 0, resident = 0;
  in >> total >> resident;
  return resident * double(sysconf(_SC_PAGESIZE));
}

}  // namespace

std::string write_metrics(const ShowReport& report) {
  std::string out;
  const ShowTotals& totals = report.totals;
  metric(out, "up_seconds", "counter", "Seconds since the show began", report.time);
  metric(out, "ticks_total", "counter", "Ticks of the show", double(report.ticks));
  metric(out, "tick_milliseconds", "gauge", "Length of the last tick", totals.tick_ms);
  metric(out, "animate_milliseconds", "gauge", "The storyteller's part of it", totals.animate_ms);
  metric(out, "samples_per_second", "gauge", "Samples a second while tracing, all cores",
         report.samples_per_second);
  metric(out, "samples_total", "counter", "Samples traced", double(totals.samples));
  const std::string problem = label(report.denoiser_problem);
  out += fmt::format(
      "# HELP wellspring_denoiser 1: pictures at rest are reconstructed by a network; 0: why not\n"
      "# TYPE wellspring_denoiser gauge\nwellspring_denoiser{{problem=\"{}\"}} {}\n",
      problem, problem.empty() ? 1 : 0);
  metric(out, "reconstructions_total", "counter", "Pictures at rest reconstructed by the network",
         double(totals.reconstructed));
  metric(out, "reconstruction_milliseconds", "gauge", "What the last of them took, all cores",
         double(totals.reconstruction_ms));
  out +=
      "# HELP wellspring_display How pictures get their diffuse light\n"
      "# TYPE wellspring_display gauge\n";
  for (const char* name : {"points", "maps", "corrected"})
    out += fmt::format("wellspring_display{{method=\"{}\"}} {}\n", name,
                       int(std::string_view(name) == report.display));
  metric(out, "illumination_map_texels", "gauge", "Of the illumination maps in use; 0: none are",
         double(report.map_texels));
  metric(out, "illumination_map_error", "gauge",
         "Their estimated standard error over their mean light; 1: there are none",
         double(report.map_error));
  metric(out, "bake_working", "gauge", "Maps are being baked at the moment", report.bake.works);
  metric(out, "bake_passes_total", "counter", "Passes over all texels so far",
         double(report.bake.passes));
  metric(out, "bake_error", "gauge", "Estimated error of what is baked so far; 1: nothing is",
         double(report.bake.error));
  metric(out, "bad_samples_total", "counter", "Samples dropped for not being finite or positive",
         double(report.bad_samples));
  metric(out, "pictures_total", "counter", "Pictures sent", double(totals.pictures));
  metric(out, "pictures_drawn_total", "counter", "Pictures drawn from samples",
         double(totals.drawn));
  metric(out, "pictures_warped_total", "counter",
         "Pictures sent that are warped from earlier ones to where the visitor is",
         double(totals.warped));
  metric(out, "warps_given_up_total", "counter",
         "Pictures not made since earlier ones show too little of the view",
         double(totals.unwarpable));
  metric(out, "moving_drawn_total", "counter", "What moves in pictures at rest, drawn by itself",
         double(totals.posed));
  metric(out, "attention_analyses_total", "counter",
         "Analyses of where a visitor looks, none while nothing asks for samples",
         double(totals.attention_analyses));
  metric(out, "attention_milliseconds", "gauge", "What the last of them took, one core",
         double(totals.attention_ms));
  metric(out, "corrected_pictures_total", "counter",
         "Pictures with samples of what shines by themselves, none where nothing does",
         double(totals.corrected));
  metric(out, "corrective_samples_total", "counter", "Asked for by these",
         double(totals.corrective_samples));
  metric(out, "surroundings_drawn_total", "counter",
         "Small wide pictures drawn of what a quick turn may show", double(totals.surroundings));
  metric(out, "drawings_given_up_total", "counter",
         "Pictures not drawn since their visitors were elsewhere by then", double(totals.given_up));
  metric(out, "picture_bytes_total", "counter", "Bytes of pictures made",
         double(totals.picture_bytes));
  metric(out, "messages_total", "counter", "Messages from browsers", double(totals.messages));
  metric(out, "refused_messages_total", "counter", "Messages refused",
         double(totals.refused_messages));
  metric(out, "orders_left_out_total", "counter",
         "Orders not carried out since newer ones of the same visitor came before their turn",
         double(totals.orders_left_out));
  metric(out, "visits_total", "counter", "Visits begun", double(totals.visits));
  metric(out, "visitors", "gauge", "Visitors now", double(report.visitors.size()));
  metric(out, "house_open", "gauge", "The house is open", report.open);
  metric(out, "house_quiet", "gauge", "It is one of its quiet hours", report.quiet);
  metric(out, "announcements_total", "counter", "Announcements on all screens",
         double(totals.announcements));
  metric(out, "kiosk_cameras", "gauge", "Kiosk cameras connected",
         double(report.connected_cameras));
  if (!report.cameras.empty())
    out +=
        "# HELP wellspring_kiosk_camera_seconds How long a kiosk's camera has been as it is\n"
        "# TYPE wellspring_kiosk_camera_seconds gauge\n";
  for (const CameraReport& camera : report.cameras) {
    std::string name = camera.name.empty() ? "" : fmt::format(",name=\"{}\"", label(camera.name));
    out += fmt::format(
        "wellspring_kiosk_camera_seconds{{kiosk=\"{}\",camera=\"{}\"{},state=\"{}\"}} {:.0f}\n",
        label(camera.kiosk), camera.number, name, camera.state, std::max(camera.since, 0.0));
  }
  per_kiosk(out, report);
  metric(out, "kiosk_observations_total", "counter", "Observations received",
         double(totals.observations));
  states(out, "audience", "What the kiosks' cameras see",
         {Presence::absent, Presence::motion, Presence::person}, report.audience);
  states(
      out, "storyteller_mood", "What the storyteller is about",
      {Mood::idle, Mood::noticing, Mood::greeting, Mood::attending, Mood::telling, Mood::farewell},
      report.mood);
  metric(out, "gestures_followed_total", "counter", "Gestures of guests that did something",
         double(totals.gestures));
  metric(out, "greetings_total", "counter", "Greetings said", double(totals.greetings));
  metric(out, "farewells_total", "counter", "Farewells said", double(totals.farewells));
  metric(out, "lamps_switched_total", "counter", "Lamps switched on or off",
         double(totals.lamps_switched));
  metric(out, "stories_total", "counter", "Stories begun", double(totals.stories));
  metric(out, "voice_running", "gauge", "The voice program was running when it was last asked",
         report.voice_running);
  metric(out, "voice_restarts_total", "counter", "Starts of the voice program after the first",
         double(report.voice_restarts));
  metric(out, "voice_lines", "gauge", "Spoken lines kept in memory", double(report.voice_lines));
  metric(out, "voice_lines_waiting", "gauge", "Lines still to be spoken",
         double(report.voice_waiting));
  metric(out, "voice_failed_total", "counter", "Lines that could not be spoken",
         double(report.voice_failed));
  metric(out, "utterances_total", "counter", "Lines said with a voice", double(totals.utterances));
  metric(out, "sounds_total", "counter", "Sound packets sent", double(totals.sounds));
  metric(out, "sounds_given_up_total", "counter",
         "Utterances dropped for readers that were too slow", double(totals.sounds_given_up));
  metric(out, "drawing_bytes", "gauge",
         "Memory for drawing and warping pictures, one after the other, whoever they are for",
         double(report.drawing_bytes));
  metric(out, "resident_bytes", "gauge", "Memory of the server process", resident_bytes());
  per_visitor(out, report, "pictures_per_second", "Pictures a second",
              [](auto& v) { return v.fps; });
  per_visitor(out, report, "drawn_pictures_per_second",
              "Pictures drawn a second; the others are warped, or have what moves drawn anew",
              [](auto& v) { return v.drawn_fps; });
  per_visitor(out, report, "warp_milliseconds", "Warping a picture",
              [](auto& v) { return v.warp_ms; });
  per_visitor(out, report, "moving_milliseconds", "Drawing what moves in a picture at rest",
              [](auto& v) { return v.moving_ms; });
  per_visitor(out, report, "drawn_after_milliseconds",
              "From deciding what to draw until it can be shown",
              [](auto& v) { return v.whole_ms; });
  per_visitor(out, report, "round_trip_milliseconds", "Picture sent to acknowledged",
              [](auto& v) { return v.round_trip_ms; });
  per_visitor(out, report, "display_milliseconds", "Reprojection and light",
              [](auto& v) { return v.display_ms; });
  per_visitor(out, report, "trace_milliseconds", "Tracing samples",
              [](auto& v) { return v.trace_ms; });
  per_visitor(out, report, "tonemap_milliseconds", "Tone mapping",
              [](auto& v) { return v.tonemap_ms; });
  per_visitor(out, report, "encode_milliseconds", "JPEG encoding",
              [](auto& v) { return v.encode_ms; });
  per_visitor(out, report, "decode_milliseconds", "Decoding a picture, as the browser measures it",
              [](auto& v) { return v.decode_ms; });
  per_visitor(out, report, "samples_per_picture", "Samples traced for a picture",
              [](auto& v) { return v.budget; });
  per_visitor(out, report, "drawing_milliseconds",
              "Drawing shapes and reflectances of a picture, and shading them",
              [](auto& v) { return v.drawing_ms; });
  per_visitor(out, report, "converged_ratio", "Share of converged pixels",
              [](auto& v) { return v.converged; });
  per_visitor(out, report, "empty_ratio", "Share of pixels without a point",
              [](auto& v) { return v.empty; });
  per_visitor(out, report, "fresh_ratio", "Share of pixels sampled in this picture",
              [](auto& v) { return v.fresh; });
  per_visitor(out, report, "mean_age_pictures", "Age of the visible points",
              [](auto& v) { return v.mean_age; });
  per_visitor(out, report, "jpeg_quality", "Quality of moving pictures",
              [](auto& v) { return v.quality; });
  per_visitor(out, report, "picture_scale", "Width of moving pictures over what was asked for",
              [](auto& v) { return v.eighths / 8.0; });
  per_visitor(out, report, "line_round_trip_milliseconds",
              "The line there and back with nothing in the way; 0: not known",
              [](auto& v) { return v.line_ms; });
  per_visitor(out, report, "line_bytes_per_second", "What the line carries; 0: not known",
              [](auto& v) { return v.line_rate; });
  per_limit(out, report);
  per_visitor(out, report, "cache_bytes", "Memory of the render cache",
              [](auto& v) { return v.cache_bytes; });
  per_visitor(out, report, "memory_bytes",
              "Memory of all that is kept for the visitor's pictures, the cache included",
              [](auto& v) { return v.memory_bytes; });
  per_visitor(out, report, "pictures_dropped_total", "Pictures replaced before they were sent",
              [](auto& v) { return v.dropped; });
  return out;
}

std::string join_metrics(const std::vector<std::pair<std::string, std::string>>& texts) {
  std::vector<std::string> names;               // in the order in which they come
  std::map<std::string, std::string> families;  // name -> its comments, then its samples
  for (const auto& [id, text] : texts) {
    std::istringstream lines(text);
    std::string family;
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with("# ")) {
        std::istringstream words(line);
        std::string hash, kind;
        words >> hash >> kind >> family;
        auto [place, is_new] = families.try_emplace(family);
        if (is_new) names.push_back(family);
        if (place->second.find("\n# " + kind) == std::string::npos &&
            !place->second.starts_with("# " + kind))
          place->second += line + "\n";
      } else {
        const size_t name_end = line.find_first_of("{ ");
        const bool labelled = line[name_end] == '{';
        families[family] +=
            fmt::format("{}{{exhibit=\"{}\"{}\n", line.substr(0, name_end), id,
                        labelled ? "," + line.substr(name_end + 1) : "}" + line.substr(name_end));
      }
    }
  }
  std::string out;
  for (const std::string& name : names) out += families[name];
  return out;
}

std::string still_metrics(const StillStatus& stills) {
  std::string out;
  metric(out, "stills_waiting", "gauge", "Finished pictures that are waited for",
         double(stills.waiting));
  metric(out, "stills_waiting_seconds", "gauge", "Of this machine, until all of these are made",
         stills.waiting_seconds);
  metric(out, "stills_samples_per_second", "gauge", "Samples a second of the last one, one thread",
         stills.samples_per_second);
  metric(out, "stills_made_total", "counter", "Finished pictures made", double(stills.made));
  metric(out, "stills_shared_total", "counter",
         "Questions answered by a finished picture that was there, or being made",
         double(stills.shared));
  metric(out, "stills_given_up_total", "counter", "Finished pictures that nobody waited for",
         double(stills.given_up));
  out +=
      "# HELP wellspring_stills_refused_total Finished pictures refused\n"
      "# TYPE wellspring_stills_refused_total counter\n";
  out += fmt::format("wellspring_stills_refused_total{{cause=\"too_dear\"}} {}\n", stills.too_dear);
  out += fmt::format("wellspring_stills_refused_total{{cause=\"too_many\"}} {}\n", stills.too_many);
  return out;
}

std::string failure_metrics(const std::vector<FailedExhibit>& failed) {
  if (failed.empty()) return {};
  std::string out =
      "# HELP wellspring_exhibit_failed An exhibit that cannot be shown, and its first problem\n"
      "# TYPE wellspring_exhibit_failed gauge\n";
  for (const FailedExhibit& one : failed)
    out += fmt::format("wellspring_exhibit_failed{{exhibit=\"{}\",problem=\"{}\"}} 1\n",
                       label(one.id), label(one.problems.empty() ? "" : one.problems.front()));
  return out;
}

}  // namespace wellspring
