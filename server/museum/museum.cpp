// SPDX-License-Identifier: Apache-2.0
#include "museum/museum.h"

#include <algorithm>
#include <atomic>
#include <ctime>
#include <filesystem>
#include <list>
#include <mutex>
#include <thread>

#include "base/clock.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/unicode.h"
#include "base/write_file.h"
#include "ledger/ledger.h"
#include "museum/reception.h"
#include "museum/upkeep.h"
#include "show/answer/come_back.h"
#include "show/check/check_scene.h"
#include "show/exhibit/load/exhibit_load.h"
#include "show/house/house.h"
#include "show/state/renderer.h"
#include "show/state/make_show.h"
#include "show/workers/send.h"
#include "show/status/status.h"
#include "show/storyteller/voice.h"
#include "show/tick.h"
#include "show/watch/rehearsal.h"
#include "wire/prometheus.h"

namespace wellspring::museum {

namespace {

namespace fs = std::filesystem;

constexpr double report_interval = 0.25, wait_at_reception = 0.1;  // seconds

void read_recordings_or_fail(Exhibit& exhibit, const RecordingOptions& options) {
  std::vector<Problem> problems;
  read_recordings(exhibit, options, problems);
  if (std::ranges::any_of(problems, &Problem::fatal)) throw ExhibitError(std::move(problems));
  for (const Problem& problem : problems) log::warn("{}", to_string(problem));
}

// Gives memory back to the system when visitors have left, and again when their visits cannot be
// gone on with any more.
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

// A room holds one exhibit and what belongs to its show.
struct Room {
  explicit Room(std::unique_ptr<Show> begun)
      : show(std::move(begun)),
        stills(std::make_unique<StillRoom>(*show)),
        status(show->stage.exhibit.id) {}
  std::unique_ptr<Show> show;
  std::unique_ptr<StillRoom> stills;
  ReportBoard board;
  StatusDesk status;
  Arrivals arrivals;
  std::atomic<bool> draws = false;  // the room's visitors need the cores
  Heartbeat heartbeat;
  Calendar calendar;
  std::unique_ptr<Rehearsal> rehearsal;
  std::unique_ptr<Show> next;  // result of the rehearsal, to be taken over
  std::thread thread;          // thread that ticks the show
};

std::vector<std::string> kiosks_of(const Exhibit& exhibit) {
  std::vector<std::string> names;
  for (const KioskSettings& kiosk : exhibit.kiosks) names.push_back(kiosk.name);
  return names;
}

// Holds the parts of the process that all rooms use.
struct SharedParts {
  Ledger* ledger = nullptr;  // gets all counts; null: there is none
  std::function<DoorCounts()> doors;
  const StillDesk* stills = nullptr;
  Disks disks;
};

// Publishes the room's report for other threads. `reception`: for the first room, which reports for
// all rooms together; else null.
void publish(Room& room, const SharedParts& shared, const Reception* reception = nullptr) {
  ShowReport report = make_report(*room.show);
  if (reception) {
    const Reception::Standing standing = reception->standing();
    report.waiting = standing.waiting;
    report.turned_away = standing.turned_away;
  }
  if (shared.ledger) {
    shared.ledger->add(std::exchange(room.show->sums, {}));
    report.sums_problem = shared.ledger->problem();
  }
  if (shared.doors) report.doors = shared.doors();
  if (reception) {
    report.damaged_files = damaged_files();
    report.full_disks = shared.disks.full();
  }
  room.status.see(report);
  room.board.publish(std::move(report));
}

void look_at_rehearsal(Room& room, std::atomic<bool>& changed) {
  if (room.next) return;
  auto outcome = room.rehearsal->take();
  if (!outcome) return;
  // Only people who work on an exhibit want its pages to show problems.
  if (room.show->settings.watched)
    set_problems(room.show->stage, room.show->visits, std::move(outcome->problems));
  room.next = std::move(outcome->show);
  if (room.next) changed = true;
}

// Decides which exhibits leave the cores to others: while visitors of one exhibit need the cores,
// no other is baked; while an exhibit is loaded anew, or somebody waits for a still picture, none
// is.
void share_cores(Room& room, const std::list<Room>& rooms, const StillDesk& stills) {
  room.draws = draws(room.show->visits, *room.show->drawing, room.show->time);
  room.show->drawing->others_draw =
      stills.status().waiting > 0 || std::ranges::any_of(rooms, [&](const Room& other) {
        return (&other != &room && other.draws) || (other.rehearsal && other.rehearsal->at_work());
      });
}

void keep_ticking(Room& room, const std::list<Room>& rooms, const SharedParts& shared,
                  Reception& reception, const std::atomic<bool>& stopping,
                  std::atomic<bool>& changed) {
  const Reception* told = &room == &rooms.front() ? &reception : nullptr;
  double reported = -1;
  bool doubted = false;
  while (!stopping) {
    const double began = seconds_now();
    room.show->house.local_time = local_time(room.calendar.see(std::time(nullptr), began));
    if (room.calendar.doubts() && !doubted)
      log::warn(
          "the clock has leapt: days go on as they were for {:.0f} minutes, unless it stays so",
          Calendar::patience / 60);
    doubted = room.calendar.doubts();
    share_cores(room, rooms, *shared.stills);
    tick(*room.show, room.arrivals, began);
    const Worker& worker = room.show->drawing->renderer.worker;
    room.heartbeat.tick(began, worker.busy() ? worker.runs() : 0);
    for (std::shared_ptr<Link>& link : std::exchange(room.show->visits.resting, {}))
      reception.rest(std::move(link));
    if (began - reported > report_interval) {
      reported = began;
      publish(room, shared, told);
      look_at_rehearsal(room, changed);
    }
    wait_for_tick(*room.show, seconds_now());
  }
  publish(room, shared, told);
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
  std::shared_ptr<Speaker> speaker;    // one voice program for all exhibits
  std::unique_ptr<Ledger> ledger;      // null: no sums are kept
  mutable std::mutex house_mutex;      // guards `house`
  HouseSettings house;                 // settings of the first exhibit, which all share
  fs::file_time_type house_time;       // time of the house file's last change
  std::shared_ptr<Capacity> capacity;  // capacity that all rooms share
  std::list<Room> rooms;               // their rehearsals may use all fields above until they end
  StillDesk stills;                    // is closed before rooms are destroyed
  MapDesk maps;
  PictureDesk pictures;
  AnswerSources sources;
  std::unique_ptr<Reception> reception;
  std::atomic<bool> stopping = false, changed = false;

  explicit Impl(const MuseumSettings& settings)
      : settings(settings),
        capacity(std::make_shared<Capacity>(settings.capacity)),
        stills(settings.stills, [this] { return somebody_draws(); }) {}

  SharedParts shared() const {
    return {ledger.get(), sources.door_counts, &stills, {settings.recordings.cache, settings.sums}};
  }

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

  HouseSettings first_house() const {
    std::lock_guard lock(house_mutex);
    return house;
  }

  // Gives all shows the house settings of the first exhibit. Called while no show ticks.
  void share_house() {
    std::lock_guard lock(house_mutex);
    house = rooms.front().show->settings.house;
    for (Room& room : rooms) room.show->settings.house = house;
  }

  // Loads, checks and lights an exhibit, ready to be ticked. The first one reads the house file.
  std::unique_ptr<Show> prepare(const std::string& id, bool is_first) const {
    Exhibit exhibit = load_exhibit(settings.content + "/" + id, settings.recordings.cache);
    read_recordings_or_fail(exhibit, settings.recordings);
    ShowSettings own = settings.show;
    own.cache = settings.recordings.cache;
    if (!is_first) own.house = first_house();
    else if (!settings.house.empty()) own.house = load_house(settings.house, exhibit);
    auto show = make_show(std::move(exhibit), own);
    if (!settings.seal_key.empty()) show->visits.seal = std::make_shared<Seal>(settings.seal_key);
    std::vector<Problem> notes;
    check_places(show->stage.exhibit, *show->stage.world, notes);
    std::vector<Problem> light;
    check_shipped_light(show->stage.exhibit, light);
    for (const Problem& problem : light) show->stage.light_problem = to_string(problem);
    notes.insert(notes.end(), light.begin(), light.end());
    for (const Problem& note : notes) log::warn("{}", to_string(note));
    begin_workers(*show);
    show->visits.capacity = capacity;
    show->cast.speech = make_speech_source(speaker);
    show->cast.speech.prepare(lines_of(show->stage.exhibit));
    return show;
  }

  fs::file_time_type time_of_house() const {
    std::error_code ec;
    return settings.house.empty() ? fs::file_time_type() : fs::last_write_time(settings.house, ec);
  }

  void open_room(const std::string& id) {
    const bool is_first = rooms.empty();
    Room& room = rooms.emplace_back(prepare(id, is_first));
    if (is_first) share_house();
    publish(room, shared());
    room.rehearsal = std::make_unique<Rehearsal>(
        settings.content + "/" + id, [this, id, is_first] { return prepare(id, is_first); },
        settings.show.watched);
  }

  // Fills the sources of HTTP answers, and makes a new queue for newcomers of all rooms.
  void put_up_signs() {
    sources.exhibits.clear();
    std::vector<ExhibitDoor> doors;
    for (Room& room : rooms) {
      Show& show = *room.show;
      sources.exhibits.push_back({&show.stage.exhibit, &room.board, room.stills.get(),
                                  show.stage.roads.map ? &*show.stage.roads.map : nullptr,
                                  show.settings.house.address});
      maps.prepare(show.stage.exhibit);
      doors.push_back({show.stage.exhibit.id, kiosks_of(show.stage.exhibit)});
    }
    reception = std::make_unique<Reception>(
        std::move(doors), capacity,
        ReceptionSettings{.most_waiting = settings.most_waiting,
                          .most_pixels = double(settings.show.max_pixels),
                          .kiosk_tokens = settings.show.kiosk_tokens});
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

  Room& room_at(size_t door) { return *std::next(rooms.begin(), long(door)); }
};

Museum::Museum(const MuseumSettings& settings) : impl_(std::make_unique<Impl>(settings)) {
  Impl& impl = *impl_;
  impl.house_time = impl.time_of_house();
  if (const std::string& cache = settings.recordings.cache; !cache.empty())
    if (const Unfinished left = remove_unfinished(cache); left.files > 0)
      log::info("{}: {} unfinished files of {:.1f} MB are taken away", cache, left.files,
                1e-6 * double(left.bytes));
  if (!settings.sums.empty()) impl.ledger = std::make_unique<Ledger>(LedgerSettings{settings.sums});
  impl.open_all();
  impl.sources.stills = &impl.stills;
  impl.sources.maps = &impl.maps;
  impl.sources.pictures = &impl.pictures;
  impl.sources.changes = settings.show.watched;
  impl.sources.desk.put = [&impl](const Announcement& one) {
    uint32_t number = 0;
    for (Room& room : impl.rooms) number = room.arrivals.announce(one);
    return number;
  };
}

Museum::~Museum() {
  for (Room& room : impl_->rooms)
    // All are cancelled before the first one is waited for.
    if (room.rehearsal) room.rehearsal->cancel();
}

AnswerSources& Museum::sources() { return impl_->sources; }

void Museum::join(std::shared_ptr<Link> link) { impl_->reception->enter(std::move(link)); }

std::string Museum::status() const {
  std::vector<Standing> all;
  for (const Room& room : impl_->rooms) all.push_back(room.status.tell());
  return write_status(all, impl_->sources.failed, impl_->ledger != nullptr);
}

std::string Museum::metrics() const {
  const Reception::Standing people = impl_->reception->standing();
  const Capacity::Standing cores = impl_->capacity->standing();
  std::string text;
  add_metric(text, "visitors_waiting", "Visitors for whom there is no seat yet",
             double(people.waiting));
  add_metric(text, "visits_resting", "Visits that nobody is at, whose pages are open",
             double(people.resting));
  add_metric(text, "visits_turned_away_total", "Visits refused because too many waited",
             double(people.turned_away));
  add_metric(text, "seats_taken", "Visitors who are shown pictures, of all exhibits", cores.seats);
  add_metric(text, "seats", "Visitors at 1280x720 whom this machine serves, as measured so far",
             seats());
  add_metric(text, "capacity_cores", "Cores that visitors' pictures may take", cores.cores);
  add_metric(text, "capacity_cores_taken",
             "Cores that they take at the least rate while all visitors walk", cores.busy);
  add_metric(text, "capacity_memory_bytes", "Memory that visitors' pictures may take",
             cores.memory);
  add_metric(text, "capacity_memory_taken_bytes", "Memory that they take, about", cores.bytes);
  add_metric(text, "picture_shown_seconds_a_megapixel", "Processor time of warping and encoding",
             1e6 * cores.cost.shown);
  add_metric(text, "picture_drawn_seconds_a_megapixel", "Processor time of a whole keyframe",
             1e6 * cores.cost.drawn);
  return text;
}

int Museum::seats() const { return impl_->capacity->seats_for({1280 * 720, true}); }

Sums Museum::read_sums(int64_t from, int64_t to) const {
  return impl_->ledger ? impl_->ledger->read(from, to) : Sums{};
}

bool Museum::run(const std::function<bool()>& ended) {
  Impl& impl = *impl_;
  impl.stopping = impl.changed = false;
  impl.stills.open();
  for (Room& room : impl.rooms)
    room.thread = std::thread([&impl, &room] {
      keep_ticking(room, impl.rooms, impl.shared(), *impl.reception, impl.stopping, impl.changed);
    });
  MemoryReturn memory;
  while (!ended() && !impl.changed) {
    memory.look(impl.count_visitors());
    for (Reception::Shown& one : impl.reception->show_in(wait_at_reception))
      impl.room_at(one.door).arrivals.put(std::move(one.link), std::move(one.seat));
  }
  impl.stopping = true;
  for (Room& room : impl.rooms) room.thread.join();
  if (impl.ledger) impl.ledger->write();
  return impl.changed && !ended();
}

void Museum::give_up_stills() { impl_->stills.close(); }

void Museum::reload() {
  const auto before = std::exchange(impl_->house_time, impl_->time_of_house());
  const bool new_house = impl_->house_time != before;
  for (Room& room : impl_->rooms) room.rehearsal->look(new_house && &room == &impl_->rooms.front());
}

bool Museum::has_gone_on() {
  auto beats = [](const Room& room) { return room.heartbeat.beats(); };
  if (!std::ranges::all_of(impl_->rooms, beats)) return false;
  for (Room& room : impl_->rooms) room.heartbeat.forget();
  return true;
}

void Museum::take_over() {
  for (Room& room : impl_->rooms) {
    if (!room.next) continue;
    log::info("'{}' has changed: its pages come back by themselves", room.show->stage.exhibit.id);
    room.next->visits.seal = room.show->visits.seal;  // visits go on in the new show
    room.stills.reset();
    room.show = std::move(room.next);
    room.stills = std::make_unique<StillRoom>(*room.show);
    publish(room, impl_->shared());
  }
  impl_->share_house();
  impl_->put_up_signs();
}

}  // namespace wellspring::museum
