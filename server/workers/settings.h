// SPDX-License-Identifier: Apache-2.0
// Holds how a server or a worker reaches NATS, and what a server asks of its workers.
#pragma once
#include <string>

#include "base/layers.h"

namespace wellspring::workers {

struct ChannelSettings {
  std::string url;        // nats://HOST:PORT, tls://HOST:PORT, nats://TOKEN@HOST; several: commas
  std::string token;      // shown to the NATS server; empty: none but the address's
  std::string authority;  // file of certificates that sign the server's; empty: the system's
  std::string certificate, key;  // files of the client's own; empty: none
  std::string name;              // as the NATS server lists this client
};

struct CrewSettings {
  ChannelSettings channel;    // no address: there are no workers
  std::string secret;         // shared with workers; empty: messages are not sealed
  std::string version;        // version of this program
  std::string package, maps;  // folder of the exhibit; file of better maps, which may come to be
  bool exact = false;         // workers with other instructions are not asked
  bool verifies = false;      // requests are traced here, too, and compared bit by bit
};

}  // namespace wellspring::workers
