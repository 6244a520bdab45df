// SPDX-License-Identifier: Apache-2.0
#include "show/answer/holding.h"

#include <algorithm>

#include "show/answer/commands.h"

namespace wellspring::show {
namespace {

int find_model(const ShowCast& cast, const std::optional<Holding>& holding) {
  if (!holding || holding->id.empty()) return -1;
  const auto found =
      std::ranges::find(cast.held, holding->id, [](const auto& one) { return one.first; });
  return found == cast.held.end() ? -1 : int(found - cast.held.begin());
}

}  // namespace

void follow_holding(Show& show, Kiosk& kiosk, bool hers) {
  const std::optional<Holding>& holding = kiosk.audience.holding;
  follow_held(kiosk.held, find_model(show.cast, holding), holding, show.time);
  Visitor* page = nullptr;
  for (Visitor& visitor : show.visits.visitors) {
    if (!visitor.welcomed || kiosk_of(show, visitor) != &kiosk) continue;
    visitor.held = kiosk.held;
    if (!page) page = &visitor;
  }
  if (!hers || !is_visit(kiosk.stage.now)) return;
  Teller& teller = show.cast.teller;
  const bool talks = !teller.voice.queue.empty() || !has_guest(kiosk.stage.now);
  const HoldingWords words = choose_words(kiosk.visit.talk, holding, show.stage.exhibit,
                                          kiosk.visit.heard, talks, show.time);
  if (!words.text.empty()) say_all(teller.voice, words.text);
  if (words.story.empty() || !page) return;
  StorytellerOrder order;
  order.story = words.story;
  handle(show, *page, order);
}

}  // namespace wellspring::show
