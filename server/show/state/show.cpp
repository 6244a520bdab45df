// SPDX-License-Identifier: Apache-2.0
#include "show/state/show.h"

#include <utility>

namespace wellspring {

void Arrivals::put(std::shared_ptr<Link> link) {
  std::lock_guard lock(mutex_);
  links_.push_back(std::move(link));
}

std::vector<std::shared_ptr<Link>> Arrivals::take() {
  std::lock_guard lock(mutex_);
  return std::exchange(links_, {});
}

const StorytellerPlace* storyteller_of(const Show& show) {
  return show.figures.empty() ? nullptr : &show.exhibit.storytellers[show.storyteller_index];
}

}  // namespace wellspring
