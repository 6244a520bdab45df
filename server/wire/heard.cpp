// SPDX-License-Identifier: Apache-2.0
#include "wire/heard.h"

#include <utility>

namespace wellspring::wire {
namespace {

template <class Read>
Heard hear(std::string text, const Read& read) {
  Heard heard;
  std::visit([&](auto&& said) { heard.said = std::forward<decltype(said)>(said); },
             read(text, &heard.values));
  heard.text = std::move(text);
  return heard;
}

}  // namespace

Heard hear_visitor(std::string text) { return hear(std::move(text), read_browser_message); }
Heard hear_camera(std::string text) { return hear(std::move(text), read_observation); }

}  // namespace wellspring::wire
