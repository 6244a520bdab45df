// SPDX-License-Identifier: Apache-2.0
// Answers from the first moment, while exhibits are still being loaded: HTTP questions get "come
// back later", links wait and join the museum when it opens. Any thread.
#pragma once
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "museum/museum.h"

namespace wellspring::museum {

class Front {
 public:
  explicit Front(const std::map<std::string, PageFile>& pages) : pages_(pages) {}
  void open(Museum& museum);  // waiting links join it
  void join(std::shared_ptr<Link> link);
  HttpReply answer(const HttpQuestion& question);
  bool answer_later(const HttpQuestion& question, const std::shared_ptr<HttpAsker>& asker);

 private:
  Museum* museum();
  const std::map<std::string, PageFile>& pages_;
  std::mutex mutex_;  // guards the next fields
  Museum* museum_ = nullptr;
  std::vector<std::shared_ptr<Link>> waiting_;
};

}  // namespace wellspring::museum
