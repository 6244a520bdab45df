// SPDX-License-Identifier: Apache-2.0
#include "show/answer/guest_gestures.h"

#include <algorithm>
#include <utility>

#include "show/answer/commands.h"

namespace wellspring::show {
namespace {

// The page that its guests stand before.
Visitor* find_page(Show& show, const Kiosk& kiosk) {
  for (Visitor& visitor : show.visitors)
    if (visitor.welcomed && kiosk_of(show, visitor) == &kiosk) return &visitor;
  return nullptr;
}

// A story's number after that of the one told last, or that one again.
size_t next_story(const Show& show, const KioskVisit& visit, bool again) {
  const std::vector<StoryText>& stories = show.exhibit.stories;
  auto told = std::find_if(stories.begin(), stories.end(), [&](const StoryText& story) {
    return story.id == visit.gestured_story;
  });
  const size_t index = told == stories.end() ? stories.size() - 1 : size_t(told - stories.begin());
  if (again) return told == stories.end() ? 0 : index;
  for (size_t i = 1; i <= stories.size(); i++) {
    const size_t next = (index + i) % stories.size();
    if (std::find(visit.heard.begin(), visit.heard.end(), stories[next].id) == visit.heard.end())
      return next;
  }
  return (index + 1) % stories.size();
}

StorytellerOrder order_of(const Show& show, const KioskVisit& visit, const std::string& gesture) {
  StorytellerOrder order;
  const std::vector<StoryText>& stories = show.exhibit.stories;
  const bool telling = !show.teller.voice.story.empty();
  if (gesture.size() == 1 && gesture[0] >= '1' && gesture[0] <= '9') {
    const size_t number = size_t(gesture[0] - '1');
    if (number < stories.size()) order.story = stories[number].id;
  } else if (gesture == "swipe_left" || gesture == "swipe_right") {
    const bool back = gesture == "swipe_right";
    if (telling) order.action = back ? "restart" : "skip";
    else if (!stories.empty()) order.story = stories[next_story(show, visit, back)].id;
  } else if (gesture == "swipe_down" && telling) {
    order.action = "stop";
  }
  return order;
}

}  // namespace

void follow_gestures(Show& show, Kiosk& kiosk) {
  std::vector<std::pair<uint64_t, std::string>> now;
  for (const Guest& guest : kiosk.audience.guests)
    if (!guest.gesture.empty()) now.emplace_back(guest.id, guest.gesture);
  const auto before = std::exchange(kiosk.gestures, std::move(now));
  Visitor* page = find_page(show, kiosk);
  if (!page) return;
  for (const auto& one : kiosk.gestures) {
    if (std::find(before.begin(), before.end(), one) != before.end()) continue;  // still told
    if (turns_pages(kiosk.showing)) {
      kiosk.gesture = one.second;
      kiosk.gesture_number++;
      show.totals.gestures++;
      continue;
    }
    const StorytellerOrder order = order_of(show, kiosk.visit, one.second);
    if (order == StorytellerOrder{}) continue;
    if (handle(show, *page, order)) continue;
    if (!order.story.empty()) kiosk.visit.gestured_story = order.story;
    show.totals.gestures++;
  }
}

}  // namespace wellspring::show
