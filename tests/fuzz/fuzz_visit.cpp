// SPDX-License-Identifier: Apache-2.0
// What several peers say to a show, one after the other.
#include "fuzz/fuzz.h"
#include "fuzz/small_show.h"

namespace wellspring::fuzz {

// Lines, each a message of the peer that its first letter names: 0 and 1 are visitors, 2 the page
// of a kiosk, 3 has said nothing yet, 4 is a camera; "." is a while in which nobody says a word.
void fuzz_visit(Bytes bytes) {
  ShowStage stage;
  begin_small_show(stage);
  stage.join(16, 16);
  stage.join(16, 16, "de");
  stage.join(16, 16, "en", "kiosk");
  stage.connect();
  stage.browsers.emplace_back().link = std::make_shared<Link>(9, LinkKind::eye, "test");
  stage.browsers.back().link->local = true;
  stage.arrivals.put(stage.browsers.back().link);
  stage.steps(2);
  for (int lines = 0; lines < 20 && !bytes.empty(); lines++) {
    const std::string line = text_of(take_until(bytes, '\n'));
    if (line.empty()) continue;
    if (line[0] == '.') stage.steps(4);
    else stage.say(line.substr(1), size_t(line[0]) % stage.browsers.size());
    stage.step();
  }
  for (Browser& browser : stage.browsers) browser.link->mark_closed();
  stage.steps(2);
  require(stage.show->visits.visitors.empty(), "whoever leaves is gone");
}

}  // namespace wellspring::fuzz
