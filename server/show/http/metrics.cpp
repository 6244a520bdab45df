// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <unistd.h>

#include "show/http/answer.h"
#include "wire/prometheus.h"

namespace wellspring::show {

namespace {

// Which of its states something is in: 1 for that one, 0 for the others.
template <class State>
void states(std::string& out, const char* name, const char* help, std::initializer_list<State> all,
            State now) {
  begin_metric(out, name, help);
  for (State state : all) add_sample(out, name, {{"state", to_string(state)}}, state == now);
}

template <class Value>
void per_visitor(std::string& out, const ShowReport& report, const char* name, const char* help,
                 const Value& value) {
  if (report.visitors.empty()) return;
  const std::string whole = std::string("visitor_") + name;
  begin_metric(out, whole, help);
  for (const VisitorReport& one : report.visitors)
    add_sample(out, whole,
               {{"visitor", std::to_string(one.id)},
                {"role", one.kiosk ? "kiosk" : "visitor"},
                {"kiosk", one.name}},
               value(one));
}

void per_limit(std::string& out, const ShowReport& report) {
  if (report.visitors.empty()) return;
  begin_metric(out, "visitor_limit", "Why pictures are fewer, or less fine, than asked for");
  for (const VisitorReport& one : report.visitors)
    for (const char* name : limit_names)
      add_sample(out, "visitor_limit", {{"visitor", std::to_string(one.id)}, {"limit", name}},
                 name == limit_names[size_t(one.limit)]);
}

void per_kiosk(std::string& out, const ShowReport& report) {
  if (report.kiosks.empty()) return;
  begin_metric(out, "kiosk_stage", "How far the guest before a kiosk has come");
  for (const KioskReport& kiosk : report.kiosks)
    for (Stage stage : {Stage::sleep, Stage::awake, Stage::person, Stage::engaged, Stage::farewell})
      add_sample(out, "kiosk_stage", {{"kiosk", kiosk.name}, {"stage", to_string(stage)}},
                 stage == kiosk.stage);
  begin_metric(out, "kiosk_people", "People before a kiosk");
  for (const KioskReport& kiosk : report.kiosks)
    add_sample(out, "kiosk_people", {{"kiosk", kiosk.name}}, kiosk.people);
  begin_metric(out, "kiosk_storyteller", "The storyteller is with its guests");
  for (const KioskReport& kiosk : report.kiosks)
    add_sample(out, "kiosk_storyteller", {{"kiosk", kiosk.name}}, kiosk.storyteller);
}

void per_worker(std::string& out, const CrewReport& report) {
  if (!report.used) return;
  const CrewTotals& totals = report.totals;
  add_metric(out, "workers_connected", "There is a connection to NATS", report.connected);
  add_metric(out, "workers_requests_total", "Requests sent to workers", double(totals.requests));
  add_metric(out, "workers_samples_total", "Samples that workers traced in time",
             double(totals.samples));
  add_metric(out, "workers_lost_total", "Requests to workers without a good answer in time",
             double(totals.lost));
  add_metric(out, "workers_dropped_total", "Messages that the line to NATS did not take",
             double(totals.dropped));
  add_metric(out, "workers_late_total", "Samples that came too late", double(totals.late));
  add_metric(out, "workers_spoiled_total", "Messages that were none, or held impossible samples",
             double(totals.spoiled));
  add_metric(out, "workers_verified_total", "Samples of workers that were traced here, too",
             double(totals.verified));
  add_metric(out, "workers_differing_total", "Those that were not the same bits",
             double(totals.differing));
  add_metric(out, "workers_alike_total",
             "Samples that were traced here, too, of workers with other instructions",
             double(totals.alike));
  add_metric(out, "workers_alike_deviation",
             "Their mean light less that of ours, in standard errors", totals.alike_deviation());
  add_metric(out, "workers_alike_difference", "The same, as a share of their light",
             totals.alike_light > 0 ? totals.alike_difference / totals.alike_light : 0);
  begin_metric(out, "workers_refused_total", "Requests that workers refused");
  for (int i = 1; i < refusals; i++)
    add_sample(out, "workers_refused_total", {{"reason", to_word(Refusal(i))}},
               double(totals.refused[i]));
  const auto each = [&](const char* name, const char* help, auto value) {
    if (report.workers.empty()) return;
    begin_metric(out, name, help);
    for (const WorkerReport& one : report.workers)
      add_sample(out, name, {{"worker", one.name}}, double(value(one)));
  };
  each("worker_asked", "The worker is given requests",
       [](const WorkerReport& one) { return one.problem.empty(); });
  each("worker_samples_total", "Samples that came from it",
       [](const WorkerReport& one) { return one.samples; });
  each("worker_lost_total", "Requests to it without a good answer in time",
       [](const WorkerReport& one) { return one.lost; });
  each("worker_samples_per_second", "As it traces; 0: not known",
       [](const WorkerReport& one) { return one.samples_per_second; });
  each("worker_line_milliseconds", "The line there and back, without waiting and tracing",
       [](const WorkerReport& one) { return 1000 * one.line; });
  each("worker_requests_in_flight", "Requests sent to it and not answered",
       [](const WorkerReport& one) { return one.in_flight; });
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
  add_metric(out, "up_seconds", "Seconds since the show began", report.time);
  add_metric(out, "ticks_total", "Ticks of the show", double(report.ticks));
  add_metric(out, "tick_milliseconds", "Length of the last tick", totals.tick_ms);
  add_metric(out, "animate_milliseconds", "The storyteller's part of it", totals.animate_ms);
  add_metric(out, "samples_per_second", "Samples a second while tracing, all cores",
             report.samples_per_second);
  add_metric(out, "samples_total", "Samples traced", double(totals.samples));
  begin_metric(out, "denoiser", "1: pictures at rest are reconstructed by a network; 0: why not");
  add_sample(out, "denoiser", {{"problem", report.denoiser_problem}},
             report.denoiser_problem.empty());
  add_metric(out, "reconstructions_total", "Pictures at rest reconstructed by the network",
             double(totals.reconstructed));
  add_metric(out, "reconstruction_milliseconds", "What the last of them took, all cores",
             double(totals.reconstruction_ms));
  begin_metric(out, "display", "How pictures get their diffuse light");
  for (const char* name : {"points", "maps"})
    add_sample(out, "display", {{"method", name}}, std::string_view(name) == report.display);
  add_metric(out, "illumination_map_texels", "Of the illumination maps in use; 0: none are",
             double(report.map_texels));
  add_metric(out, "illumination_map_error",
             "Their estimated standard error over their mean light; 1: there are none",
             double(report.map_error));
  add_metric(out, "bake_working", "Maps are being baked on all cores at the moment",
             report.bake.works);
  add_metric(out, "bake_passes_total", "Passes over all texels so far", double(report.bake.passes));
  add_metric(out, "bake_error", "Estimated error of what is baked so far; 1: nothing is",
             double(report.bake.error));
  add_metric(out, "bad_samples_total", "Samples dropped for not being finite or positive",
             double(report.bad_samples));
  add_metric(out, "pictures_total", "Pictures sent", double(totals.pictures));
  add_metric(out, "pictures_drawn_total", "Pictures drawn from samples", double(totals.drawn));
  add_metric(out, "pictures_warped_total",
             "Pictures sent that are warped from earlier ones to where the visitor is",
             double(totals.warped));
  add_metric(out, "warps_given_up_total",
             "Pictures not made since earlier ones show too little of the view",
             double(totals.unwarpable));
  add_metric(out, "moving_drawn_total", "What moves in pictures at rest, drawn by itself",
             double(totals.posed));
  add_metric(out, "attention_analyses_total",
             "Analyses of where a visitor looks, none while nothing asks for samples",
             double(totals.attention_analyses));
  add_metric(out, "attention_milliseconds", "What the last of them took, one core",
             double(totals.attention_ms));
  add_metric(out, "lenses_drawn_total", "Pictures drawn of what visitors' glasses show",
             double(totals.lenses));
  add_metric(out, "surroundings_drawn_total",
             "Small wide pictures drawn of what a quick turn may show",
             double(totals.surroundings));
  add_metric(out, "drawings_given_up_total",
             "Pictures not drawn since their visitors were elsewhere by then",
             double(totals.given_up));
  add_metric(out, "picture_bytes_total", "Bytes of pictures made", double(totals.picture_bytes));
  add_metric(out, "messages_total", "Messages from browsers", double(totals.messages));
  add_metric(out, "refused_messages_total", "Messages refused", double(totals.refused_messages));
  add_metric(out, "orders_left_out_total",
             "Orders not carried out since newer ones of the same visitor came before their turn",
             double(totals.orders_left_out));
  add_metric(out, "visits_total", "Visits begun", double(totals.visits));
  add_metric(out, "visitors", "Visitors now", double(report.visitors.size()));
  add_metric(out, "house_open", "The house is open", report.open);
  add_metric(out, "house_quiet", "It is one of its quiet hours", report.quiet);
  add_metric(out, "announcements_total", "Announcements on all screens",
             double(totals.announcements));
  add_metric(out, "kiosk_cameras", "Kiosk cameras connected", double(report.connected_cameras));
  if (!report.cameras.empty())
    begin_metric(out, "kiosk_camera_seconds", "How long a kiosk's camera has been as it is");
  for (const CameraReport& camera : report.cameras)
    add_sample(out, "kiosk_camera_seconds",
               {{"kiosk", camera.kiosk},
                {"camera", std::to_string(camera.number)},
                {"name", camera.name},
                {"state", camera.state}},
               std::round(std::max(camera.since, 0.0)));
  per_kiosk(out, report);
  add_metric(out, "kiosk_observations_total", "Observations received", double(totals.observations));
  states(out, "audience", "What the kiosks' cameras see",
         {Presence::absent, Presence::motion, Presence::person}, report.audience);
  states(
      out, "storyteller_mood", "What the storyteller is about",
      {Mood::idle, Mood::noticing, Mood::greeting, Mood::attending, Mood::telling, Mood::farewell},
      report.mood);
  add_metric(out, "gestures_followed_total", "Gestures of guests that did something",
             double(totals.gestures));
  add_metric(out, "greetings_total", "Greetings said", double(totals.greetings));
  add_metric(out, "farewells_total", "Farewells said", double(totals.farewells));
  add_metric(out, "lamps_switched_total", "Lamps switched on or off",
             double(totals.lamps_switched));
  add_metric(out, "stories_total", "Stories begun", double(totals.stories));
  add_metric(out, "voice_running", "The voice program was running when it was last asked",
             report.voice_running);
  add_metric(out, "voice_restarts_total", "Starts of the voice program after the first",
             double(report.voice_restarts));
  add_metric(out, "voice_lines", "Spoken lines kept in memory", double(report.voice_lines));
  add_metric(out, "voice_lines_waiting", "Lines still to be spoken", double(report.voice_waiting));
  add_metric(out, "voice_failed_total", "Lines that could not be spoken",
             double(report.voice_failed));
  add_metric(out, "utterances_total", "Lines said with a voice", double(totals.utterances));
  add_metric(out, "sounds_total", "Sound packets sent", double(totals.sounds));
  add_metric(out, "sounds_given_up_total", "Utterances dropped for readers that were too slow",
             double(totals.sounds_given_up));
  add_metric(out, "drawing_bytes",
             "Memory for drawing and warping pictures, one after the other, whoever they are for",
             double(report.drawing_bytes));
  add_metric(out, "resident_bytes", "Memory of the server process", resident_bytes());
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
  per_visitor(out, report, "lens_milliseconds", "Drawing a picture of what the glass shows",
              [](auto& v) { return v.lens_ms; });
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
  per_worker(out, report.workers);
  per_limit(out, report);
  per_visitor(out, report, "cache_bytes", "Memory of the render cache",
              [](auto& v) { return v.cache_bytes; });
  per_visitor(out, report, "memory_bytes",
              "Memory of all that is kept for the visitor's pictures, the cache included",
              [](auto& v) { return v.memory_bytes; });
  per_visitor(out, report, "sounds_dropped_total", "Pieces of sound that were never sent",
              [](auto& v) { return v.sounds_dropped; });
  per_visitor(out, report, "messages_dropped_total", "Messages that came faster than they are read",
              [](auto& v) { return v.texts_dropped; });
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
  add_metric(out, "stills_waiting", "Finished pictures that are waited for",
             double(stills.waiting));
  add_metric(out, "stills_waiting_seconds", "Of this machine, until all of these are made",
             stills.waiting_seconds);
  add_metric(out, "stills_samples_per_second", "Samples a second of the last one, one thread",
             stills.samples_per_second);
  add_metric(out, "stills_made_total", "Finished pictures made", double(stills.made));
  add_metric(out, "stills_shared_total",
             "Questions answered by a finished picture that was there, or being made",
             double(stills.shared));
  add_metric(out, "stills_given_up_total", "Finished pictures that nobody waited for",
             double(stills.given_up));
  begin_metric(out, "stills_refused_total", "Finished pictures refused");
  add_sample(out, "stills_refused_total", {{"cause", "too_dear"}}, stills.too_dear);
  add_sample(out, "stills_refused_total", {{"cause", "too_many"}}, stills.too_many);
  return out;
}

std::string store_metrics(const StoreStats& store) {
  std::string out;
  if (store.sources == 0) return out;
  add_metric(out, "store_bytes", "Memory of pieces of very large pictures", double(store.bytes));
  add_metric(out, "store_budget_bytes", "What they may take", double(store.budget));
  add_metric(out, "store_pieces", "Pieces in memory", store.pieces);
  add_metric(out, "store_sources", "Pictures whose pieces are kept there", store.sources);
  add_metric(out, "store_waiting", "Pieces that visitors wait for", store.waiting);
  add_metric(out, "store_under_way", "Pieces that are being read", store.under_way);
  add_metric(out, "store_coarser_levels", "Levels left out because all that is seen does not fit",
             double(store.coarser));
  begin_metric(out, "store_looks_total", "Look-ups of pixels, by the detail that was there");
  add_sample(out, "store_looks_total", {{"detail", "wanted"}},
             double(store.looked - store.looked_coarse));
  add_sample(out, "store_looks_total", {{"detail", "too_coarse"}}, double(store.looked_coarse));
  add_metric(out, "store_fetch_seconds_total", "Time of reading, of all threads",
             store.fetch_seconds);
  begin_metric(out, "store_fetched_total", "Pieces read, by what came of it");
  add_sample(out, "store_fetched_total", {{"result", "piece"}}, double(store.fetched));
  add_sample(out, "store_fetched_total", {{"result", "absent"}}, double(store.absent));
  add_sample(out, "store_fetched_total", {{"result", "failed"}}, double(store.failed));
  add_metric(out, "store_dropped_total", "Pieces dropped to make room", double(store.dropped));
  return out;
}

std::string failure_metrics(const std::vector<FailedExhibit>& failed) {
  if (failed.empty()) return {};
  std::string out;
  begin_metric(out, "exhibit_failed", "An exhibit that cannot be shown, and its first problem");
  for (const FailedExhibit& one : failed)
    add_sample(out, "exhibit_failed",
               {{"exhibit", one.id}, {"problem", one.problems.empty() ? "" : one.problems.front()}},
               1);
  return out;
}

}  // namespace wellspring::show
