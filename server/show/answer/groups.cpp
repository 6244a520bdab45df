// SPDX-License-Identifier: Apache-2.0
#include "show/answer/groups.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

namespace wellspring::show {

namespace {

constexpr float back_seconds = 0.6f;  // in which a view comes back, about
constexpr float farthest_up = 1.45f;  // radians
constexpr size_t code_letters = 6;

// Of letters and digits that are not taken for one another. Codes are short-lived, and tries are
// as many as a visitor may send messages.
std::string make_code() {
  static constexpr char letters[] = "ABCDEFGHJKLMNPQRSTUVWXYZ23456789";
  std::random_device random;
  std::uniform_int_distribution<size_t> any(0, sizeof(letters) - 2);
  std::string code;
  while (code.size() < code_letters) code += letters[any(random)];
  return code;
}

// As people type it.
std::string normalized(std::string code) {
  std::erase_if(code, [](char c) { return c == ' ' || c == '-'; });
  std::transform(code.begin(), code.end(), code.begin(),
                 [](char c) { return c >= 'a' && c <= 'z' ? char(c - 'a' + 'A') : c; });
  return code;
}

const Visitor* find_leader(const Show& show, const std::string& code) {
  for (const Visitor& visitor : show.visitors)
    if (!code.empty() && visitor.group.leads == code && !visitor.left) return &visitor;
  return nullptr;
}

void tell(Show& show, const std::string& code) {
  size_t followers = 0;
  for (const Visitor& visitor : show.visitors) followers += visitor.group.follows == code;
  for (Visitor& visitor : show.visitors) {
    const bool leads = visitor.group.leads == code;
    if (!leads && visitor.group.follows != code) continue;
    visitor.link->send_text(nlohmann::json{
        {"type", "group"},
        {"role", leads ? "leader" : "follower"},
        {"code", code},
        {"followers", followers},
        {"away",
         visitor.group.away}}.dump());
  }
}

void leave(Show& show, Visitor& visitor) {
  VisitorGroup& group = visitor.group;
  if (group.leads.empty() && group.follows.empty()) return;
  const std::string code = group.leads.empty() ? group.follows : group.leads;
  group = {};
  visitor.link->send_text(R"({"type":"group","role":"none"})");
  if (find_leader(show, code)) tell(show, code);  // else followers hear of it with the next tick
}

}  // namespace

std::optional<WireError> handle_group(Show& show, Visitor& visitor, const GroupOrder& order) {
  VisitorGroup& group = visitor.group;
  switch (order.action) {
    case GroupAction::lead:
      if (!group.leads.empty()) break;
      leave(show, visitor);
      do group.leads = make_code();
      while (find_leader(show, group.leads) != &visitor);
      break;
    case GroupAction::follow: {
      const std::string code = normalized(order.code);
      const Visitor* leader = find_leader(show, code);
      if (!leader || leader == &visitor)
        return WireError{"unknown_group", "nobody leads a group by the code '" + order.code + "'"};
      leave(show, visitor);
      group.follows = code;
      stop_tour(visitor.place.tour, visitor.hearing.narration.voice);
      break;
    }
    case GroupAction::rejoin: group.away = false; break;
    case GroupAction::leave: leave(show, visitor); return {};
  }
  const std::string& code = group.leads.empty() ? group.follows : group.leads;
  if (code.empty()) return WireError{"no_group", "you are in no group"};
  visitor.state_sent_at = -1e9;
  tell(show, code);
  return {};
}

std::optional<WireError> check_not_following(const Show& show, const Visitor& visitor) {
  if (!leader_of(show, visitor)) return {};
  return WireError{"in_group", "you follow a group; leave it, or walk off, to decide for yourself"};
}

void go_away(Visitor& visitor) {
  VisitorGroup& group = visitor.group;
  if (group.follows.empty() || group.away) return;
  group.away = true;
  group.look = vec2(0);
  visitor.link->send_text(nlohmann::json{
      {"type", "group"},
      {"role", "follower"},
      {"code", group.follows},
      {"away", true}}.dump());
}

void follow_leader(Show& show, Visitor& visitor, float dt) {
  VisitorGroup& group = visitor.group;
  if (group.follows.empty()) return;
  const bool comes_back = std::ranges::any_of(show.kept, [&](const KeptVisit& kept) {
    return kept.visitor.front().group.leads == group.follows;
  });
  if (!find_leader(show, group.follows) && !comes_back) return leave(show, visitor);
  const Visitor* leader = leader_of(show, visitor);
  if (!leader) return;  // away
  if (show.time - group.looked_at > look_round_seconds) group.look *= std::exp(-dt / back_seconds);
  VisitorPlace& place = visitor.place;
  const Viewpoint& ahead = leader->place.view;
  place.view = ahead;
  place.view.yaw = std::remainder(ahead.yaw + group.look.x, 2 * pi);
  place.view.pitch = std::clamp(ahead.pitch + group.look.y, -farthest_up, farthest_up);
  place.viewpoint = glm::length(group.look) < 0.01f ? leader->place.viewpoint : -1;
  place.velocity = vec3(0);
}

}  // namespace wellspring::show
