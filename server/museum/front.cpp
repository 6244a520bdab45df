// SPDX-License-Identifier: Apache-2.0
#include "museum/front.h"

#include <utility>

namespace wellspring::museum {

void Front::open(Museum& museum) {
  std::lock_guard lock(mutex_);
  museum_ = &museum;
  for (std::shared_ptr<Link>& link : std::exchange(waiting_, {}))
    if (!link->closed()) museum.join(std::move(link));
}

void Front::join(std::shared_ptr<Link> link) {
  std::lock_guard lock(mutex_);
  if (museum_) return museum_->join(std::move(link));
  std::erase_if(waiting_, [](const auto& one) { return one->closed(); });
  waiting_.push_back(std::move(link));
}

HttpReply Front::answer(const HttpQuestion& question) {
  Museum* open = museum();
  return open ? wellspring::show::answer(open->sources(), question)
              : answer_while_loading(pages_, question);
}

bool Front::answer_later(const HttpQuestion& question, const std::shared_ptr<HttpAsker>& asker) {
  Museum* open = museum();
  return open && wellspring::show::answer_later(open->sources(), question, asker);
}

Museum* Front::museum() {
  std::lock_guard lock(mutex_);
  return museum_;
}

}  // namespace wellspring::museum
