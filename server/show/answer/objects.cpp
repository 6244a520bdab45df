// SPDX-License-Identifier: Apache-2.0
#include "show/answer/objects.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string_view>

#include "show/exhibit/exhibit_objects.h"

namespace wellspring::show {

using nlohmann::json;

namespace {

constexpr int most_map_cells = 240;  // a side

json rounded(dvec3 v) {
  auto round = [](double x) { return std::round(x * 1e3) / 1e3; };
  return json::array({round(v.x), round(v.y), round(v.z)});
}

// `say`: what becomes of a text in languages.
template <class Say>
json describe(const PointOfInterest& point, const Say& say) {
  json about = {{"id", point.id}, {"title", say(point.title)}, {"position", rounded(point.place)}};
  if (!point.text.empty()) about["text"] = say(point.text);
  if (!point.story.empty()) about["story"] = point.story;
  if (!point.manifest.empty()) about["manifest"] = point.manifest;
  if (point.around) about["around"] = true;
  if (!point.door.exhibit.empty()) {
    about["door"] = {{"exhibit", point.door.exhibit}};
    if (!point.door.viewpoint.empty()) about["door"]["viewpoint"] = point.door.viewpoint;
  }
  if (point.provenance.empty()) return about;
  json& facts = about["provenance"] = json::array();
  for (const char* element : provenance_elements)
    if (auto found = point.provenance.find(element); found != point.provenance.end())
      facts.push_back({{"element", element}, {"value", say(found->second)}});
  return about;
}

}  // namespace

json describe_objects(const Exhibit& exhibit) {
  json objects = json::array();
  for (const PointOfInterest& point : exhibit.points) {
    json& about =
        objects.emplace_back(describe(point, [](const LocalText& text) { return json(text); }));
    const auto piece = std::ranges::find(exhibit.pieces, point.id, &ExhibitPiece::id);
    if (piece == exhibit.pieces.end() || piece->layers.size() < 2) continue;
    for (const PieceLayer& layer : piece->layers) {
      if (layer.label.empty()) continue;
      json& one = about["layers"].emplace_back(json{{"id", layer.id}, {"label", layer.label}});
      if (!layer.text.empty()) one["text"] = layer.text;
      if (layer.year) one["year"] = *layer.year;
    }
  }
  return objects;
}

json describe_objects(const Exhibit& exhibit, const std::string& lang) {
  json objects = json::array();
  for (const PointOfInterest& point : exhibit.points) {
    if (point.title.empty()) continue;
    objects.push_back(describe(point, [&](const LocalText& text) {
      return json(text_in(text, lang, exhibit.languages));
    }));
  }
  return objects;
}

std::string describe_map(const Exhibit& exhibit, const WalkMap& map) {
  // Only as much as there is ground on, in cells that are not too many.
  ivec2 low(map.width, map.depth), high(-1);
  for (int z = 0; z < map.depth; z++)
    for (int x = 0; x < map.width; x++) {
      if (map.column[size_t(z) * size_t(map.width) + size_t(x)] < 0) continue;
      low = min(low, ivec2(x, z));
      high = max(high, ivec2(x, z));
    }
  const ivec2 size = max(high - low + 1, ivec2(0));
  const int scale = std::max(1, (std::max(size.x, size.y) + most_map_cells - 1) / most_map_cells);
  const ivec2 cells = (size + scale - 1) / scale;
  std::vector<std::string> rows(size_t(cells.y), std::string(size_t(cells.x), '.'));
  for (int z = 0; z < size.y; z++)
    for (int x = 0; x < size.x; x++) {
      char& cell = rows[size_t(z / scale)][size_t(x / scale)];
      int p = map.column[size_t(low.y + z) * size_t(map.width) + size_t(low.x + x)];
      for (; p >= 0; p = map.place_after[size_t(p)])
        if (cell != 'o') cell = map.places[size_t(p)].clear >= map.radius ? 'o' : 'x';
    }
  const float middle = 0.5f * float(scale - 1);  // middle of a cell's places
  const dvec3 corner =
      exhibit.scene.origin +
      dvec3(map.corner + map.cell * vec3(float(low.x) + middle, 0, float(low.y) + middle));
  json about = {{"cell", map.cell * float(scale)}, {"corner", {corner.x, corner.z}},
                {"eye_height", map.eye_height},    {"rows", rows},
                {"viewpoints", json::array()},     {"objects", json::array()}};
  for (const ExhibitViewpoint& viewpoint : exhibit.viewpoints)
    about["viewpoints"].push_back({{"name", viewpoint.view.name},
                                   {"position", rounded(viewpoint.view.position)},
                                   {"yaw", viewpoint.view.yaw}});
  for (const PointOfInterest& point : exhibit.points)
    about["objects"].push_back({{"id", point.id}, {"position", rounded(point.place)}});
  return about.dump(-1, ' ', false, json::error_handler_t::replace);
}

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr std::string_view files = "/files/";

// Names are of characters that stand in an address as they are (show/exhibit/exhibit_files.cpp).
std::string address_of(const Exhibit& exhibit, const std::string& file) {
  return "/api/v1/exhibits/" + exhibit.id + std::string(files) + file;
}

// Fields that have nothing to say are left out.
struct Describer {
  const Exhibit& exhibit;
  json about = json::object();

  Describer& text(const char* name, const LocalText& text) {
    if (!text.empty()) about[name] = text;
    return *this;
  }
  Describer& file(const char* name, const std::string& file) {
    if (!file.empty()) about[name] = address_of(exhibit, file);
    return *this;
  }
};

json describe_page(const Exhibit& exhibit, const BookPage& page) {
  Describer describer{exhibit, {{"id", page.id}, {"title", page.title}, {"text", page.text}}};
  describer.file("image", page.image).text("alt", page.alt).text("credit", page.credit);
  if (!page.link.empty()) describer.about["link"] = page.link;
  return describer.about;
}

json describe_slide(const Exhibit& exhibit, const BookSlide& slide) {
  Describer describer{exhibit, {{"seconds", slide.seconds}}};
  describer.text("title", slide.title).text("text", slide.text).text("alt", slide.alt);
  return describer.file("image", slide.image).file("video", slide.video).about;
}

}  // namespace

json describe_book(const Exhibit& exhibit) {
  if (!exhibit.book) return nullptr;
  json about = {
      {"topics", json::array()}, {"partners", json::array()}, {"presentations", json::array()}};
  for (const BookPage& topic : exhibit.book->topics)
    about["topics"].push_back(describe_page(exhibit, topic));
  for (const BookPage& partner : exhibit.book->partners)
    about["partners"].push_back(describe_page(exhibit, partner));
  for (const BookPresentation& presentation : exhibit.book->presentations) {
    json slides = json::array();
    for (const BookSlide& slide : presentation.slides)
      slides.push_back(describe_slide(exhibit, slide));
    about["presentations"].push_back(
        {{"id", presentation.id}, {"title", presentation.title}, {"slides", std::move(slides)}});
  }
  return about;
}

json describe_sounds(const Exhibit& exhibit) {
  json sounds = json::array();
  for (const AmbientSound& sound : exhibit.sounds) {
    Describer describer{exhibit,
                        {{"id", sound.id}, {"gain", sound.gain}, {"radius", sound.radius}}};
    describer.file("file", sound.file);
    if (!sound.kind.empty()) describer.about["kind"] = sound.kind;
    if (sound.position)
      describer.about["position"] = {sound.position->x, sound.position->y, sound.position->z};
    sounds.push_back(std::move(describer.about));
  }
  return sounds;
}

std::string poster_address(const Exhibit& exhibit) {
  if (!exhibit.poster.empty()) return address_of(exhibit, exhibit.poster);
  return "/api/v1/exhibits/" + exhibit.id + "/still.jpg?width=640&height=360&spp=4";
}

const ServedFile* find_served_file(const Exhibit& exhibit, const std::string& tail) {
  if (!tail.starts_with(files)) return nullptr;
  auto found = exhibit.files.find(tail.substr(files.size()));
  return found == exhibit.files.end() ? nullptr : &found->second;
}

HttpReply answer_file(const ServedFile& file) {
  HttpReply reply;
  std::error_code ec, ec2;
  bool same = fs::file_size(file.path, ec) == file.bytes &&
              fs::last_write_time(file.path, ec2).time_since_epoch().count() == file.changed;
  if (ec || ec2 || !same) {
    reply.status = 404;
    reply.headers["Cache-Control"] = "no-store";
    reply.body =
        json{{"error", {{"code", "file_changed"}, {"message", "the file is not what it was"}}}}
            .dump();
    return reply;
  }
  reply.content_type = file.type;
  reply.headers["ETag"] = file.etag;
  reply.headers["Cache-Control"] = "no-cache";
  reply.file = FilePart{file.path, 0, file.bytes};
  return reply;
}

using nlohmann::json;

namespace {

json sentences(const LocalScript& script) {
  json all = json::object();
  for (const auto& [lang, lines] : script) {
    json& of = all[lang] = json::array();
    for (const StoryLine& line : lines) of.push_back(line.text);
  }
  return all;
}

}  // namespace

json describe_transcript(const Exhibit& exhibit) {
  json stories = json::array(), tours = json::array();
  for (const StoryText& story : exhibit.stories) {
    stories.push_back({{"id", story.id}, {"title", story.title}, {"text", sentences(story.text)}});
    if (story.storyteller_index >= 0)
      stories.back()["teller"] = exhibit.storytellers[size_t(story.storyteller_index)].name;
  }
  for (const TourPlan& tour : exhibit.tours) {
    json stops = json::array();
    for (const TourStop& stop : tour.stops)
      stops.push_back({{"title", exhibit.viewpoints[size_t(stop.viewpoint)].title},
                       {"way_text", sentences(stop.way_text)},
                       {"text", sentences(stop.text)}});
    tours.push_back({{"id", tour.id}, {"title", tour.title}, {"stops", stops}});
  }
  return {{"stories", stories}, {"tours", tours}};
}

}  // namespace wellspring::show
