// SPDX-License-Identifier: Apache-2.0
// One running exhibit as values: the world, its storyteller, the visitors and the kiosks' eyes.
// make_show() (show/state/make_show.h) begins it, tick() (show/tick.h) advances it. Everything here
// belongs to the thread that calls tick(), except Arrivals, and what the renderer is at work on.
#pragma once
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "avatar/mind/storyteller.h"
#include "light/known/skin_light.h"
#include "light/technique/technique.h"
#include "light/visible/visibility.h"
#include "picture/warp_picture.h"
#include "show/exhibit/exhibit.h"
#include "show/exhibit/figure.h"
#include "show/state/reconstruction.h"
#include "show/state/renderer.h"
#include "show/state/baker.h"
#include "show/state/switches.h"
#include "show/state/totals.h"
#include "show/state/visitor.h"
#include "show/storyteller/audience.h"
#include "show/storyteller/sounding.h"
#include "show/storyteller/voice.h"

namespace wellspring {

// How a visitor's pictures get their diffuse light.
enum class Display : uint8_t {
  automatic,  // by illumination maps, where there are some
  points,     // by the points of the visitor's render cache alone
  maps,       // by illumination maps; until there are some by points
};
inline constexpr const char* display_names[] = {"automatic", "points", "maps"};

struct ShowSettings {
  float fps = 60;                    // pictures a second a walking visitor gets, machine permitting
  int max_visitors = 16;             // more are told to come back
  std::string technique = "gather";  // while anything moves
  std::string still_technique =
      "path";  // while the visitor stands still: the picture becomes the reference
  TransportSettings transport{.max_depth = 6, .clamp = 12, .instant = {}};
  bool background = true;  // pictures are drawn while the show goes on, and warped meanwhile
  // Folder of the networks' weights (denoise/denoise.h); empty: pictures at rest are drawn only.
  std::string weights;
  // Folder for what is found out about an exhibit once and kept for the next start; empty: nothing.
  std::string cache;
  bool bakes = true;  // while nobody needs the cores, where there is a cache
  Display display = Display::automatic;
  bool late_samples = true;  // of who walks are traced behind the picture, for the next
  float moving_clamp = 4;    // instead of transport.clamp while the visitor moves: fewer sparks
  int max_pixels = 1920 * 1200;
};

// New links, handed over by the I/O threads.
class Arrivals {
 public:
  void put(std::shared_ptr<Link> link);
  std::vector<std::shared_ptr<Link>> take();

 private:
  std::mutex mutex_;
  std::vector<std::shared_ptr<Link>> links_;
};

struct Show {
  ShowSettings settings;
  Exhibit exhibit;  // the scene inside has the figure's materials and object added
  std::unique_ptr<World> world;
  Lights lights;
  Switches switches;
  std::vector<char> mapped;      // of each object: lights.maps knows the light of some of it
  std::unique_ptr<Baker> baker;  // null: maps are as they were at the start
  std::unique_ptr<VisibilityPass> visibility;  // one picture at a time
  SkinLight skin;                              // on what moves, for all visitors
  const Technique* technique = nullptr;
  const Technique* still_technique = nullptr;

  // The storyteller: who of the exhibit's is there, and how it is.
  std::vector<Figure> figures;  // of all of them; the others are hidden
  size_t storyteller_index = 0;
  Storyteller storyteller;
  StorytellerState mind;
  Pose pose;
  SkinScratch scratch;
  Voice voice;
  SpeechSource speech;  // empty: the storyteller speaks by subtitles
  Sounding sounding;
  uint32_t utterances = 0;  // numbers of what is heard, the storyteller's and narrators' alike
  size_t greetings = 0, farewells = 0;
  bool storyteller_visible = true, humanlike = true;
  std::string kiosk_message;  // the last kiosk message, to send only changes
  double agent_sent_at = -1e9;
  double drew_at = 0;      // when anything was drawn, samples traced or light found
  double behaved_at = -1;  // when the storyteller was last moved
  Mood agent_mood = Mood::idle;

  TourRoads roads;
  std::list<Visitor> visitors;
  std::vector<Eye> eyes;
  Audience audience;

  uint64_t ticks = 0;
  uint64_t pose_number = 1;           // of the world: counts commits
  double time = 0;                    // of the present tick, seconds
  uint64_t time_us = 0;               // of the present tick on the clock of pictures and sound
  float picture_lead = 0.02f;         // seconds from a tick to the times of its pictures, smoothed
  float samples_per_second = 200000;  // measured, all cores
  ShowTotals totals;
  WarpScratch warp;  // of all visitors, whose pictures are warped one after the other
  StillPass pass;
  AttentionAnalysis analysis;  // show/draw/steer.h
  Renderer renderer;           // reads much of the above: ends before it
};

// Who is there now; null: the exhibit has no storyteller.
const StorytellerPlace* storyteller_of(const Show& show);

}  // namespace wellspring
