// SPDX-License-Identifier: Apache-2.0
// Gives the programs whose work can be divided one way to say so: --shard i/N.
#pragma once
#include <CLI/CLI.hpp>
#include <string>

#include "base/shard.h"

namespace wellspring::program {

inline CLI::Option* add_shard(CLI::App& app, Shard& shard, const std::string& about) {
  return app.add_option_function<std::string>(
      "--shard",
      [&shard](const std::string& text) {
        const std::optional<Shard> parsed = parse_shard(text);
        if (!parsed)
          throw CLI::ValidationError("--shard " + text, "i/N is expected, i from 1 to N");
        shard = *parsed;
      },
      about);
}

}  // namespace wellspring::program
