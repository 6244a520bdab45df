// SPDX-License-Identifier: Apache-2.0
#include "show/answer/come_back.h"
#include "show/count/count.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "base/log.h"
#include "show/answer/groups.h"
#include "show/state/lamps.h"
#include "wire/limits.h"

namespace wellspring::show {

using nlohmann::json;

namespace {

constexpr double token_interval = 2;  // seconds
constexpr double rest = 0.25;         // seconds without a move after which a visitor stands

std::string make_id() {
  std::random_device random;
  return std::to_string((uint64_t(random()) << 32) | random());
}

double rounded(double value) { return std::round(value * 1e4) / 1e4; }

json place_of(const Viewpoint& view) {
  return {rounded(view.position.x), rounded(view.position.y), rounded(view.position.z),
          rounded(view.yaw),        rounded(view.pitch),      rounded(view.fov),
          rounded(view.roll)};
}

// All but the day.
json describe(const ExhibitStage& stage, const Visitor& visitor) {
  const VisitorPlace& place = visitor.place;
  json about = {{"id", visitor.id},
                {"exhibit", stage.exhibit.id},
                {"place", place_of(place.view)},
                {"viewpoint", place.viewpoint}};
  for (size_t i = 0; i < visitor.lamps.own.size(); i++)
    if (visitor.lamps.own[i]) about["lamps"][stage.exhibit.lamps[i].id] = visitor.lamps.wish[i];
  if (visitor.lamps.hour) about["hour"] = *visitor.lamps.hour;
  if (const TourRide& ride = place.tour; ride.state != TourRide::State::none && ride.tour >= 0)
    about["tour"] = {{"id", stage.exhibit.tours[size_t(ride.tour)].id},
                     {"stop", ride.stop},
                     {"paused", ride.state == TourRide::State::paused}};
  if (const Teller* teller = visitor.own_teller.get()) {
    about["teller"] = {{"id", stage.exhibit.storytellers[teller->index].id},
                       {"visible", teller->visible},
                       {"humanlike", teller->humanlike}};
    if (!teller->voice.story.empty() && !teller->voice.queue.empty())
      about["story"] = {{"id", teller->voice.story},
                        {"sentence", teller->voice.sentence},
                        {"paused", teller->voice.paused}};
  }
  if (!visitor.group.leads.empty()) about["leads"] = visitor.group.leads;
  if (!visitor.group.follows.empty()) about["follows"] = visitor.group.follows;
  return about;
}

// Returns whether the kept visit is one of this exhibit, and not too old.
bool is_valid(const ExhibitStage& stage, const ShowHouse& house, const json& about) {
  if (!about.is_object() || about.value("exhibit", json()) != stage.exhibit.id) return false;
  const json day = about.value("day", json());
  return day.is_number_integer() && day >= house.local_time.day - token_days &&
         about.value("id", json()).is_string();
}

bool is_story(const Exhibit& exhibit, const std::string& id) {
  return std::ranges::find(exhibit.stories, id, &StoryText::id) != exhibit.stories.end();
}

double within(const json& number, double least, double most) {
  return std::clamp(number.get<double>(), least, most);
}

// Puts a visit back; parts that the exhibit does not have any more are left out.
void restore(Show& show, Visitor& visitor, const json& about) {
  VisitorPlace& place = visitor.place;
  const json& at = about.at("place");
  const auto angle = [&](int i) { return float(within(at.at(size_t(i)), -max_angle, max_angle)); };
  for (int i = 0; i < 3; i++)
    place.view.position[i] = within(at.at(size_t(i)), -max_coordinate, max_coordinate);
  place.view.yaw = angle(3), place.view.pitch = angle(4);
  place.view.fov = float(within(at.at(5), 0.05, 3));
  place.view.roll = at.size() > 6 ? angle(6) : 0;
  const double viewpoint = about.at("viewpoint");
  const bool known = viewpoint >= 0 && viewpoint < double(show.stage.exhibit.viewpoints.size());
  place.viewpoint = known ? int(viewpoint) : -1;
  const json lamps = about.value("lamps", json::object());
  for (const auto& [name, on] : lamps.items())
    switch_lamp(show, visitor, name, LampSwitch(within(on, 0, most_dial_lights + 1)));
  if (about.contains("hour")) set_hour(show.stage, visitor, about["hour"].get<double>());
  if (about.contains("leads")) {
    const std::string code = about["leads"];
    const bool taken = std::ranges::any_of(
        show.visits.visitors, [&](const Visitor& other) { return other.group.leads == code; });
    if (!taken) visitor.group.leads = code;
  }
  if (about.contains("follows")) {
    GroupOrder order;
    order.action = GroupAction::follow;
    order.code = about["follows"];
    if (!handle_group(show.visits, visitor, order)) return;
  }
  if (about.contains("tour")) {
    const json& ride = about["tour"];
    auto found = std::ranges::find(show.stage.exhibit.tours, ride.at("id").get<std::string>(),
                                   &TourPlan::id);
    if (found != show.stage.exhibit.tours.end()) {
      start_tour(place.tour, visitor.hearing.narration.voice,
                 int(found - show.stage.exhibit.tours.begin()), show.stage.exhibit,
                 show.stage.roads, place.view);
      const int last = int(show.stage.exhibit.tours[size_t(place.tour.tour)].stops.size()) - 1;
      go_on_from_stop(place.tour, visitor.hearing.narration.voice, show.stage.exhibit,
                      show.stage.roads, int(within(ride.at("stop"), 0, last)));
      if (ride.at("paused")) pause_tour(place.tour, visitor.hearing.narration.voice);
    }
  }
  if (!about.contains("teller") || show.stage.exhibit.shared_storyteller) return;
  const json& who = about["teller"];
  StorytellerOrder order;
  order.teller = who.at("id");
  order.visible = who.at("visible").get<bool>();
  order.humanlike = who.at("humanlike").get<bool>();
  const json story = about.value("story", json::object());
  const std::string id = story.value("id", std::string());
  if (handle_storyteller(show, visitor, order) || !is_story(show.stage.exhibit, id)) return;
  Teller& teller = *visitor.own_teller;  // goes on with it: it was counted when it was begun
  tell(teller.voice, *std::ranges::find(show.stage.exhibit.stories, id, &StoryText::id),
       int(within(story.at("sentence"), 0, 1e6)));
  teller.voice.asked_by = visitor.link->id;
  if (story.at("paused")) pause_voice(teller.voice);
}

// As it was when its line broke.
bool take_kept(ShowVisits& visits, Visitor& visitor, const std::string& id) {
  auto kept = std::ranges::find(visits.kept, id, &KeptVisit::id);
  if (kept == visits.kept.end()) return false;
  Visitor& before = kept->visitor.front();
  if (before.own_teller && before.own_teller->voice.asked_by == before.link->id)
    before.own_teller->voice.asked_by = visitor.link->id;
  const uint32_t seq = visitor.place.seq;
  visitor.place = std::move(before.place);
  visitor.place.seq = seq;
  visitor.place.move = visitor.place.velocity = vec3(0);
  visitor.own_teller = std::move(before.own_teller);
  visitor.lamps = std::move(before.lamps);
  visitor.pieces = std::move(before.pieces);
  visitor.group = std::move(before.group);
  visitor.hearing.narration = std::move(before.hearing.narration);
  visitor.picture = std::move(before.picture);
  visits.kept.erase(kept);
  return true;
}

}  // namespace

void send_token(Show& show, Visitor& visitor) {
  if (visitor.kiosk) return;
  const double rests_at = visitor.place.moved_at + rest;
  const bool came_to_rest = visitor.told_at < rests_at && show.time >= rests_at;
  if (!came_to_rest && show.time - visitor.told_at < token_interval) return;
  visitor.told_at = show.time;
  if (visitor.id.empty()) visitor.id = make_id();
  std::string now = describe(show.stage, visitor).dump();
  if (now == visitor.told) return;
  visitor.told = std::move(now);
  visitor.link->send_text(json{{"type", "keep"}, {"token", visit_token(show, visitor)}}.dump());
}

std::string visit_token(const Show& show, Visitor& visitor) {
  if (visitor.id.empty()) visitor.id = make_id();
  json dated = describe(show.stage, visitor);
  dated["day"] = show.house.local_time.day;
  return show.visits.seal->close(dated.dump());
}

void keep_visit(Show& show, std::list<Visitor>::iterator gone) {
  if (gone->kiosk || gone->id.empty()) {
    count_leaving(show, *gone);
    show.visits.visitors.erase(gone);
    return;
  }
  KeptVisit& kept = show.visits.kept.emplace_back();
  kept.id = gone->id;
  kept.since = show.time;
  kept.visitor.splice(kept.visitor.begin(), show.visits.visitors, gone);
  kept.visitor.front().seat = nullptr;  // who comes back has found another
  if (show.visits.kept.size() <= most_kept) return;
  count_leaving(show, show.visits.kept.front().visitor.front());
  show.visits.kept.pop_front();
}

void forget_visits(Show& show) {
  std::erase_if(show.visits.kept, [&](KeptVisit& kept) {
    const bool over = show.time - kept.since > kept_seconds;
    if (over) count_leaving(show, kept.visitor.front());
    return over;
  });
}

bool come_back(Show& show, Visitor& visitor, const std::string& token) {
  const auto text = show.visits.seal->open(token);
  if (!text || visitor.kiosk) return false;
  const json about = json::parse(*text, nullptr, false);
  if (!is_valid(show.stage, show.house, about)) return false;
  visitor.id = about["id"];
  if (take_kept(show.visits, visitor, visitor.id)) return true;
  visitor.place.camera_cuts++;
  try {
    restore(show, visitor, about);
  } catch (const json::exception& error) {  // sealed by an older program: as much as there is
    log::info("visitor {} comes back in part: {}", visitor.link->id, error.what());
  }
  return true;
}

}  // namespace wellspring::show
