// SPDX-License-Identifier: Apache-2.0
#include "show/http/map_desk.h"

#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <oneapi/tbb/task_arena.h>
#include <utility>

#include "show/http/pages.h"
#include "show/http/picture_desk.h"
#include "show/http/refusal.h"

namespace wellspring::show {

using nlohmann::json;

namespace {

constexpr size_t most_waiting_maps = 32, most_kept_maps = 12;
constexpr int fewest_shown = 2;
constexpr size_t most_told_colors = 6;

std::string name_of(const MapQuestion& question, size_t steps) {
  std::string name = std::to_string(question.shown);
  for (size_t i = 0; i < steps; i++) {
    const MapStep& step = question.steps[i];
    name += fmt::format(";{}@{}", step.pivot, step.radius);
    for (const int cluster : step.clusters) name += fmt::format("c{}", cluster);
  }
  return name;
}

double rounded(double number) { return std::round(number * 1e5) / 1e5; }

json list_colors(const Record& record) {
  json colors = json::array();
  for (const Swatch& swatch : record.palette)
    if (colors.size() < most_told_colors) colors.push_back(swatch.code);
  return colors;
}

json describe_clusters(const Records& records, const MapLevel& level) {
  json clusters = json::array();
  for (const ClusterNature& nature : level.natures) {
    json& one = clusters.emplace_back(json{{"count", nature.count}, {"terms", json::array()}});
    for (const uint32_t term : nature.terms) one["terms"].push_back(records.terms[term].name);
    if (nature.first) one["from"] = *nature.first, one["to"] = *nature.last;
  }
  return clusters;
}

}  // namespace

MapQuestion read_map_question(const std::map<std::string, std::string>& query) {
  MapQuestion question;
  for (const auto& [name, value] : query) {
    if (name == "trail") {
      if (auto steps = read_trail(value)) question.steps = std::move(*steps);
      else question.problem = "trail: steps are like 12@0.35 or c0,2, with ; between them";
    } else if (name == "shown") {
      const char* end = value.data() + value.size();
      const auto [at, error] = std::from_chars(value.data(), end, question.shown);
      if (error != std::errc() || at != end || question.shown < fewest_shown ||
          question.shown > most_on_map)
        question.problem =
            fmt::format("shown: a whole number from {} to {}", fewest_shown, most_on_map);
    } else {
      question.problem = "there is no parameter '" + name.substr(0, 40) + "'";
    }
  }
  return question;
}

MapDesk::~MapDesk() {
  {
    std::lock_guard lock(mutex_);
    end_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
  for (const Ticket& ticket : waiting_)
    if (ticket.asker) ticket.asker->answer(refuse(503, "stopping", "the server stops"));
}

void MapDesk::ask(const Exhibit& exhibit, const MapQuestion& question,
                  const std::shared_ptr<HttpAsker>& asker) {
  Ticket ticket{exhibit.collection,
                {},
                fmt::format("api/v1/exhibits/{}/collection/pictures/", escaped(exhibit.id)),
                exhibit.allowed_hosts,
                question,
                asker};
  ticket.object_ids.resize(exhibit.collection->collection.records.all.size());
  for (const auto& [record, point] : exhibit.collection->points)
    ticket.object_ids[size_t(record)] = exhibit.points[size_t(point)].id;
  if (put(std::move(ticket))) return;
  HttpReply busy = refuse(503, "busy", "many ask for maps; please come back in a moment");
  busy.headers["Retry-After"] = "2";
  asker->answer(std::move(busy));
}

void MapDesk::prepare(const Exhibit& exhibit) {
  if (exhibit.collection) put({exhibit.collection, {}, {}, {}, {}, nullptr});
}

bool MapDesk::put(Ticket ticket) {
  std::lock_guard lock(mutex_);
  if (waiting_.size() >= most_waiting_maps) return false;
  // Those that nobody waits for come last.
  auto at = waiting_.end();
  while (ticket.asker && at != waiting_.begin() && !std::prev(at)->asker) --at;
  waiting_.insert(at, std::move(ticket));
  if (!thread_.joinable()) thread_ = std::thread([this] { live(); });
  changed_.notify_all();
  return true;
}

// Visitors' pictures come first: loops over cores have a lower priority than those of renderers.
void MapDesk::live() {
  oneapi::tbb::task_arena arena(oneapi::tbb::task_arena::automatic, 1,
                                oneapi::tbb::task_arena::priority::low);
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [&] { return end_ || !waiting_.empty(); });
    if (end_) return;
    const Ticket ticket = std::move(waiting_.front());
    waiting_.pop_front();
    if (ticket.asker && ticket.asker->gone()) continue;
    lock.unlock();
    if (ticket.asker) ticket.asker->answer(arena.execute([&] { return reply_to(ticket); }));
    else arena.execute([&] { level_of(ticket); });
    lock.lock();
  }
}

std::shared_ptr<const MapLevel> MapDesk::level_of(const Ticket& ticket) {
  const MapChoice choice{.most_shown = ticket.question.shown};
  std::shared_ptr<const MapLevel> level;
  for (size_t steps = 0; steps <= ticket.question.steps.size(); steps++) {
    const std::string name = name_of(ticket.question, steps);
    auto found = kept_.begin();
    while (found != kept_.end() && (found->steps != name || found->collection != ticket.collection))
      ++found;
    if (found != kept_.end()) {
      kept_.splice(kept_.begin(), kept_, found);
      level = found->level;
      continue;
    }
    const Collection& collection = ticket.collection->collection;
    auto made = steps == 0
                    ? std::optional(make_first_level(collection, choice))
                    : take_step(collection, *level, ticket.question.steps[steps - 1], choice);
    if (!made) return nullptr;
    level = std::make_shared<const MapLevel>(std::move(*made));
    kept_.push_front({ticket.collection, name, level});
    if (kept_.size() > most_kept_maps) kept_.pop_back();
  }
  return level;
}

HttpReply MapDesk::reply_to(const Ticket& ticket) {
  const std::shared_ptr<const MapLevel> level = level_of(ticket);
  if (!level) return refuse(404, "no_step", "a map of the trail does not have such an object");
  const Records& records = ticket.collection->collection.records;
  json body = {{"title", ticket.collection->title},
               {"objects", records.all.size()},
               {"region", level->region.size()},
               {"stress", rounded(level->layout.stress)},
               {"too_near", level->outliers},
               {"clusters", describe_clusters(records, *level)},
               {"items", json::array()}};
  for (size_t i = 0; i < level->shown.size(); i++) {
    const int index = level->shown[i];
    const Record& record = records.all[size_t(index)];
    json& item = body["items"].emplace_back(json{{"index", index},
                                                 {"id", record.id},
                                                 {"title", record.title},
                                                 {"x", rounded(level->layout.places[i].x)},
                                                 {"y", rounded(level->layout.places[i].y)},
                                                 {"stress", rounded(level->layout.item_stress[i])},
                                                 {"cluster", level->clusters.of[i]}});
    const std::string picture = allowed_picture(record, ticket.hosts).empty()
                                    ? std::string()
                                    : ticket.pictures + std::to_string(index);
    for (const auto& [name, text] :
         {std::pair("maker", &record.maker), std::pair("date", &record.date),
          std::pair("link", &record.link), std::pair("picture", &picture),
          std::pair("object", &ticket.object_ids[size_t(index)])})
      if (!text->empty()) item[name] = *text;
    if (!record.palette.empty()) item["colors"] = list_colors(record);
  }
  HttpReply reply;
  reply.headers["Cache-Control"] = "public, max-age=60";
  reply.body = body.dump(-1, ' ', false, json::error_handler_t::replace);
  return reply;
}

}  // namespace wellspring::show
