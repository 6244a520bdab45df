// SPDX-License-Identifier: Apache-2.0
#include "show/answer/answer.h"

#include <charconv>
#include <nlohmann/json.hpp>
#include <optional>

namespace wellspring {

using nlohmann::json;

namespace {

constexpr int max_still_side = 3840;
constexpr int max_still_spp = 1024;
constexpr double max_still_work =
    1920.0 * 1080 * 256;  // pixels times samples: minutes at the worst

HttpReply json_reply(const json& body, int status = 200) {
  HttpReply reply;
  reply.status = status;
  reply.body = body.dump(-1, ' ', false, json::error_handler_t::replace);
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
                {"viewpoints", json::array()},
                {"stories", json::array()},
                {"tours", json::array()},
                {"objects", json::array()}};
  for (const ExhibitViewpoint& viewpoint : exhibit.viewpoints)
    about["viewpoints"].push_back(
        {{"name", viewpoint.view.name},
         {"title", viewpoint.title},
         {"position",
          {viewpoint.view.position.x, viewpoint.view.position.y, viewpoint.view.position.z}},
         {"yaw", viewpoint.view.yaw},
         {"pitch", viewpoint.view.pitch},
         {"fov", viewpoint.view.fov}});
  for (const StoryText& story : exhibit.stories) {
    json& entry = about["stories"].emplace_back(json{{"id", story.id}, {"title", story.title}});
    if (story.storyteller_index >= 0)
      entry["teller"] = exhibit.storytellers[size_t(story.storyteller_index)].id;
  }
  for (const TourPlan& tour : exhibit.tours)
    about["tours"].push_back(
        {{"id", tour.id}, {"title", tour.title}, {"stops", tour.stops.size()}});
  for (const PointOfInterest& point : exhibit.points)
    about["objects"].push_back({{"id", point.id}, {"title", point.title}});
  about["lamps"] = json::array();
  for (const ExhibitLamp& lamp : exhibit.lamps)
    about["lamps"].push_back({{"name", lamp.id}, {"title", lamp.title}, {"on_at_first", lamp.on}});
  about["storyteller"] =
      exhibit.storytellers.empty() ? json(nullptr) : json(exhibit.storytellers.front().name);
  about["storytellers"] = json::array();
  for (const StorytellerPlace& storyteller_place : exhibit.storytellers)
    about["storytellers"].push_back(
        {{"id", storyteller_place.id}, {"name", storyteller_place.name}});
  about["start"] = exhibit.viewpoints[size_t(exhibit.start)].view.name;
  return about;
}

// A whole number in [low, high]; empty with `reply` set when it is not one.
std::optional<int> number_of(const HttpQuestion& question, const char* name, int otherwise, int low,
                             int high, HttpReply& reply) {
  auto found = question.query.find(name);
  if (found == question.query.end() || found->second.empty()) return otherwise;
  const std::string& text = found->second;
  int value = 0;
  auto [end, ec] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (ec == std::errc() && end == text.data() + text.size() && value >= low && value <= high)
    return value;
  reply = error_reply(400, "bad_parameter",
                      std::string(name) + ": must be a whole number from " + std::to_string(low) +
                          " to " + std::to_string(high));
  return {};
}

HttpReply answer_still(const AnswerSources& sources, const HttpQuestion& question) {
  const Exhibit& exhibit = *sources.exhibit;
  HttpReply reply;
  StillJob order;
  order.viewpoint = exhibit.start;
  if (auto name = question.query.find("viewpoint");
      name != question.query.end() && !name->second.empty()) {
    order.viewpoint = find_viewpoint(exhibit, name->second);
    if (order.viewpoint < 0)
      return error_reply(404, "unknown_viewpoint", "there is no viewpoint '" + name->second + "'");
  }
  auto width = number_of(question, "width", order.width, 1, max_still_side, reply);
  if (!width) return reply;
  auto height = number_of(question, "height", order.height, 1, max_still_side, reply);
  if (!height) return reply;
  auto spp = number_of(question, "spp", order.spp, 1, max_still_spp, reply);
  if (!spp) return reply;
  auto denoise = number_of(question, "denoise", 1, 0, 1, reply);
  if (!denoise) return reply;
  order.width = *width;
  order.height = *height;
  order.spp = *spp;
  order.denoise = *denoise == 1;
  if (double(order.width) * order.height * order.spp > max_still_work)
    return error_reply(400, "too_much_work",
                       "width * height * spp may be at most 1920 * 1080 * 256");
  reply.content_type = "image/jpeg";
  reply.headers["Cache-Control"] = "public, max-age=60";
  if (question.method != "HEAD") reply.body = sources.make_still(order);
  return reply;
}

HttpReply answer_page(const PageFile& page, const HttpQuestion& question) {
  HttpReply reply;
  reply.content_type = page.content_type;
  reply.headers["ETag"] = page.etag;
  reply.headers["Cache-Control"] = "no-cache";
  reply.body = page.body;
  return reply;
}

}  // namespace

HttpReply answer(const AnswerSources& sources, const HttpQuestion& question) {
  const std::string& path = question.path;
  if (path == "/healthz") {
    bool ready = sources.board->read().ready;
    return json_reply({{"status", ready ? "ok" : "starting"}}, ready ? 200 : 503);
  }
  if (path == "/metrics") {
    HttpReply reply;
    reply.content_type = "text/plain; version=0.0.4; charset=utf-8";
    reply.headers["Cache-Control"] = "no-store";
    reply.body = write_metrics(sources.board->read());
    if (sources.stream_metrics) reply.body += sources.stream_metrics();
    return reply;
  }
  if (path == "/api/v1/" || path == "/api/v1") {
    HttpReply reply;
    reply.body = describe_api();
    return reply;
  }
  const std::string exhibits = "/api/v1/exhibits";
  if (path == exhibits || path == exhibits + "/")
    return json_reply({{"exhibits", json::array({describe(*sources.exhibit)})}});
  if (path.starts_with(exhibits + "/")) {
    std::string rest = path.substr(exhibits.size() + 1), id = rest.substr(0, rest.find('/'));
    std::string tail = rest.substr(id.size());
    if (id != sources.exhibit->id)
      return error_reply(404, "unknown_exhibit", "there is no exhibit '" + id + "' here");
    if (tail.empty() || tail == "/") return json_reply(describe(*sources.exhibit));
    if (tail == "/still.jpg") return answer_still(sources, question);
    return error_reply(404, "not_found", "there is no '" + tail + "' in an exhibit");
  }
  if (auto page = sources.pages->find(path); page != sources.pages->end())
    return answer_page(page->second, question);
  return error_reply(404, "not_found", "there is nothing at " + path);
}

}  // namespace wellspring
