// SPDX-License-Identifier: Apache-2.0
#include "show/count/count.h"

#include <algorithm>

namespace wellspring::show {

void count(Show& show, const char* what, const std::string& thing, double by) {
  const std::string& id = show.stage.exhibit.id;
  show.sums[{show.house.local_time.day, what, thing.empty() ? id : id + "/" + thing}] += by;
}

namespace {

// Returns the exhibit's language that a tag names, else "other". A tag is whatever a browser says.
std::string known_language(const Exhibit& exhibit, const std::string& tag) {
  const std::string main = tag.substr(0, tag.find('-'));
  for (const std::string& one : exhibit.languages)
    if (one == tag || one == main) return one;
  return "other";
}

int riding(const Visitor& visitor) {  // index of the tour; -1: none
  const TourRide& ride = visitor.place.tour;
  return ride.state == TourRide::State::none ? -1 : ride.tour;
}

}  // namespace

void count_visit(Show& show, Visitor& visitor, bool goes_on) {
  if (goes_on) visitor.counted_tour = riding(visitor);
  if (goes_on || visitor.kiosk) return;  // at a kiosk its guests are counted, not its screen
  count(show, "visits");
  count(show, "languages", known_language(show.stage.exhibit, visitor.lang));
}

namespace {

const char* nearest_viewpoint(const Exhibit& exhibit, dvec3 place) {
  const char* name = "-";
  double nearest = dwell_distance;
  for (const ExhibitViewpoint& viewpoint : exhibit.viewpoints) {
    const double distance = glm::length(viewpoint.view.position - place);
    if (distance > nearest) continue;
    nearest = distance;
    name = viewpoint.view.name.c_str();
  }
  return name;
}

void end_tour(Show& show, Visitor& visitor, const char* how) {
  if (visitor.counted_tour >= 0)
    count(show, how, show.stage.exhibit.tours[size_t(visitor.counted_tour)].id);
  visitor.counted_tour = -1;
}

}  // namespace

void count_place(Show& show, Visitor& visitor, bool finished, double seconds) {
  const int tour = riding(visitor);
  if (tour != visitor.counted_tour) {
    end_tour(show, visitor, finished ? "tours_finished" : "tours_abandoned");
    if (tour >= 0) count(show, "tours_begun", show.stage.exhibit.tours[size_t(tour)].id);
    visitor.counted_tour = tour;
  }
  if (visitor.kiosk || seconds <= 0) return;
  if (show.time - visitor.place.moved_at > dwell_at_most) return;
  count(show, "dwell_seconds", nearest_viewpoint(show.stage.exhibit, visitor.place.view.position),
        seconds);
}

void count_leaving(Show& show, Visitor& visitor) { end_tour(show, visitor, "tours_abandoned"); }

}  // namespace wellspring::show
