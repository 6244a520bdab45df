// SPDX-License-Identifier: Apache-2.0
// Holds one running exhibit as six values: the stage with its world and light, the cast that moves
// there, the visits, the kiosks, the house around them, and what draws the pictures. make_show()
// (show/state/make_show.h) begins it, tick() (show/tick.h) advances it. Everything here belongs to
// the thread that calls tick(), except what the renderer is at work on.
#pragma once
#include <cstdint>
#include <list>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ledger/sums.h"
#include "show/house/house.h"
#include "show/kiosk/kiosk.h"
#include "show/state/cast.h"
#include "show/state/show_settings.h"
#include "show/state/stage.h"
#include "show/state/totals.h"
#include "show/state/visitor.h"
#include "show/storyteller/audience.h"
#include "wire/tokens.h"

namespace wellspring::show {

// Holds a visit that was broken off and may go on (show/answer/come_back.h).
struct KeptVisit {
  std::string id;              // Visitor::id
  double since = 0;            // show time
  std::list<Visitor> visitor;  // exactly one
};

struct ShowVisits {
  std::list<Visitor> visitors;
  std::list<KeptVisit> kept;         // the visit that was broken off first comes first
  std::shared_ptr<const Seal> seal;  // seals what pages keep of their visits
  // to be taken by whoever keeps resting links: show/answer/idle.h
  std::vector<std::shared_ptr<Link>> resting;
  std::shared_ptr<Capacity> capacity = std::make_shared<Capacity>();  // shared by all exhibits
};

struct ShowKiosks {
  std::vector<Eye> eyes;
  std::vector<Kiosk> all;                // show/answer/orders.h
  std::optional<std::string> her_kiosk;  // kiosk whose guests the storyteller is with
  uint64_t her_visits = 0;  // number of kiosk guests' visits that the storyteller has been at
  std::string message;      // last state of all kiosks that visitors were sent
};

struct ShowHouse {
  LocalTime local_time;           // set before a tick by whoever has a clock
  HouseState state;               // the house's state at that time
  std::string message;            // last message about it that kiosk pages were sent
  Announcement announced;         // the last announcement; id 0: none yet
  double announced_until = -1e9;  // show time
};

struct ShowDrawing;  // show/state/renderer.h

struct Show {
  Show();
  ~Show();

  ShowSettings settings;
  ExhibitStage stage;
  ShowCast cast;
  ShowVisits visits;
  ShowKiosks kiosks;
  ShowHouse house;
  uint64_t ticks = 0;
  double time = 0;       // present tick's time, seconds
  uint64_t time_us = 0;  // present tick's time on the clock of pictures and sound
  Sums sums;             // counted since they were last taken (show/count)
  ShowTotals totals;
  std::unique_ptr<ShowDrawing> drawing;  // never null; reads much of the above: ends before it
};

// Return the visitor of that Link::id, which is one of them.
Visitor& visitor_of(ShowVisits& visits, uint64_t id);
const Visitor& visitor_of(const ShowVisits& visits, uint64_t id);
// Returns the camera of the wall that the visitor is a tile of; null: there is none.
Visitor* camera_of(ShowVisits& visits, const Visitor& tile);
const Visitor* camera_of(const ShowVisits& visits, const Visitor& tile);
// Returns the visitor whose place, storyteller and lamps this one follows at the moment; null:
// nobody's.
const Visitor* leader_of(const ShowVisits& visits, const Visitor& visitor);
// Return the storyteller that the visitor sees and hears.
Teller& teller_of(ShowCast& cast, ShowVisits& visits, Visitor& visitor);
const Teller& teller_of(const ShowCast& cast, const ShowVisits& visits, const Visitor& visitor);
std::vector<Teller*> tellers_of(ShowCast& cast,
                                ShowVisits& visits);  // the house's storyteller, then visitors' own
// Returns which of the exhibit's storytellers it is; null: the exhibit has none.
const StorytellerPlace* storyteller_of(const ExhibitStage& stage, const ShowCast& cast,
                                       const Teller& teller);

// Returns the name of the kiosk that a page or a camera means by what it calls itself: without a
// name it belongs to the only kiosk that has one, if there is just one.
std::string kiosk_name(const Show& show, const std::string& said);
const Kiosk* find_kiosk(const ShowKiosks& kiosks, const std::string& name);  // null: there is none
// Returns the kiosk of a kiosk's page; null: the page is a visitor's.
const Kiosk* kiosk_of(const Show& show, const Visitor& visitor);
// Returns whether the visitor hears the house's storyteller, which is with one kiosk at a time;
// pages of other kiosks neither hear nor read what it says.
bool hears_storyteller(const Show& show, const Visitor& visitor);
// Returns whether what `teller` says is for the visitor.
bool listens_to(const Show& show, const Visitor& visitor, const Teller& teller);

}  // namespace wellspring::show
