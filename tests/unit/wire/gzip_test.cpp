// SPDX-License-Identifier: Apache-2.0
#include "base/layers.h"
#include "wire/http.h"

#include <gtest/gtest.h>
#include <zlib.h>

namespace wellspring::test {
namespace {

// One member of gzip and nothing behind it, whose checksum is right; else "broken".
std::string unpacked(const std::string& bytes, size_t size) {
  z_stream stream{};
  inflateInit2(&stream, 15 + 16);
  std::string text(size + 1, '\0'), from = bytes;
  stream.next_in = reinterpret_cast<Bytef*>(from.data());
  stream.avail_in = uInt(from.size());
  stream.next_out = reinterpret_cast<Bytef*>(text.data());
  stream.avail_out = uInt(text.size());
  const bool ends = inflate(&stream, Z_FINISH) == Z_STREAM_END && stream.avail_in == 0;
  text.resize(stream.total_out);
  inflateEnd(&stream);
  return ends ? text : "broken";
}

TEST(Gzip, TextComesBackAsItWasFromFewerBytes) {
  std::string text;
  for (int i = 0; i < 20000; i++) text += "o.x"[(i * i / 7) % 3];
  const std::string packed = gzip(text);
  EXPECT_FALSE(packed.empty());
  EXPECT_LT(packed.size(), text.size() / 4);
  EXPECT_EQ(unpacked(packed, text.size()), text);
  EXPECT_EQ(gzip(text), packed);
}

TEST(Gzip, WhatDoesNotGetSmallerIsNotPacked) {
  EXPECT_EQ(gzip(""), "");
  EXPECT_EQ(gzip("short"), "");
  EXPECT_EQ(gzip("0123456789abcdefghijklmnopqrstuvwxyz"), "");
  const std::string packed = gzip(std::string(100000, 'a') + "b");
  EXPECT_EQ(gzip(packed.substr(10, 40)), "");
}

TEST(Gzip, PicturesAndSoundAreNoText) {
  for (const char* type : {"text/html; charset=utf-8", "text/css", "application/json",
                           "application/json; charset=utf-8", "image/svg+xml"})
    EXPECT_TRUE(is_text(type)) << type;
  for (const char* type : {"image/jpeg", "image/png", "audio/ogg", "video/webm", "font/woff2",
                           "application/jsonx", ""})
    EXPECT_FALSE(is_text(type)) << type;
}

}  // namespace
}  // namespace wellspring::test
