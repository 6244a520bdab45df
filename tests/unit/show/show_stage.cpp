// SPDX-License-Identifier: Apache-2.0
#include "unit/show/show_stage.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "image/image.h"
#include "show/draw/picture.h"
#include "show/state/renderer.h"
#include "show/state/make_show.h"
#include "show/tick.h"

namespace wellspring::test {

using nlohmann::json;

ShowSettings settings_for(const std::string& technique, float fps) {
  ShowSettings settings;
  settings.technique = technique;
  settings.still_technique = technique == "gather" ? "path" : technique;
  settings.fps = fps;
  return settings;
}

void ShowStage::begin(Exhibit exhibit, const ShowSettings& settings) {
  show = make_show(std::move(exhibit), settings);
}

size_t ShowStage::connect() {
  size_t number = browsers.size();
  Browser& browser = browsers.emplace_back();
  browser.link = std::make_shared<Link>(number + 1, LinkKind::visit, "test");
  browser.link->local = true;
  arrivals.put(browser.link);
  return number;
}

size_t ShowStage::join(int width, int height, const std::string& lang, const std::string& role) {
  size_t number = connect();
  say(json{{"type", "hello"},
           {"exhibit", ""},
           {"width", width},
           {"height", height},
           {"lang", lang},
           {"role", role}}
          .dump(),
      number);
  return number;
}

void ShowStage::say(const std::string& text, size_t visitor) {
  browsers[visitor].link->push_text_in(text);
}

void ShowStage::turn(double yaw, double forward, size_t visitor) {
  say(json{{"type", "input"}, {"seq", ++seq}, {"move", {0, 0, forward}}, {"look", {yaw, 0}}}.dump(),
      visitor);
}

void ShowStage::step(double seconds) {
  tick(*show, arrivals, now += seconds);
  for (Visitor& visitor : show->visits.visitors) visitor.shown.encoder->task.wait();
  show->drawing->renderer.worker.wait();
  take_sent();
}

void ShowStage::step_on() {
  tick(*show, arrivals, now += tick_seconds);
  for (Visitor& visitor : show->visits.visitors) visitor.shown.encoder->task.wait();
  take_sent();
}

void ShowStage::steps(int count) {
  for (int i = 0; i < count; i++) step();
}

void ShowStage::run(double seconds) { steps(int(std::ceil(seconds / tick_seconds - 1e-6))); }

void ShowStage::order(const std::string& text, size_t visitor) {
  say(text, visitor);
  run(0.1);
}

void ShowStage::draw_all(const PictureJob& job, Visitor& visitor) {
  for (DrawingStep step = DrawingStep::plan; step != DrawingStep::done;)
    step = draw_step(*show, job, step, visitor);
}

void ShowStage::take_sent() {
  for (Browser& browser : browsers)
    for (Link::Out out; browser.reads && browser.link->take_out(out);) {
      if (!out.binary) {
        browser.texts.push_back(out.text);
      } else if (!out.picture) {
        browser.sounds.push_back(*out.packet);
      } else {
        browser.pictures.push_back(*out.packet);
        if (!browser.acknowledges) continue;
        browser.link->push_text_in(json{
            {"type", "ack"},
            {"frame", read_packet(*out.packet)->header.frame},
            {"decoded_ms", 1},
            {"shown", true}}.dump());
      }
    }
}

PacketHeader ShowStage::header(size_t picture) { return read_packet(pictures()[picture])->header; }

Image8 ShowStage::image(size_t picture) {
  return decode_jpeg(read_packet(pictures()[picture])->payload, "picture");
}

PacketHeader ShowStage::last_header() { return header(pictures().size() - 1); }

Image8 ShowStage::last_image(size_t visitor) {
  return decode_jpeg(read_packet(pictures(visitor).back())->payload, "picture");
}

std::vector<json> ShowStage::told(const std::string& type, size_t visitor) {
  std::vector<json> found;
  for (const std::string& text : browsers[visitor].texts) {
    json message = json::parse(text);
    if (message["type"] == type) found.push_back(std::move(message));
  }
  return found;
}

json ShowStage::last(const std::string& type, size_t visitor) {
  std::vector<json> found = told(type, visitor);
  return found.empty() ? json() : found.back();
}

Image8 ShowStage::truth(const View& view, int samples) {
  StillSettings settings;
  settings.spp = samples;
  settings.transport = show->settings.transport;
  Image8 picture;
  tonemap(render_still(*show->stage.still_technique, *show->stage.world, show->stage.lights, view,
                       settings),
          Tonemap{show->stage.exhibit.exposure}, picture);
  return picture;
}

double mean_difference(const Image8& a, const Image8& b) {
  EXPECT_EQ(a.rgb.size(), b.rgb.size());
  double sum = 0;
  for (size_t i = 0; i < std::min(a.rgb.size(), b.rgb.size()); i++)
    sum += std::abs(int(a.rgb[i]) - int(b.rgb[i]));
  return sum / double(a.rgb.size());
}

}  // namespace wellspring::test
