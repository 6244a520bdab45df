// SPDX-License-Identifier: Apache-2.0
// Makes libnats's options of settings, for those who connect to NATS: channel and jobs/line. No
// other header may show this library.
#pragma once
#include <memory>
#include <nats/nats.h>

#include "workers/settings.h"

namespace wellspring::workers {

struct EndOptions {
  void operator()(natsOptions* options) const { natsOptions_Destroy(options); }
};
using ConnectOptions = std::unique_ptr<natsOptions, EndOptions>;

// Throws std::invalid_argument for an address or a file that is wrong. Lost connections are made
// again, however long that takes.
ConnectOptions make_options(const ChannelSettings& settings);

}  // namespace wellspring::workers
