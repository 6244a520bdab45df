// SPDX-License-Identifier: Apache-2.0
#include "show/http/answer.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "show/answer/objects.h"
#include "show/http/iiif.h"
#include "show/http/pages.h"
#include "show/http/still.h"

namespace wellspring::show {

using nlohmann::json;

namespace {

HttpReply json_reply(const json& body, int status = 200) {
  HttpReply reply;
  reply.status = status;
  reply.body = body.dump(-1, ' ', false, json::error_handler_t::replace);
  reply.headers["Cache-Control"] = "no-store";
  return reply;
}

// JSON that changes all the time.
HttpReply text_reply(std::string body) {
  HttpReply reply;
  reply.body = std::move(body);
  reply.headers["Cache-Control"] = "no-store";
  return reply;
}

HttpReply error_reply(int status, const std::string& code, const std::string& message) {
  return json_reply({{"error", {{"code", code}, {"message", message}}}}, status);
}

json describe(const Exhibit& exhibit) {
  json about = {{"id", exhibit.id},
                {"title", exhibit.title},
                {"description", exhibit.description},
                {"languages", exhibit.languages},
                {"poster", poster_address(exhibit)},
                {"viewpoints", json::array()},
                {"stories", json::array()},
                {"tours", json::array()},
                {"objects", describe_objects(exhibit)}};
  for (const ExhibitViewpoint& viewpoint : exhibit.viewpoints)
    about["viewpoints"].push_back(
        {{"name", viewpoint.view.name},
         {"title", viewpoint.title},
         {"position",
          {viewpoint.view.position.x, viewpoint.view.position.y, viewpoint.view.position.z}},
         {"yaw", viewpoint.view.yaw},
         {"pitch", viewpoint.view.pitch},
         {"roll", viewpoint.view.roll},
         {"fov", viewpoint.view.fov}});
  for (const StoryText& story : exhibit.stories) {
    json& entry = about["stories"].emplace_back(json{{"id", story.id}, {"title", story.title}});
    if (story.storyteller_index >= 0)
      entry["teller"] = exhibit.storytellers[size_t(story.storyteller_index)].id;
  }
  for (const TourPlan& tour : exhibit.tours)
    about["tours"].push_back(
        {{"id", tour.id}, {"title", tour.title}, {"stops", tour.stops.size()}});
  about["lamps"] = json::array();
  for (const ExhibitLamp& lamp : exhibit.lamps)
    about["lamps"].push_back({{"name", lamp.id}, {"title", lamp.title}, {"on_at_first", lamp.on}});
  about["day"] = nullptr;
  if (const std::optional<Day>& day = exhibit.day)
    about["day"] = {
        {"from", day->settings.from}, {"to", day->settings.to}, {"at", day->settings.at}};
  about["animations"] = json::array();
  for (const ExhibitAnimation& animation : exhibit.animations) {
    const bool touched = animation.start == ExhibitAnimation::Start::touch;
    about["animations"].push_back({{"id", animation.id},
                                   {"title", animation.title},
                                   {"play", touched ? "touch" : "loop"},
                                   {"shared", animation.shared}});
    if (animation.point >= 0)
      about["animations"].back()["object"] = exhibit.points[size_t(animation.point)].id;
  }
  about["storyteller"] =
      exhibit.storytellers.empty() ? json(nullptr) : json(exhibit.storytellers.front().name);
  about["storytellers"] = json::array();
  for (const StorytellerPlace& storyteller_place : exhibit.storytellers)
    about["storytellers"].push_back(
        {{"id", storyteller_place.id}, {"name", storyteller_place.name}});
  about["book"] = describe_book(exhibit);
  about["collection"] = exhibit.collection ? json(exhibit.collection->title) : json(nullptr);
  about["credits"] = json::array();
  for (const Credit& credit : exhibit.credits)
    about["credits"].push_back({{"file", credit.file},
                                {"title", credit.title},
                                {"author", credit.author},
                                {"license", credit.licence},
                                {"source", credit.source},
                                {"copyright", credit.copyright}});
  about["start"] = exhibit.viewpoints[size_t(exhibit.start)].view.name;
  return about;
}

HttpReply still_reply(StillOutcome outcome) {
  HttpReply reply;
  if (outcome.status == 200) {
    reply.content_type = "image/jpeg";
    reply.headers["Cache-Control"] = "public, max-age=60";
    const StillPicture& made = outcome.picture;
    reply.headers["ETag"] = make_etag(made.jpeg);
    constexpr const char* denoised[] = {"yes", "no", "no; the network's weights are missing"};
    if (made.spp > 0) {
      reply.headers["Still-Samples"] = std::to_string(made.spp);
      reply.headers["Still-Denoised"] = denoised[size_t(made.denoised)];
    }
    reply.body = std::move(outcome.picture.jpeg);
  } else {
    reply = error_reply(outcome.status, outcome.code, outcome.problem);
    if (outcome.retry_seconds > 0)
      reply.headers["Retry-After"] = std::to_string(int(std::ceil(outcome.retry_seconds)));
  }
  return reply;
}

// Without a picture: of a wrong question, or to whoever does not want its body.
HttpReply answer_still(const ServedExhibit& sources, const HttpQuestion& question) {
  const StillQuestion asked = read_still_question(*sources.exhibit, question.query);
  if (asked.status != 200) return error_reply(asked.status, asked.code, asked.problem);
  return still_reply({});
}

// Without a map: of a wrong question, or to whoever does not want its body.
HttpReply answer_collection(const ServedExhibit& sources, const HttpQuestion& question) {
  if (!sources.exhibit->collection)
    return error_reply(404, "no_collection", "this exhibit has no collection");
  const MapQuestion asked = read_map_question(question.query);
  if (!asked.problem.empty()) return error_reply(400, "bad_parameter", asked.problem);
  return {};
}

HttpReply answer_map(const ServedExhibit& sources) {
  if (!sources.walk_map)
    return error_reply(404, "no_map", "visitors of this exhibit fly: there is no ground to map");
  HttpReply reply;
  reply.headers["Cache-Control"] = "public, max-age=60";
  reply.body = describe_map(*sources.exhibit, *sources.walk_map);
  return reply;
}

// A person's browser, not a program that reads JSON.
bool prefers_html(const std::string& accept) {
  const size_t html = accept.find("text/html"), json = accept.find("application/json");
  return html != std::string::npos && (json == std::string::npos || html < json);
}

HttpReply answer_page(const PageFile& page, const HttpQuestion& question) {
  HttpReply reply;
  reply.content_type = page.content_type;
  reply.headers["ETag"] = page.etag;
  reply.headers["Cache-Control"] = "no-cache";
  reply.body = page.body;
  reply.gzip = page.gzip;
  return reply;
}

const ServedExhibit* find_exhibit(const AnswerSources& sources, const std::string& id) {
  auto found = std::ranges::find_if(
      sources.exhibits, [&](const ServedExhibit& one) { return one.exhibit->id == id; });
  return found == sources.exhibits.end() ? nullptr : &*found;
}

// Tells browsers not to keep a reply that may change.
HttpReply fresh(HttpReply reply, const AnswerSources& sources) {
  if (sources.changes) reply.headers["Cache-Control"] = "no-store";
  return reply;
}

HttpReply answer_exhibit(const AnswerSources& sources, const HttpQuestion& question,
                         const std::string& rest) {
  const std::string id = rest.substr(0, rest.find('/')), tail = rest.substr(id.size());
  const ServedExhibit* served = find_exhibit(sources, id);
  if (!served) return error_reply(404, "unknown_exhibit", "there is no exhibit '" + id + "' here");
  if (tail.empty() || tail == "/") return json_reply(describe(*served->exhibit));
  if (tail == "/transcript") return json_reply(describe_transcript(*served->exhibit));
  if (tail == "/collection") return answer_collection(*served, question);
  if (const auto record = read_picture_path(tail)) {
    if (!collection_picture(*served->exhibit, *record).empty()) return {};
    return error_reply(404, "no_picture", "there is no picture of such a record");
  }
  if (tail == "/map") return fresh(answer_map(*served), sources);
  if (tail == "/qr.svg") return answer_qr(*served->exhibit, served->address, question);
  if (tail == "/still.jpg") return fresh(answer_still(*served, question), sources);
  if (const ServedFile* file = find_served_file(*served->exhibit, tail)) return answer_file(*file);
  return error_reply(404, "not_found", "there is no '" + tail + "' in an exhibit");
}

// The recognition tree of the kiosk of that name; without a name, of the only one that has a tree.
HttpReply answer_station(const AnswerSources& sources, const HttpQuestion& question) {
  const auto asked = question.query.find("kiosk");
  const std::string name = asked == question.query.end() ? "" : asked->second;
  std::vector<const ServedFile*> found;
  for (const ServedExhibit& one : sources.exhibits)
    for (const KioskSettings& kiosk : one.exhibit->kiosks)
      if (!kiosk.station.empty() && (name.empty() || kiosk.name == name))
        found.push_back(&one.exhibit->files.at(kiosk.station));
  if (found.size() == 1 || (!found.empty() && !name.empty())) return answer_file(*found.front());
  return error_reply(404, "no_station", "no kiosk of that name has a recognition tree");
}

// Lists the exhibits. Only a technician learns why some failed, since the reasons name files.
HttpReply answer_exhibits(const AnswerSources& sources, const Access& access) {
  json all = {{"exhibits", json::array()}, {"failed", json::array()}};
  for (const ServedExhibit& one : sources.exhibits)
    all["exhibits"].push_back(describe(*one.exhibit));
  for (const FailedExhibit& one : sources.failed)
    all["failed"].push_back(
        {{"id", one.id}, {"problems", access.status ? one.problems : std::vector<std::string>{}}});
  return json_reply(all);
}

HttpReply answer_metrics(const AnswerSources& sources) {
  HttpReply reply;
  reply.content_type = "text/plain; version=0.0.4; charset=utf-8";
  reply.headers["Cache-Control"] = "no-store";
  std::vector<std::pair<std::string, std::string>> texts;
  for (const ServedExhibit& one : sources.exhibits)
    texts.push_back({one.exhibit->id, write_metrics(one.board->read())});
  reply.body = texts.size() == 1 ? texts.front().second : join_metrics(texts);
  reply.body += failure_metrics(sources.failed);
  reply.body += store_metrics(shared_store()->stats());
  if (sources.stills) reply.body += still_metrics(sources.stills->status());
  if (sources.stream_metrics) reply.body += sources.stream_metrics();
  return reply;
}

// Returns the page of a path; null: there is none. A server of several exhibits lists them at "/",
// and each has the visitor's page at /e/ID and at /?exhibit=ID.
const PageFile* find_page(const AnswerSources& sources, const HttpQuestion& question) {
  const std::string& path = question.path;
  const auto asked = question.query.find("exhibit");
  const bool is_one = asked != question.query.end() && find_exhibit(sources, asked->second);
  const std::string below = "/e/";
  std::string name = path;
  if (path == "/" && sources.exhibits.size() > 1 && !is_one) name = "/front.html";
  if (path.starts_with(below))
    name = find_exhibit(sources, path.substr(below.size())) ? exhibit_page : "";
  auto page = sources.pages->find(name);
  return page == sources.pages->end() ? nullptr : &page->second;
}

// How the server is: for who has Access::status. Empty: the path is another.
std::optional<HttpReply> answer_status(const AnswerSources& sources, const Access& access,
                                       const HttpQuestion& question) {
  const std::string& path = question.path;
  const bool known = path == "/metrics" || path == "/api/v1/status" || path == "/api/v1/speeds" ||
                     path == "/api/v1/sums.csv";
  if (!known) return {};
  if (!access.status) return refuse_access(access);
  if (path == "/metrics") return answer_metrics(sources);
  if (path == "/api/v1/status" && sources.status) return text_reply(sources.status());
  if (path == "/api/v1/speeds" && sources.speeds) return text_reply(sources.speeds());
  if (path == "/api/v1/sums.csv" && sources.sums) return sources.sums(question);
  return {};
}

}  // namespace

HttpReply answer_while_loading(const std::map<std::string, PageFile>& pages,
                               const HttpQuestion& question) {
  HttpReply reply =
      error_reply(503, "loading", "the museum is opening; please come back in a moment");
  if (question.path == "/healthz") return json_reply({{"status", "loading"}}, 503);
  const auto found = pages.find(question.path), opening = pages.find("/opening.html");
  if (found != pages.end() && !found->second.content_type.starts_with("text/html"))
    return answer_page(found->second, question);
  if (opening != pages.end() && prefers_html(question.accept)) {
    reply.content_type = opening->second.content_type;
    reply.body = opening->second.body;
  }
  reply.headers["Retry-After"] = "2";
  return reply;
}

bool answer_later(const AnswerSources& sources, const HttpQuestion& question,
                  const std::shared_ptr<HttpAsker>& asker) {
  const std::string before = "/api/v1/exhibits/";
  const std::string& path = question.path;
  if (question.method != "GET" || !path.starts_with(before)) return false;
  const size_t end = path.find('/', before.size());
  const ServedExhibit* served =
      find_exhibit(sources, path.substr(before.size(), end - before.size()));
  if (!served || end == std::string::npos) return false;
  if (path.substr(end) == "/collection" && sources.maps && served->exhibit->collection) {
    const MapQuestion asked = read_map_question(question.query);
    if (!asked.problem.empty()) return false;
    sources.maps->ask(*served->exhibit, asked, asker);
    return true;
  }
  if (const auto record = read_picture_path(path.substr(end)); record && sources.pictures) {
    const std::string picture = collection_picture(*served->exhibit, *record);
    if (picture.empty()) return false;
    sources.pictures->ask(picture, served->exhibit->allowed_hosts, asker);
    return true;
  }
  if (path.substr(end) != "/still.jpg" || !sources.stills) return false;
  const StillQuestion asked = read_still_question(*served->exhibit, question.query);
  if (asked.status != 200) return false;
  const bool changes = sources.changes;
  sources.stills->ask(*served->stills, asked.job,
                      {.take =
                           [asker, changes](StillOutcome outcome) {
                             HttpReply reply = still_reply(std::move(outcome));
                             if (changes) reply.headers["Cache-Control"] = "no-store";
                             asker->answer(std::move(reply));
                           },
                       .gone = [asker] { return asker->gone(); },
                       .address = question.address});
  return true;
}

HttpReply answer(const AnswerSources& sources, const HttpQuestion& question) {
  const std::string& path = question.path;
  if (path == "/healthz" && sources.drains && sources.drains())
    return json_reply({{"status", "draining"}}, 503);
  const Access access = access_of(sources.access, question);
  if (path == "/healthz") {
    bool ready = std::ranges::all_of(
        sources.exhibits, [](const ServedExhibit& one) { return one.board->read().ready; });
    return json_reply({{"status", ready ? "ok" : "starting"}}, ready ? 200 : 503);
  }
  if (auto reply = answer_status(sources, access, question)) return std::move(*reply);
  if (path == "/api/v1/" || path == "/api/v1") {
    HttpReply reply;
    reply.body = describe_api();
    return reply;
  }
  if (path == "/api/v1/admin/announce") return answer_announce(sources.desk, access, question);
  if (path == "/api/v1/station") return answer_station(sources, question);
  const std::string exhibits = "/api/v1/exhibits";
  if (path == exhibits || path == exhibits + "/") return answer_exhibits(sources, access);
  if (path.starts_with(exhibits + "/"))
    return answer_exhibit(sources, question, path.substr(exhibits.size() + 1));
  if (path.starts_with("/iiif/")) {
    const auto find = [&](const std::string& id) {
      const ServedExhibit* one = find_exhibit(sources, id);
      return one ? IiifExhibit{one->exhibit, one->address} : IiifExhibit{};
    };
    return answer_iiif({find, sources.changes}, question);
  }
  if (const PageFile* page = find_page(sources, question)) return answer_page(*page, question);
  if (auto page = sources.pages->find("/missing.html");
      page != sources.pages->end() && prefers_html(question.accept)) {
    HttpReply reply = answer_page(page->second, question);
    reply.status = 404;
    reply.headers["Vary"] = "Accept";
    return reply;
  }
  return error_reply(404, "not_found", "there is nothing at " + path);
}

}  // namespace wellspring::show
