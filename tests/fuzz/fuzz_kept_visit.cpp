// SPDX-License-Identifier: Apache-2.0
// Visits that come back.
#include <cmath>
#include <nlohmann/json.hpp>

#include "fuzz/fuzz.h"
#include "fuzz/small_show.h"
#include "show/answer/come_back.h"
#include "wire/limits.h"

namespace wellspring::fuzz {

// Feeds the content of a sealed text, which an older program may have written.
void fuzz_kept_visit(Bytes bytes) {
  ShowStage stage;
  begin_small_show(stage);
  stage.show->house.local_time.day = 100;
  const std::string token = stage.show->visits.seal->close(text_of(bytes));
  if (token.size() > max_token_bytes) return;
  stage.connect();
  stage.say(
      nlohmann::json{{"type", "hello"}, {"width", 16}, {"height", 16}, {"resume", token}}.dump());
  stage.steps(3);
  require(stage.show->visits.visitors.size() == 1, "the visitor is there");
  const Viewpoint& view = stage.visitor().place.view;
  for (double number : {view.position.x, view.position.y, view.position.z, double(view.yaw)})
    require(std::isfinite(number), "the visitor stands somewhere");
}

}  // namespace wellspring::fuzz
