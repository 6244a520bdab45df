// SPDX-License-Identifier: Apache-2.0
// A show without sockets on a clock of the test's own, and visitors whose browsers the test plays.
#pragma once
#include <nlohmann/json_fwd.hpp>

#include "frame/tonemap.h"
#include "show/state/arrivals.h"
#include "show/state/renderer.h"
#include "show/state/show.h"
#include "unit/show/tiny_exhibit.h"
#include "wire/packet.h"

namespace wellspring::test {

// Pictures at rest are drawn by the same technique, but after "gather" by "path".
ShowSettings settings_for(const std::string& technique, float fps = 60);

struct Browser {
  std::shared_ptr<Link> link;
  bool reads = true;
  bool acknowledges = false;  // pictures
  // These packets and texts the browser has read.
  std::vector<Packet> pictures, sounds;
  std::vector<std::string> texts;
};

struct ShowStage {
  Arrivals arrivals;
  std::vector<Browser> browsers;  // in the order in which they came; visitors' numbers below
  double tick_seconds = 0.02;
  double now = 0;              // time of the last tick
  uint32_t seq = 0;            // number of the last turn()
  std::unique_ptr<Show> show;  // the last member: its renderer may be at work

  void begin(Exhibit exhibit, const ShowSettings& settings);
  size_t connect();  // without a word; the visitor's number
  size_t join(int width, int height, const std::string& lang = "en",
              const std::string& role = "visitor");
  void say(const std::string& text, size_t visitor = 0);
  void turn(double yaw, double forward = 0, size_t visitor = 0);

  // Goes a tick on, and waits for the encoders. The renderer's work is finished by then, too, but
  // in step_on() it may go on.
  void step() { step(tick_seconds); }
  void step(double seconds);
  void step(bool) = delete;
  void step_on();
  void steps(int count);
  void run(double seconds);                                 // as many steps as that takes
  void order(const std::string& text, size_t visitor = 0);  // says it and gives it 0.1 s
  // False: the condition never held.
  template <class Condition>
  bool step_until(const Condition& holds, int most = 2000) {
    while (most-- > 0 && !holds()) step();
    return holds();
  }
  // Draws a picture in all its steps at once.
  void draw_all(const PictureJob& job, Visitor& visitor);
  void take_sent();  // by every browser that reads; a step ends with it

  // The first, who has come with the first tick after join().
  Visitor& visitor() {
    if (show->visits.visitors.empty()) step();
    return show->visits.visitors.front();
  }
  const std::vector<Packet>& pictures(size_t visitor = 0) { return browsers[visitor].pictures; }
  PacketHeader header(size_t picture);  // the first visitor's
  Image8 image(size_t picture);
  PacketHeader last_header();
  Image8 last_image(size_t visitor = 0);
  // Texts of a type; the last is null where there is none.
  std::vector<nlohmann::json> told(const std::string& type, size_t visitor = 0);
  nlohmann::json last(const std::string& type, size_t visitor = 0);
  // Returns a view's picture by `samples` a pixel, as it is shown.
  Image8 truth(const View& view, int samples);
};

double mean_difference(const Image8& a, const Image8& b);

}  // namespace wellspring::test
