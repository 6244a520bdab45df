// SPDX-License-Identifier: Apache-2.0
// One running exhibit as values: the world, its storyteller, the visitors and the kiosks' eyes.
// make_show() (show/state/make_show.h) begins it, tick() (show/tick.h) advances it. Everything here
// belongs to the thread that calls tick(), except Arrivals, and what the renderer is at work on.
#pragma once
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "ledger/sums.h"
#include "light/known/skin_light.h"
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

// What a running show counts: for the report, the metrics and the log.

// Counters since the start, unless said otherwise.
struct ShowTotals {
  uint64_t drawn = 0, warped = 0, unwarpable = 0;  // pictures; warps given up
  uint64_t posed = 0;           // what moves in pictures at rest, drawn by itself
  uint64_t reconstructed = 0;   // pictures at rest, by the network
  float reconstruction_ms = 0;  // of the last of these
  uint64_t surroundings = 0;    // drawn of quick turns
  uint64_t given_up = 0;        // pictures that nobody needed any more before they were drawn
  uint64_t pictures = 0, picture_bytes = 0, samples = 0, messages = 0, refused_messages = 0;
  uint64_t orders_left_out = 0;       // since newer ones of the same visitor came before their turn
  float tick_ms = 0, animate_ms = 0;  // of the last tick
  uint64_t utterances = 0, sounds = 0,
           sounds_given_up = 0;  // spoken; packets sent; too slow a reader
  uint64_t visits = 0, observations = 0, greetings = 0, farewells = 0, stories = 0;
  uint64_t gestures = 0;  // of guests, that were followed
  uint64_t lamps_switched = 0;
  uint64_t announcements = 0;
  uint64_t attention_analyses = 0;
  float attention_ms = 0;  // of the last of these
};

// How a visitor's pictures get their diffuse light.
enum class Display : uint8_t {
  automatic,  // by illumination maps, where there are some
  points,     // by the points of the visitor's render cache alone
  maps,       // by illumination maps; until there are some by points
};
inline constexpr const char* display_names[] = {"automatic", "points", "maps"};

struct ShowSettings {
  float fps = 60;                    // pictures a second a walking visitor gets, machine permitting
  std::string technique = "gather";  // while anything moves
  std::string still_technique =
      "path";  // while the visitor stands still: the picture becomes the reference
  TransportSettings transport{.max_depth = 6, .clamp = 12, .instant = {}, .splat = {}};
  bool background = true;  // pictures are drawn while the show goes on, and warped meanwhile
  // Folder of the networks' weights (denoise/denoise.h); empty: pictures at rest are drawn only.
  std::string weights;
  // Folder for what is found out about an exhibit once and kept for the next start; empty: nothing.
  std::string cache;
  bool bakes = true;  // while nobody needs the cores, where there is a cache
  Display display = Display::automatic;
  bool late_samples = true;  // of who walks are traced behind the picture, for the next
  SplatSettings dynamic = dynamic_splat_settings();  // of the light of lights that move
  float moving_clamp = 4;  // instead of transport.clamp while the visitor moves: fewer sparks
  int max_pixels = 1920 * 1200;
  HouseSettings house;
  std::vector<Token> kiosk_tokens;  // show/answer/cameras.h
  bool watched = false;             // a curator works at it: pages show what helps with that
  // Seconds (show/answer/idle.h): without a word until visitors are asked whether they are there,
  // and until they have answered; that a page is hidden until its visit rests. 0: never.
  double idle_after = 300, idle_answer = 60, hidden_after = 20;
};

// Somebody new.
struct Arrival {
  std::shared_ptr<Link> link;
  std::unique_ptr<Seat> seat;  // of a visitor's pictures; may be null
};

// New links and announcements, handed over by the threads of the server.
class Arrivals {
 public:
  void put(std::shared_ptr<Link> link, std::unique_ptr<Seat> seat = nullptr);
  std::vector<Arrival> take();
  uint32_t announce(Announcement announcement);  // its number
  std::vector<Announcement> take_announcements();

 private:
  std::mutex mutex_;
  std::vector<Arrival> all_;
  std::vector<Announcement> announcements_;
  uint32_t announced_ = 0;
};

// One that was broken off and may go on (show/answer/come_back.h).
struct KeptVisit {
  std::string id;              // Visitor::id
  double since = 0;            // show time
  std::list<Visitor> visitor;  // the one
};

struct Show {
  ShowSettings settings;
  Exhibit exhibit;  // the scene inside has the figure's materials and object added
  std::unique_ptr<World> world;
  Lights lights;
  Switches switches;
  // While there are lights.maps, of each object:
  std::vector<char> mapped;      // they know the light of some of it
  std::vector<char> shining;     // some of its light depends on the view
  std::vector<char> known;       // mapped and not shining: it needs no samples
  std::string light_problem;     // of the package's own light; empty: none
  std::unique_ptr<Baker> baker;  // null: maps are as they were at the start
  BakerLooks baker_looks;
  std::unique_ptr<VisibilityPass> visibility;  // one picture at a time
  SkinLight skin;                              // on what moves, for all visitors
  const Technique* technique = nullptr;
  const Technique* still_technique = nullptr;

  std::vector<Figure> figures;  // of all the exhibit's storytellers; hidden but for one
  std::vector<Prop> props;      // of each of Exhibit::props; hidden but for what is held
  Teller teller;            // of the house: kiosks' and those visitors' who have none of their own
  Movers movers;            // of the exhibit's animations
  std::vector<Play> plays;  // of each animation: the house's, and the shared ones
  SkinScratch scratch;
  SpeechSource speech;      // empty: the storyteller speaks by subtitles
  uint32_t utterances = 0;  // numbers of what is heard, the storyteller's and narrators' alike
  size_t greetings = 0, farewells = 0;
  std::string kiosk_message;  // the last of all kiosks that visitors were sent
  double drew_at = 0;         // when anything was drawn, samples traced or light found
  double behaved_at = -1;     // when the storyteller was last moved

  TourRoads roads;
  QuestionIndex questions;
  std::list<Visitor> visitors;
  std::list<KeptVisit> kept;                   // who left first comes first
  std::shared_ptr<const Seal> seal;            // of what pages keep of visits
  std::vector<std::shared_ptr<Link>> resting;  // to be taken by who keeps them: show/answer/idle.h
  std::shared_ptr<Capacity> capacity = std::make_shared<Capacity>();  // of all exhibits together
  std::vector<Eye> eyes;
  std::vector<Kiosk> kiosks;             // show/answer/orders.h
  std::optional<std::string> her_kiosk;  // the storyteller's guests are those of that name
  uint64_t her_visits = 0;               // of kiosks' guests that the storyteller has been with

  LocalTime local_time;           // set before a tick by whoever has a clock
  bool others_draw = false;       // likewise: others than its visitors need the cores
  HouseState house;               // at that time
  std::string house_message;      // the last that kiosk pages were sent
  Announcement announced;         // the last; id 0: none yet
  double announced_until = -1e9;  // show time

  // Where it is watched: what is wrong with its files as they are now (show/watch/rehearsal.h).
  std::vector<Problem> problems;
  std::string problems_message;  // the last that visitors were sent

  Sums sums;  // counted since they were last taken (show/count)

  uint64_t ticks = 0;
  uint64_t pose_number = 1;           // of the world: counts commits
  uint64_t posed_as = ~uint64_t(0);   // Teller::number of whom its figures stand as; none yet
  uint64_t posed_for = 0;             // Link::id of whose own animations it shows; 0: nobody's
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

// Whose place, storyteller and lamps the visitor follows at the moment; null: nobody's.
const Visitor* leader_of(const Show& show, const Visitor& visitor);
// Whom the visitor sees and hears.
Teller& teller_of(Show& show, Visitor& visitor);
const Teller& teller_of(const Show& show, const Visitor& visitor);
std::vector<Teller*> tellers_of(Show& show);  // the house's, then visitors' own
// Who of the exhibit's a teller is; null: it has none.
const StorytellerPlace* storyteller_of(const Show& show, const Teller& teller);

// The name of the kiosk that a page or a camera means by what it calls itself: without a name it
// belongs to the only one that has one, if there is just one.
std::string kiosk_name(const Show& show, const std::string& said);
const Kiosk* find_kiosk(const Show& show, const std::string& name);  // null: there is none
// The kiosk of a kiosk's page; null: of a visitor's.
const Kiosk* kiosk_of(const Show& show, const Visitor& visitor);
// The house's is with one kiosk at a time; pages of others neither hear nor read what she says.
bool hears_storyteller(const Show& show, const Visitor& visitor);
// Whether what `teller` says is for the visitor.
bool listens_to(const Show& show, const Visitor& visitor, const Teller& teller);

}  // namespace wellspring::show
