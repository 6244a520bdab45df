// SPDX-License-Identifier: Apache-2.0
#include "museum/museum.h"

#include <algorithm>
#include <atomic>
#include <ctime>
#include <filesystem>
#include <list>
#include <thread>

#include "base/clock.h"
#include "base/log.h"
#include "base/near_name.h"
#include "base/return_memory.h"
#include "ledger/ledger.h"
#include "museum/reception.h"
#include "show/answer/come_back.h"
#include "show/exhibit/check_scene.h"
#include "show/exhibit/exhibit_load.h"
#include "show/house/house_file.h"
#include "show/state/make_show.h"
#include "show/status/status.h"
#include "show/storyteller/sounding.h"
#include "show/tick.h"
#include "show/watch/problems.h"
#include "show/watch/rehearsal.h"

namespace wellspring {

namespace {

namespace fs = std::filesystem;

constexpr double report_interval = 0.25, wait_at_reception = 0.1;  // seconds

void read_recordings_or_fail(Exhibit& exhibit, const RecordingOptions& options) {
  std::vector<Problem> problems;
  read_recordings(exhibit, options, problems);
  if (std::ranges::any_of(problems, &Problem::fatal)) throw ExhibitError(std::move(problems));
  for (const Problem& problem : problems) log::warn("{}", to_string(problem));
}

// When visitors have left, and again when their visits cannot be gone on with any more, memory that
// they had goes back to the system.
class MemoryReturn {
 public:
  void look(size_t visitors) {
    const double now = seconds_now();
    if (visitors < before_) due_ = now + soon_after, last_due_ = now + kept_seconds + soon_after;
    before_ = visitors;
    for (double* due : {&due_, &last_due_})
      if (now >= *due) *due = never, return_memory();
  }

 private:
  static constexpr double soon_after = 5, never = 1e18;  // seconds
  size_t before_ = 0;
  double due_ = never, last_due_ = never;
};

// One exhibit and what belongs to its show.
struct Room {
  explicit Room(std::unique_ptr<Show> begun)
      : show(std::move(begun)),
        stills(std::make_unique<StillRoom>(*show)),
        status(show->exhibit.id) {}
  std::unique_ptr<Show> show;
  std::unique_ptr<StillRoom> stills;
  ReportBoard board;
  StatusDesk status;
  Arrivals arrivals;
  std::atomic<bool> draws = false;       // its visitors need the cores
  std::unique_ptr<Rehearsal> rehearsal;  // null: it is not watched
  std::unique_ptr<Show> next;            // what has come of it, to be taken over
  std::thread thread;                    // of its ticks
};

std::vector<std::string> kiosks_of(const Exhibit& exhibit) {
  std::vector<std::string> names;
  for (const KioskSettings& kiosk : exhibit.kiosks) names.push_back(kiosk.name);
  return names;
}

// What others may know of it; what it has counted goes to the ledger, where there is one.
void publish(Room& room, Ledger* ledger) {
  ShowReport report = make_report(*room.show);
  if (ledger) {
    ledger->add(std::exchange(room.show->sums, {}));
    report.sums_problem = ledger->problem();
  }
  room.status.see(report);
  room.board.publish(std::move(report));
}

void look_at_rehearsal(Room& room, std::atomic<bool>& changed) {
  if (!room.rehearsal || room.next) return;
  auto outcome = room.rehearsal->take();
  if (!outcome) return;
  set_problems(*room.show, std::move(outcome->problems));
  room.next = std::move(outcome->show);
  if (room.next) changed = true;
}

// While visitors of one need the cores, no other is baked.
void share_cores(Room& room, const std::list<Room>& rooms) {
  room.draws = draws(*room.show);
  room.show->others_draw =
      std::ranges::any_of(rooms, [&](const Room& other) { return &other != &room && other.draws; });
}

void keep_ticking(Room& room, const std::list<Room>& rooms, Ledger* ledger,
                  const std::atomic<bool>& stopping, std::atomic<bool>& changed) {
  double reported = -1;
  while (!stopping) {
    const double began = seconds_now();
    room.show->local_time = local_time(std::time(nullptr));
    share_cores(room, rooms);
    tick(*room.show, room.arrivals, began);
    if (began - reported > report_interval) {
      reported = began;
      publish(room, ledger);
      look_at_rehearsal(room, changed);
    }
    wait_for_tick(*room.show, seconds_now());
  }
  publish(room, ledger);
}

}  // namespace

std::vector<std::string> exhibits_in(const std::string& content) {
  std::error_code ec;
  std::vector<std::string> ids;
  for (const auto& entry : fs::directory_iterator(content, ec))
    if (fs::exists(entry.path() / "exhibit.json", ec))
      ids.push_back(entry.path().filename().string());
  std::ranges::sort(ids);
  return ids;
}

struct Museum::Impl {
  const MuseumSettings settings;
  std::shared_ptr<Speaker> speaker;  // one voice program for all
  std::unique_ptr<Ledger> ledger;    // null: no sums are kept
  HouseSettings house;               // of the first exhibit, and so of all
  std::list<Room> rooms;
  StillDesk stills;  // is closed before its rooms go
  AnswerSources sources;
  std::unique_ptr<Reception> reception;  // null: there is one exhibit only
  std::atomic<bool> stopping = false, changed = false;

  explicit Impl(const MuseumSettings& settings)
      : settings(settings), stills(settings.stills, [this] { return somebody_draws(); }) {}

  bool somebody_draws() const {
    return std::ranges::any_of(rooms, [](const Room& room) { return room.draws.load(); });
  }

  std::vector<std::string> find_ids() const {
    const std::vector<std::string> ids = exhibits_in(settings.content);
    const std::string there = ids.empty() ? "there are none" : "there are " + list_names(ids);
    if (settings.exhibit.empty() && !ids.empty()) return ids;
    if (std::ranges::find(ids, settings.exhibit) != ids.end()) return {settings.exhibit};
    throw std::runtime_error("there is no exhibit '" + settings.exhibit + "' in " +
                             settings.content + did_you_mean(settings.exhibit, ids) + "; " + there);
  }

  // Loads, checks and lights an exhibit, ready to be ticked. The first is told the house's day.
  std::unique_ptr<Show> prepare(const std::string& id, bool is_first) const {
    Exhibit exhibit = load_exhibit(settings.content + "/" + id);
    read_recordings_or_fail(exhibit, settings.recordings);
    ShowSettings own = settings.show;
    own.cache = settings.recordings.cache;
    if (!is_first) own.house = house;
    else if (!settings.house.empty()) own.house = load_house(settings.house, exhibit);
    auto show = make_show(std::move(exhibit), own);
    if (!settings.seal_key.empty()) show->seal = std::make_shared<Seal>(settings.seal_key);
    std::vector<Problem> notes;
    check_places(show->exhibit, *show->world, notes);
    for (const Problem& note : notes) log::warn("{}", to_string(note));
    show->speech = make_speech_source(speaker);
    show->speech.prepare(lines_of(show->exhibit));
    return show;
  }

  void open_room(const std::string& id) {
    const bool is_first = rooms.empty();
    Room& room = rooms.emplace_back(prepare(id, is_first));
    if (is_first) house = room.show->settings.house;
    publish(room, ledger.get());
    if (settings.show.watched)
      room.rehearsal = std::make_unique<Rehearsal>(
          settings.content + "/" + id, [this, id, is_first] { return prepare(id, is_first); });
  }

  // What answers are made from, and where newcomers are led.
  void put_up_signs() {
    sources.exhibits.clear();
    std::vector<ExhibitDoor> doors;
    for (Room& room : rooms) {
      Show& show = *room.show;
      sources.exhibits.push_back({&show.exhibit, &room.board, room.stills.get(),
                                  show.roads.map ? &*show.roads.map : nullptr,
                                  show.settings.house.address});
      doors.push_back({show.exhibit.id, kiosks_of(show.exhibit)});
    }
    if (doors.size() > 1) reception = std::make_unique<Reception>(std::move(doors));
  }

  void note_failure(const std::string& id, const std::vector<Problem>& problems) {
    FailedExhibit& failed = sources.failed.emplace_back(FailedExhibit{id, {}});
    for (const Problem& problem : problems) {
      if (!problem.fatal) continue;
      failed.problems.push_back(to_string(problem));
      log::error("{}", failed.problems.back());
    }
  }

  void open_all() {
    const std::vector<std::string> ids = find_ids();
    SpeakerOptions options;
    if (!settings.recordings.cache.empty()) options.folder = settings.recordings.cache + "/speech";
    speaker = std::make_shared<Speaker>(options);
    for (const std::string& id : ids) try {
        open_room(id);
      } catch (const ExhibitError& error) {
        if (ids.size() == 1 || (rooms.empty() && id == ids.back())) throw;
        note_failure(id, error.problems);
      }
    put_up_signs();
  }

  size_t count_visitors() const {
    size_t visitors = 0;
    for (const Room& room : rooms) visitors += room.board.read().visitors.size();
    return visitors;
  }
  // As many visitors as a process may have, in all exhibits together.
  bool is_full() const { return int(count_visitors()) >= settings.show.max_visitors; }

  Room& room_at(size_t door) { return *std::next(rooms.begin(), long(door)); }
};

Museum::Museum(const MuseumSettings& settings) : impl_(std::make_unique<Impl>(settings)) {
  Impl& impl = *impl_;
  if (!settings.sums.empty()) impl.ledger = std::make_unique<Ledger>(LedgerSettings{settings.sums});
  impl.open_all();
  impl.sources.stills = &impl.stills;
  impl.sources.changes = settings.show.watched;
  impl.sources.desk.put = [&impl](const Announcement& one) {
    uint32_t number = 0;
    for (Room& room : impl.rooms) number = room.arrivals.announce(one);
    return number;
  };
}

Museum::~Museum() = default;

AnswerSources& Museum::sources() { return impl_->sources; }

void Museum::join(std::shared_ptr<Link> link) {
  if (impl_->reception) impl_->reception->enter(std::move(link));
  else impl_->rooms.front().arrivals.put(std::move(link));
}

std::string Museum::status(const char* sums) const {
  std::vector<Standing> all;
  for (const Room& room : impl_->rooms) all.push_back(room.status.tell());
  return write_status(all, impl_->sources.failed, sums);
}

Sums Museum::read_sums(int64_t from, int64_t to) const {
  return impl_->ledger ? impl_->ledger->read(from, to) : Sums{};
}

bool Museum::run(const std::function<bool()>& ended) {
  Impl& impl = *impl_;
  impl.stopping = impl.changed = false;
  impl.stills.open();
  for (Room& room : impl.rooms)
    room.thread = std::thread([&impl, &room] {
      keep_ticking(room, impl.rooms, impl.ledger.get(), impl.stopping, impl.changed);
    });
  MemoryReturn memory;
  while (!ended() && !impl.changed) {
    memory.look(impl.count_visitors());
    if (!impl.reception) {
      std::this_thread::sleep_for(std::chrono::duration<double>(wait_at_reception));
      continue;
    }
    for (Reception::Shown& one : impl.reception->show_in(wait_at_reception)) {
      if (one.link->kind == LinkKind::visit && impl.is_full()) turn_away(*one.link);
      else impl.room_at(one.door).arrivals.put(std::move(one.link));
    }
  }
  impl.stopping = true;
  for (Room& room : impl.rooms) room.thread.join();
  if (impl.ledger) impl.ledger->write();
  return impl.changed && !ended();
}

void Museum::give_up_stills() { impl_->stills.close(); }

void Museum::take_over() {
  for (Room& room : impl_->rooms) {
    if (!room.next) continue;
    log::info("'{}' has changed: its pages come back by themselves", room.show->exhibit.id);
    room.next->seal = room.show->seal;  // visits go on where they were
    room.stills.reset();
    room.show = std::move(room.next);
    room.stills = std::make_unique<StillRoom>(*room.show);
    publish(room, impl_->ledger.get());
  }
  impl_->put_up_signs();
}

}  // namespace wellspring
