// SPDX-License-Identifier: Apache-2.0
// A text of a peer and what it says. It is read where it comes in, on the thread of its socket, so
// that who carries it out has no more to do with it.
#pragma once
#include <cstddef>
#include <string>
#include <variant>

#include "wire/json.h"

namespace wellspring::wire {

struct Heard {
  std::string text;  // as it came
  std::variant<WireError, BrowserMessage, Observation> said;
  size_t values = 0;  // of JSON that were read for it
};

Heard hear_visitor(std::string text);
Heard hear_camera(std::string text);

// Returns what it says, where it is such a thing; else null.
template <class Message>
const Message* said_as(const Heard& heard) {
  const BrowserMessage* message = std::get_if<BrowserMessage>(&heard.said);
  return message ? std::get_if<Message>(message) : nullptr;
}

}  // namespace wellspring::wire
