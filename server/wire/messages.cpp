// SPDX-License-Identifier: Apache-2.0
#include "wire/messages.h"

namespace wellspring::wire {

const char* to_string(Presence presence) {
  switch (presence) {
    case Presence::motion: return "motion";
    case Presence::person: return "person";
    default: return "absent";
  }
}

}  // namespace wellspring::wire
