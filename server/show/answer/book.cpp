// SPDX-License-Identifier: Apache-2.0
#include "show/answer/book.h"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string_view>

namespace wellspring::show {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr std::string_view files = "/files/";

// Names are of characters that stand in an address as they are (exhibit/media_file.cpp).
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

}  // namespace wellspring::show
