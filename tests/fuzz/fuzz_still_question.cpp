// SPDX-License-Identifier: Apache-2.0
// The query of a still.
#include "fuzz/fuzz.h"
#include "show/http/still.h"
#include "stream/target.h"
#include "unit/show/tiny_exhibit.h"

namespace wellspring::fuzz {

void fuzz_still_question(Bytes bytes) {
  static const Exhibit exhibit = make_tiny_exhibit();
  HttpQuestion question;
  if (read_target("/still.jpg?" + text_of(bytes), question) != 200) return;
  const StillQuestion still = read_still_question(exhibit, question.query);
  require(still.status == 200 || !still.problem.empty(), "a refusal says why");
  if (still.status != 200) return;
  require(still.job.width > 0 && still.job.height > 0 && still.job.spp >= 0 &&
              still.job.seconds > 0 && still.job.viewpoint >= 0 &&
              size_t(still.job.viewpoint) < exhibit.viewpoints.size(),
          "an order can be drawn");
}

}  // namespace wellspring::fuzz
