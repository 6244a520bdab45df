// SPDX-License-Identifier: Apache-2.0
#include "show/status/judge.h"

#include <algorithm>
#include <fmt/core.h>
#include <optional>
#include <set>

#include "show/answer/cameras.h"

namespace wellspring::show {

namespace {

constexpr double told_after_count = 600;  // seconds
// Seconds after which it is taken to be gone for good.
constexpr double kiosk_missed = lost_camera_listed;
constexpr float late_interval = 400;  // milliseconds between pictures drawn of who walks
constexpr float least_rate = 12;      // pictures a second shown to who walks
constexpr float slow_line = 500;      // milliseconds, there and back
constexpr float slow_decoding = 30;   // milliseconds

struct Patience {
  double before = 0, after = 0;  // seconds until it is told, and that it is told longer
};

std::string list_words(const std::vector<std::string>& words) {
  std::string list;
  for (const std::string& word : words) list += (list.empty() ? "" : ", ") + word;
  return list;
}

class Judge {
 public:
  Judge(const ShowReport& report, JudgeMemory& memory) : now_(report.time), memory_(memory) {
    if (memory.began < 0) memory.began = now_;
  }

  // It is so in this report. `since`: where the report says it; else from the first such report.
  void tell(Finding finding, Patience patience, double since = -1) {
    auto [found, is_new] = memory_.marks.try_emplace(finding.about);
    JudgeMemory::Mark& mark = found->second;
    if (is_new) mark.since = since >= 0 ? since : now_;
    mark.last = now_;
    seen_.insert(finding.about);
    keep(std::move(finding), mark, patience);
  }
  // As it may be so still, though this report does not say it.
  void linger(Finding finding, Patience patience) {
    auto found = memory_.marks.find(finding.about);
    if (found == memory_.marks.end() || now_ - found->second.last > patience.after) return;
    seen_.insert(finding.about);
    keep(std::move(finding), found->second, patience);
  }
  void judge(bool so, Finding finding, Patience patience) {
    if (so) tell(std::move(finding), patience);
    else linger(std::move(finding), patience);
  }
  // Something that only grows: how much it has since it was last well, or 0.
  uint64_t growth(const std::string& about, uint64_t value) {
    auto [last, is_first] = memory_.counted.try_emplace(about, 0);
    const uint64_t before = std::min(std::exchange(last->second, value), value);
    auto mark = memory_.marks.find(about);
    if (value > before) {
      if (mark == memory_.marks.end())
        mark = memory_.marks.insert({about, {now_, now_, before}}).first;
      mark->second.last = now_;
    }
    if (mark == memory_.marks.end() || now_ - mark->second.last > told_after_count) return 0;
    mark->second.before = std::min(mark->second.before, before);
    seen_.insert(about);
    return value - mark->second.before;
  }
  void tell_counted(Finding finding) {
    const JudgeMemory::Mark& mark = memory_.marks.at(finding.about);
    keep(std::move(finding), mark, {});
  }

  std::vector<Finding> end() {
    std::erase_if(memory_.marks, [&](const auto& mark) { return !seen_.contains(mark.first); });
    std::stable_sort(findings_.begin(), findings_.end(), [](const Finding& a, const Finding& b) {
      return a.grave != b.grave ? a.grave : a.since < b.since;
    });
    return std::move(findings_);
  }

 private:
  void keep(Finding finding, const JudgeMemory::Mark& mark, Patience patience) {
    if (mark.last - mark.since < patience.before) return;
    finding.since = mark.since;
    findings_.push_back(std::move(finding));
  }
  double now_;
  JudgeMemory& memory_;
  std::set<std::string> seen_;
  std::vector<Finding> findings_;
};

std::string at_kiosk(const std::string& name) {
  return name.empty() ? "at the kiosk" : "at kiosk '" + name + "'";
}

struct CameraWords {
  const char *state, *before, *after, *remedy;  // before + "camera 'x' at kiosk 'y'" + after
};
constexpr CameraWords camera_words[] = {
    {"dark", "The ", " sees only black", "Uncover its lens, or switch the light on."},
    {"frozen", "The picture of the ", " stands still", "Unplug the camera and plug it in again."},
    {"missing", "The ", " gives no picture",
     "Plug it in again, and close other programs that use it."},
    {"slow", "The ", " gives fewer than 8 pictures a second",
     "Use another USB port, or give it more light."},
    {"silent", "The program of the ", " says nothing",
     "See whether its computer is on and the program 'wellspring kiosk' runs."},
    {"disconnected", "The ", " is gone", "Check its cable and the program 'wellspring kiosk'."}};

// Part of an eye whose network's weights, which are installed apart from the program, are missing.
struct PartWords {
  std::optional<bool> EyeParts::*part;
  const char *before, *after;  // before + "camera 'x' at kiosk 'y'" + after
};
constexpr PartWords part_words[] = {
    {&EyeParts::faces, "How heads are turned is told badly by the ", ""},
    {&EyeParts::mesh, "Eyes and distances are told badly by the ", ""},
    {&EyeParts::expression, "No expressions are told by the ", ", though they are asked for"},
    {&EyeParts::bodies, "Nobody far away is seen by the ", ""},
    {&EyeParts::hands, "Hands are told badly by the ", ""}};

void judge_parts(Judge& judge, const CameraReport& camera, const std::string& name) {
  if (camera.state == "disconnected") return;
  const std::string at = name + at_kiosk(camera.kiosk);
  for (size_t k = 0; k < std::size(part_words); ++k) {
    const PartWords& words = part_words[k];
    if ((camera.parts.*words.part).value_or(true)) continue;
    judge.tell({.about = fmt::format("eye {}/{}/{}", camera.kiosk, camera.number, k),
                .what = words.before + at + words.after,
                .why = "the weights of a network are not installed there",
                .remedy = "Start its program once by './wellspring kiosk' with a network: it "
                          "installs the weights. The kiosk's log names the folder."},
               {.before = 2});
    if (k == 0) return;  // the others say no more
  }
}

void judge_camera(Judge& judge, const CameraReport& camera, double now) {
  const std::string name = camera.name.empty() || camera.name == camera.kiosk
                               ? "camera "
                               : "camera '" + camera.name + "' ";
  judge_parts(judge, camera, name);
  for (const CameraWords& words : camera_words) {
    if (camera.state != words.state) continue;
    judge.tell({.about = fmt::format("camera {}/{}", camera.kiosk, camera.number),
                .grave = true,
                .what = words.before + name + at_kiosk(camera.kiosk) + words.after,
                .why = {},
                .remedy = words.remedy},
               {.before = 2}, now - camera.since);
  }
}

// Judges the cameras. If a kiosk has none, that is said once and not for each.
void judge_cameras(Judge& judge, const ShowReport& report, JudgeMemory& memory) {
  std::map<std::string, double> lost;  // kiosks, and when their last camera went
  for (const CameraReport& camera : report.cameras) {
    const bool gone = camera.state == "disconnected";
    const bool others = std::ranges::any_of(report.kiosks, [&](const KioskReport& kiosk) {
      return kiosk.name == camera.kiosk && kiosk.cameras > 0;
    });
    if (!gone) memory.had_camera[camera.kiosk] = report.time;
    if (gone && !others)
      lost[camera.kiosk] = std::max(lost[camera.kiosk], report.time - camera.since);
    else judge_camera(judge, camera, report.time);
  }
  for (const KioskReport& kiosk : report.kiosks)
    if (kiosk.cameras > 0) memory.had_camera[kiosk.name] = report.time;
  for (const auto& [kiosk, since] : lost) memory.had_camera.try_emplace(kiosk, since);
  std::erase_if(memory.had_camera,
                [&](const auto& had) { return report.time - had.second > kiosk_missed; });
  for (const auto& [kiosk, last] : memory.had_camera) {
    if (last == report.time) continue;
    auto known = lost.find(kiosk);
    judge.tell({.about = "no camera " + kiosk,
                .grave = true,
                .what = "No camera " + at_kiosk(kiosk),
                .why = {},
                .remedy = "Check its cable and the program 'wellspring kiosk'."},
               {.before = 2}, known != lost.end() ? known->second : last);
  }
}

void judge_screens(Judge& judge, const ShowReport& report, JudgeMemory& memory) {
  for (const KioskReport& kiosk : report.kiosks)
    if (kiosk.screens > 0) memory.had_screen[kiosk.name] = report.time;
  std::erase_if(memory.had_screen,
                [&](const auto& had) { return report.time - had.second > kiosk_missed; });
  for (const auto& [kiosk, last] : memory.had_screen)
    if (last != report.time)
      judge.tell(
          {.about = "no screen " + kiosk,
           .grave = true,
           .what = "No screen " + at_kiosk(kiosk),
           .why = {},
           .remedy = "See whether its computer is on and its browser shows the page /kiosk."},
          {.before = 15}, last);
}

std::string many(uint64_t count, const char* one, const char* more) {
  return fmt::format("{} {}", count, count == 1 ? one : more);
}

std::string line_words(const VisitorReport& visitor) {
  if (visitor.limit != Limit::network || visitor.line_rate <= 0)
    return fmt::format("a picture and its answer take {:.0f} ms", visitor.round_trip_ms);
  return fmt::format("it carries {:.1f} Mbit/s, there and back takes {:.0f} ms",
                     8e-6 * double(visitor.line_rate), visitor.line_ms);
}

// A line that is slow, or a browser: each at its visitor's.
void judge_delivery(Judge& judge, const VisitorReport& visitor) {
  const std::string whose = visitor.kiosk ? "the screen " + at_kiosk(visitor.name)
                                          : fmt::format("visitor {}", visitor.id);
  const bool small = visitor.eighths < 8;  // resolution falls last
  judge.judge(visitor.round_trip_ms > slow_line || (small && visitor.limit == Limit::network),
              {.about = fmt::format("slow line {}", visitor.id),
               .grave = visitor.kiosk,
               .what = "The line to " + whose + " is slow",
               .why = line_words(visitor),
               .remedy = "Check the network there."},
              {.before = 5, .after = 10});
  judge.judge(visitor.limit == Limit::browser && visitor.decode_ms > slow_decoding,
              {.about = fmt::format("slow browser {}", visitor.id),
               .grave = visitor.kiosk,
               .what = "The browser of " + whose + " is slow",
               .why = fmt::format("decoding a picture takes {:.0f} ms", visitor.decode_ms),
               .remedy = "Close other programs and tabs there, or choose smaller pictures in its "
                         "menu."},
              {.before = 5, .after = 10});
  judge.judge(visitor.limit == Limit::server,
              {.about = fmt::format("slow encoder {}", visitor.id),
               .what = "Pictures for " + whose + " are made slowly",
               .why = fmt::format("encoding one takes {:.0f} ms", visitor.encode_ms),
               .remedy = "Close other programs on the server, or allow fewer visitors "
                         "(--max-visitors)."},
              {.before = 5, .after = 10});
}

void judge_pictures(Judge& judge, const ShowReport& report) {
  const bool late = std::ranges::any_of(report.visitors, [](const VisitorReport& visitor) {
    const bool line = visitor.round_trip_ms > 0.5f * slow_line;  // its own fault
    return visitor.walks && (visitor.interval_ms > late_interval ||
                             (!line && visitor.fps > 0 && visitor.fps < least_rate));
  });
  const size_t visitors = std::max(report.visitors.size(), report.all_visitors);
  judge.judge(late,
              {.about = "late pictures",
               .grave = true,
               .what = "Pictures are late",
               .why = fmt::format(
                   "{} not enough for {}",
                   report.cores == 1 ? "1 core is" : fmt::format("{} cores are", report.cores),
                   many(visitors, "visitor", "visitors")),
               .remedy = "Close other programs on the server, or allow fewer visitors "
                         "(--max-visitors)."},
              {.before = 5, .after = 15});
  for (const VisitorReport& visitor : report.visitors) judge_delivery(judge, visitor);
  if (report.waiting > 0)
    judge.tell({.about = "waiting",
                .what = many(report.waiting, "visitor waits", "visitors wait") + " to be let in",
                .why = many(visitors, "visitor is", "visitors are") +
                       " shown as many pictures as the machine makes",
                .remedy = "Close other programs on the server. More cores serve more visitors."},
               {.before = 5, .after = 5});
  if (uint64_t turned = judge.growth("full", report.turned_away))
    judge.tell_counted({.about = "full",
                        .grave = true,
                        .what = many(turned, "visitor was", "visitors were") + " turned away",
                        .why = "as many waited as --max-waiting allows",
                        .remedy = "More cores serve more visitors."});
  if (!report.denoiser_problem.empty())
    judge.tell({.about = "denoiser",
                .what = "Pictures at rest take longer to become fine",
                .why = report.denoiser_problem,
                .remedy = "Start the server once by './wellspring run' with a network: it installs "
                          "the weights."},
               {});
}

std::string times(uint64_t count) {
  return count == 1 ? std::string("once") : fmt::format("{} times", count);
}

void judge_doors(Judge& judge, const DoorCounts& doors) {
  if (uint64_t refused = judge.growth("accept", doors.accept_errors))
    judge.tell_counted({.about = "accept",
                        .grave = true,
                        .what = "Newcomers could not be let in " + times(refused),
                        .why = "the system gave no connection",
                        .remedy = "The server's log says why. For too many open files raise their "
                                  "limit (LimitNOFILE= of the unit, ulimit -n)."});
  if (uint64_t closed = judge.growth("floods", doors.floods_closed))
    judge.tell_counted({.about = "floods",
                        .what = many(closed, "connection was", "connections were") +
                                " closed for sending too much",
                        .why = "no page of this museum sends so much",
                        .remedy = "If that goes on, the server's log has the address: bar it at "
                                  "the firewall or the proxy."});
}

void judge_voice(Judge& judge, const ShowReport& report) {
  if (uint64_t failed = judge.growth("voice failed", report.voice_failed))
    judge.tell_counted({.about = "voice failed",
                        .grave = true,
                        .what = "The voice has failed " + times(failed),
                        .why = {},
                        .remedy = "The server's log names the texts; visitors read subtitles "
                                  "meanwhile. Is espeak-ng-data installed?"});
  if (uint64_t restarts = judge.growth("voice restarts", report.voice_restarts))
    judge.tell_counted({.about = "voice restarts",
                        .what = "The voice's program has ended " + times(restarts),
                        .why = "it was started again",
                        .remedy = "If that goes on, read the server's log."});
}

void judge_workers(Judge& judge, const CrewReport& report) {
  judge.judge(report.used && !report.connected,
              {.about = "nats",
               .what = "No samples come from workers",
               .why = "no NATS server answers at the address of --workers",
               .remedy = "See whether it runs and may be reached. This server goes on alone."},
              {.before = 5, .after = 5});
  for (const WorkerReport& one : report.workers)
    if (!one.problem.empty())
      judge.tell({.about = "worker " + one.name,
                  .what = "A worker is not asked",
                  .why = one.problem,
                  .remedy = "docs/workers.md says what each reason means."},
                 {.before = 5});
}

}  // namespace

std::vector<Finding> judge(const ShowReport& report, JudgeMemory& memory) {
  Judge judge(report, memory);
  judge_cameras(judge, report, memory);
  judge_screens(judge, report, memory);
  judge_pictures(judge, report);
  judge_voice(judge, report);
  judge_workers(judge, report.workers);
  judge_doors(judge, report.doors);
  if (!report.sums_problem.empty())
    judge.tell({.about = "sums",
                .what = "The daily sums cannot be written",
                .why = report.sums_problem,
                .remedy = "Is the disk full, and may the server write there? Nothing is lost while "
                          "it runs."},
               {});
  if (!report.full_disks.empty())
    judge.tell(
        {.about = "disk",
         .grave = true,
         .what = "The disk is full",
         .why = "nothing more can be written to " + list_words(report.full_disks),
         .remedy = "Make room. Visits go on; sums wait while the server runs, and light that "
                   "is baked is not kept."},
        {});
  if (!report.damaged_files.empty())
    judge.tell({.about = "cache",
                .what = "Files of the cache were damaged",
                .why = list_words(report.damaged_files),
                .remedy = "What they kept is computed anew. If it happens again, have the disk "
                          "looked at. The next start forgets this."},
               {});
  if (!report.light_problem.empty())
    judge.tell({.about = "light",
                .what = "The exhibit's own light is not of the exhibit as it is",
                .why = report.light_problem,
                .remedy = "Until then the server finds better light by itself while nobody needs "
                          "the cores."},
               {});
  if (report.exhibit_problems > 0)
    judge.tell(
        {.about = "exhibit",
         .what = "The exhibit's files have " + many(report.exhibit_problems, "mistake", "mistakes"),
         .why = "visitors see it as it was before",
         .remedy = "Their pages name file and place."},
        {});
  return judge.end();
}

}  // namespace wellspring::show
