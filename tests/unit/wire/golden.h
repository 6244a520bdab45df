// SPDX-License-Identifier: Apache-2.0
// Golden binary messages: tests/protocol/NAME, bytes in hexadecimal, lines that begin with # aside.
#pragma once
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>

#include "wire/packet.h"

namespace wellspring::test {

inline Packet read_golden(const std::string& name) {
  std::ifstream file(std::string(WELLSPRING_SOURCE) + "/tests/protocol/" + name);
  EXPECT_TRUE(file) << name;
  Packet bytes;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with('#')) continue;
    std::istringstream words(line);
    for (std::string word; words >> word;) bytes.push_back(uint8_t(std::stoi(word, nullptr, 16)));
  }
  return bytes;
}

}  // namespace wellspring::test
