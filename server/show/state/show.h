// SPDX-License-Identifier: Apache-2.0
// Holds one running exhibit as values: the world, its storyteller, the visitors and the kiosks'
// eyes. make_show() (show/state/make_show.h) begins it, tick() (show/tick.h) advances it.
// Everything here belongs to the thread that calls tick(), except Arrivals, and what the renderer
// is at work on.
#pragma once
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "ledger/sums.h"
#include "light/kept/skin_light.h"
#include "light/technique/technique.h"
#include "light/visible/visibility.h"
#include "picture/warp_picture.h"
#include "show/exhibit/exhibit.h"
#include "show/exhibit/json_fields.h"
#include "show/house/house.h"
#include "show/kiosk/kiosk.h"
#include "show/moving/exhibit_scene.h"
#include "show/moving/figure.h"
#include "show/moving/prop.h"
#include "show/questions/question_index.h"
#include "show/state/baker.h"
#include "show/state/renderer.h"
#include "show/state/switches.h"
#include "show/state/visitor.h"
#include "show/storyteller/audience.h"
#include "wire/tokens.h"

namespace wellspring::show {

// Holds what a running show counts: for the report, the metrics and the log.

// All are counters since the start, unless said otherwise.
struct ShowTotals {
  // pictures drawn, pictures warped, warps given up
  uint64_t drawn = 0, warped = 0, unwarpable = 0;
  uint64_t posed = 0;           // drawings of moving things by themselves, over pictures at rest
  uint64_t reconstructed = 0;   // pictures at rest that the network made
  float reconstruction_ms = 0;  // milliseconds of the last of these
  uint64_t surroundings = 0;    // surroundings drawn for quick turns
  uint64_t given_up = 0;        // pictures that nobody needed any more before they were drawn
  uint64_t pictures = 0, picture_bytes = 0, samples = 0, messages = 0, refused_messages = 0;
  // orders left out, since newer ones of the same visitor came before their turn
  uint64_t orders_left_out = 0;
  float tick_ms = 0, animate_ms = 0;  // milliseconds of the last tick
  uint64_t utterances = 0, sounds = 0,
           // utterances spoken; packets sent; dropped: too slow a reader
      sounds_given_up = 0;
  uint64_t visits = 0, observations = 0, greetings = 0, farewells = 0, stories = 0;
  uint64_t gestures = 0;  // gestures of guests that were followed
  uint64_t lamps_switched = 0;
  uint64_t announcements = 0;
  uint64_t attention_analyses = 0;
  float attention_ms = 0;  // milliseconds of the last of these
};

// Says how a visitor's pictures get their diffuse light.
enum class Display : uint8_t {
  automatic,  // by illumination maps, if there are any
  points,     // by the points of the visitor's render cache alone
  maps,       // by illumination maps; until there are any, by points
};
inline constexpr const char* display_names[] = {"automatic", "points", "maps"};

struct ShowSettings {
  float fps = 60;                    // pictures a second for a walking visitor, machine permitting
  std::string technique = "gather";  // used while anything moves
  std::string still_technique =
      "path";  // used while the visitor stands still: the picture becomes the reference
  TransportSettings transport{.max_depth = 6, .clamp = 12, .instant = {}, .splat = {}};
  bool background = true;  // pictures are drawn while the show goes on, and warped meanwhile
  // Folder of the networks' weights (denoise/denoise.h); empty: pictures at rest are only drawn.
  std::string weights;
  // Folder for what is found once about an exhibit and kept for the next start; empty: none.
  std::string cache;
  bool bakes = true;  // light is baked while nobody needs the cores, if there is a cache
  Display display = Display::automatic;
  // samples of walking visitors are traced after the picture, for the next
  bool late_samples = true;
  SplatSettings dynamic = dynamic_splat_settings();  // settings for lights that move or change
  float moving_clamp = 4;  // instead of transport.clamp while the visitor moves: fewer fireflies
  int max_pixels = 1920 * 1200;
  HouseSettings house;
  std::vector<Token> kiosk_tokens;  // show/answer/cameras.h
  bool watched = false;  // a curator works at the exhibit: pages show what helps with that
  // Seconds (show/answer/idle.h): without input until visitors are asked whether they are there,
  // and until they have answered; of a hidden page until its visit rests. 0: never.
  double idle_after = 300, idle_answer = 60, hidden_after = 20;
};

// Holds a new visitor's link and seat.
struct Arrival {
  std::shared_ptr<Link> link;
  std::unique_ptr<Seat> seat;  // seat for the visitor's pictures; may be null
};

// Holds new links and announcements, handed over by the threads of the server.
class Arrivals {
 public:
  void put(std::shared_ptr<Link> link, std::unique_ptr<Seat> seat = nullptr);
  std::vector<Arrival> take();
  uint32_t announce(Announcement announcement);  // returns its number
  std::vector<Announcement> take_announcements();

 private:
  std::mutex mutex_;
  std::vector<Arrival> all_;
  std::vector<Announcement> announcements_;
  uint32_t announced_ = 0;
};

// Holds a visit that was broken off and may go on (show/answer/come_back.h).
struct KeptVisit {
  std::string id;              // Visitor::id
  double since = 0;            // show time
  std::list<Visitor> visitor;  // exactly one
};

struct Show {
  ShowSettings settings;
  Exhibit exhibit;  // the scene inside has the figure's materials and object added
  std::unique_ptr<World> world;
  Lights lights;
  Switches switches;
  // While there are lights.maps, for each object:
  std::vector<char> mapped;      // the maps hold the light of some of it
  std::vector<char> shining;     // some of its light depends on the view
  std::vector<char> known;       // mapped and not shining: it needs no samples
  std::string light_problem;     // problem with the package's own light; empty: none
  std::unique_ptr<Baker> baker;  // null: maps stay as they were at the start
  BakerLooks baker_looks;
  std::unique_ptr<VisibilityPass> visibility;  // draws one picture at a time
  SkinLight skin;                              // light on moving things, for all visitors
  const Technique* technique = nullptr;
  const Technique* still_technique = nullptr;

  std::vector<Figure> figures;  // figures of all the exhibit's storytellers; hidden but for one
  std::vector<Prop> props;      // one for each of Exhibit::props; hidden but for what is held
  // the house's storyteller: for kiosks, and for visitors who have none of their own
  Teller teller;
  Movers movers;            // meshes that the exhibit's animations move
  std::vector<Play> plays;  // state of each animation: the house's own, and that of shared ones
  SkinScratch scratch;
  SpeechSource speech;  // empty: the storyteller speaks by subtitles
  // counts all that is heard, the storyteller's utterances and narrators' alike
  uint32_t utterances = 0;
  size_t greetings = 0, farewells = 0;
  std::string kiosk_message;  // last state of all kiosks that visitors were sent
  double drew_at = 0;         // show time when anything was last drawn, traced or lit
  double behaved_at = -1;     // show time when the storyteller was last moved

  TourRoads roads;
  QuestionIndex questions;
  std::list<Visitor> visitors;
  std::list<KeptVisit> kept;         // the visit that was broken off first comes first
  std::shared_ptr<const Seal> seal;  // seals what pages keep of their visits
  // to be taken by whoever keeps resting links: show/answer/idle.h
  std::vector<std::shared_ptr<Link>> resting;
  std::shared_ptr<Capacity> capacity = std::make_shared<Capacity>();  // shared by all exhibits
  std::vector<Eye> eyes;
  std::vector<Kiosk> kiosks;             // show/answer/orders.h
  std::optional<std::string> her_kiosk;  // kiosk whose guests the storyteller is with
  uint64_t her_visits = 0;  // number of kiosk guests' visits that the storyteller has been at

  LocalTime local_time;           // set before a tick by whoever has a clock
  bool others_draw = false;       // likewise: others than this show's visitors need the cores
  HouseState house;               // the house's state at that time
  std::string house_message;      // last message about it that kiosk pages were sent
  Announcement announced;         // the last announcement; id 0: none yet
  double announced_until = -1e9;  // show time

  // If the exhibit is watched: problems with its files as they are now (show/watch/rehearsal.h).
  std::vector<Problem> problems;
  std::string problems_message;  // last message about them that visitors were sent

  Sums sums;  // counted since they were last taken (show/count)

  uint64_t ticks = 0;
  uint64_t pose_number = 1;  // number of the world's pose: counts commits
  // Teller::number of the storyteller whose pose the figures have; none yet
  uint64_t posed_as = ~uint64_t(0);
  // Link::id of the visitor whose own animations the world shows; 0: nobody's
  uint64_t posed_for = 0;
  double time = 0;                    // present tick's time, seconds
  uint64_t time_us = 0;               // present tick's time on the clock of pictures and sound
  float picture_lead = 0.02f;         // seconds from a tick to the times of its pictures, smoothed
  float samples_per_second = 200000;  // measured, of all cores
  ShowTotals totals;
  WarpScratch warp;  // shared by all visitors, whose pictures are warped one after the other
  StillPass pass;
  AttentionAnalysis analysis;  // show/draw/steer.h
  Renderer renderer;           // reads much of the above: ends before it
};

// Returns the visitor whose place, storyteller and lamps this one follows at the moment; null:
// nobody's.
const Visitor* leader_of(const Show& show, const Visitor& visitor);
// Return the storyteller that the visitor sees and hears.
Teller& teller_of(Show& show, Visitor& visitor);
const Teller& teller_of(const Show& show, const Visitor& visitor);
std::vector<Teller*> tellers_of(Show& show);  // the house's storyteller, then visitors' own
// Returns which of the exhibit's storytellers it is; null: the exhibit has none.
const StorytellerPlace* storyteller_of(const Show& show, const Teller& teller);

// Returns the name of the kiosk that a page or a camera means by what it calls itself: without a
// name it belongs to the only kiosk that has one, if there is just one.
std::string kiosk_name(const Show& show, const std::string& said);
const Kiosk* find_kiosk(const Show& show, const std::string& name);  // null: there is none
// Returns the kiosk of a kiosk's page; null: the page is a visitor's.
const Kiosk* kiosk_of(const Show& show, const Visitor& visitor);
// Returns whether the visitor hears the house's storyteller, which is with one kiosk at a time;
// pages of other kiosks neither hear nor read what it says.
bool hears_storyteller(const Show& show, const Visitor& visitor);
// Returns whether what `teller` says is for the visitor.
bool listens_to(const Show& show, const Visitor& visitor, const Teller& teller);

}  // namespace wellspring::show
