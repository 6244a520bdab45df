// SPDX-License-Identifier: Apache-2.0
// A request of the IIIF Image API: the picture's two sides, then its text.
#include "fuzz/fuzz.h"
#include "show/http/iiif_request.h"

namespace wellspring::fuzz {

void fuzz_iiif_request(Bytes bytes) {
  int64_t sides[2] = {1, 1};
  for (int64_t& side : sides)
    for (const uint8_t digit : take_until(bytes, '\n')) side = (side * 10 + digit % 10) % (1 << 30);
  const int64_t width = sides[0] + 1, height = sides[1] + 1;
  const IiifQuestion question = read_iiif_request(text_of(bytes), width, height);
  require(question.status == 200 || !question.problem.empty(), "a refusal says why");
  if (question.status != 200) return;
  const IiifRequest& asked = question.request;
  require(asked.x >= 0 && asked.y >= 0 && asked.region_width >= 1 && asked.region_height >= 1 &&
              asked.x + asked.region_width <= width && asked.y + asked.region_height <= height,
          "a region lies within the picture");
  require(asked.width >= 1 && asked.height >= 1 && asked.width <= most_iiif_side &&
              asked.height <= most_iiif_side,
          "a picture is of a size that is made");
  require(asked.quarter_turns >= 0 && asked.quarter_turns < 4, "a turn is one of four");
  const IiifQuestion again = read_iiif_request(question.canonical, width, height);
  require(again.status == 200 && again.request == asked && again.canonical == question.canonical,
          "the canonical address means the same");
}

}  // namespace wellspring::fuzz
