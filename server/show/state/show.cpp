// SPDX-License-Identifier: Apache-2.0
#include "show/state/show.h"

#include <algorithm>
#include <set>
#include <utility>

#include "light/visible/visibility.h"
#include "show/state/renderer.h"

namespace wellspring::show {

ExhibitStage::ExhibitStage() = default;
ExhibitStage::~ExhibitStage() = default;

Show::Show() : drawing(std::make_unique<ShowDrawing>()) {}
Show::~Show() = default;

const Visitor& visitor_of(const ShowVisits& visits, uint64_t id) {
  return *std::ranges::find(visits.visitors, id, [](const Visitor& one) { return one.link->id; });
}

Visitor& visitor_of(ShowVisits& visits, uint64_t id) {
  return const_cast<Visitor&>(visitor_of(std::as_const(visits), id));
}

const Visitor* camera_of(const ShowVisits& visits, const Visitor& tile) {
  if (tile.wall.role != WallRole::tile) return nullptr;
  for (const Visitor& other : visits.visitors)
    if (other.wall.role == WallRole::camera && !other.left &&
        other.wall.part.name == tile.wall.part.name)
      return &other;
  return nullptr;
}

Visitor* camera_of(ShowVisits& visits, const Visitor& tile) {
  return const_cast<Visitor*>(camera_of(std::as_const(visits), tile));
}

// Returns the page that leads a wall, of several the one that came last; null: none does.
static const Visitor* leader_of_wall(const ShowVisits& visits, const Visitor& camera) {
  const Visitor* last = nullptr;
  for (const Visitor& other : visits.visitors)
    if (other.wall.role == WallRole::leader && other.welcomed &&
        other.wall.part.name == camera.wall.part.name)
      last = &other;
  return last;
}

const Visitor* leader_of(const ShowVisits& visits, const Visitor& visitor) {
  if (const Visitor* camera = camera_of(visits, visitor)) {
    const Visitor* leader = leader_of(visits, *camera);
    return leader ? leader : camera;
  }
  if (visitor.wall.role == WallRole::camera)
    if (const Visitor* leader = leader_of_wall(visits, visitor)) return leader;
  const VisitorGroup& group = visitor.group;
  if (group.follows.empty() || group.away) return nullptr;
  for (const Visitor& other : visits.visitors)
    if (other.group.leads == group.follows && !other.left) return &other;
  return nullptr;
}

const Teller& teller_of(const ShowCast& cast, const ShowVisits& visits, const Visitor& visitor) {
  const Visitor* leader = leader_of(visits, visitor);
  const Visitor& who = leader ? *leader : visitor;
  return who.own_teller ? *who.own_teller : cast.teller;
}

Teller& teller_of(ShowCast& cast, ShowVisits& visits, Visitor& visitor) {
  return const_cast<Teller&>(
      teller_of(std::as_const(cast), std::as_const(visits), std::as_const(visitor)));
}

std::vector<Teller*> tellers_of(ShowCast& cast, ShowVisits& visits) {
  std::vector<Teller*> all{&cast.teller};
  for (Visitor& visitor : visits.visitors)
    if (visitor.own_teller) all.push_back(visitor.own_teller.get());
  return all;
}

const StorytellerPlace* storyteller_of(const ExhibitStage& stage, const ShowCast& cast,
                                       const Teller& teller) {
  return cast.figures.empty() ? nullptr : &stage.exhibit.storytellers[teller.index];
}

std::string kiosk_name(const Show& show, const std::string& said) {
  if (!said.empty()) return said;
  std::set<std::string> names;
  for (const KioskSettings& kiosk : show.stage.exhibit.kiosks) names.insert(kiosk.name);
  for (const Eye& eye : show.kiosks.eyes) names.insert(eye.seen.kiosk);
  for (const Visitor& visitor : show.visits.visitors)
    if (visitor.welcomed && visitor.kiosk) names.insert(visitor.name);
  names.erase("");
  return names.size() == 1 ? *names.begin() : "";
}

const Kiosk* find_kiosk(const ShowKiosks& kiosks, const std::string& name) {
  for (const Kiosk& kiosk : kiosks.all)
    if (kiosk.settings.name == name) return &kiosk;
  return nullptr;
}

const Kiosk* kiosk_of(const Show& show, const Visitor& visitor) {
  return visitor.kiosk ? find_kiosk(show.kiosks, kiosk_name(show, visitor.name)) : nullptr;
}

bool hears_storyteller(const Show& show, const Visitor& visitor) {
  return !visitor.kiosk || !show.kiosks.her_kiosk ||
         *show.kiosks.her_kiosk == kiosk_name(show, visitor.name);
}

bool listens_to(const Show& show, const Visitor& visitor, const Teller& teller) {
  return visitor.welcomed && visitor.wall.role != WallRole::tile &&
         &teller_of(show.cast, show.visits, visitor) == &teller && hears_storyteller(show, visitor);
}

}  // namespace wellspring::show
