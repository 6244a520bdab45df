// SPDX-License-Identifier: Apache-2.0
#include "stream/reply.h"

#include "unit/stream/fixture.h"
#include "wire/http.h"

namespace wellspring::test {
namespace {

HttpReply text_of(size_t bytes) {
  HttpReply reply{.body = std::string(bytes, 'a')};
  reply.headers["ETag"] = "\"v1\"";
  return reply;
}

HttpReply encoded(HttpReply reply, const std::string& accept_encoding) {
  HttpQuestion question{.accept_encoding = accept_encoding};
  encode_reply(question, reply);
  return reply;
}

TEST(Encoding, gzip_is_sent_to_who_says_so) {
  for (const char* header :
       {"gzip", "GZIP", "x-gzip", "deflate, gzip;q=1.0, *;q=0.5", "br;q=1,gzip;q=0.001", "*",
        " gzip ; q=0.5 ", "identity;q=0.5, gzip;q=0.5", "identity;q=0, *", "br,,gzip",
        "gzip;Q=1.000", "gzip;q=oh, x-gzip", "compress;q=2, gzip"})
    EXPECT_TRUE(wants_gzip(header)) << header;
}

TEST(Encoding, gzip_is_not_sent_to_who_does_not) {
  for (const char* header :
       {"", "identity", "br, deflate", "gzip;q=0", "gzip;q=0.000, *", "*;q=0", "gzip;q=", "gzip;",
        "gzip;q=1.001", "gzip;q=2", "gzip;q=-1", "gzip;q=0.5000", "gzip;level=9",
        "identity, gzip;q=0.9", "gzip q=1", "gzipped", "\"gzip\"", "identity;q=1, *;q=0.5", ",;,"})
    EXPECT_FALSE(wants_gzip(header)) << header;
}

TEST(Encoding, each_form_has_its_own_etag_and_says_what_it_was_chosen_by) {
  const HttpReply plain = encoded(text_of(2000), "identity");
  EXPECT_EQ(plain.body.size(), 2000u);
  EXPECT_EQ(plain.headers.at("ETag"), "\"v1\"");
  EXPECT_EQ(plain.headers.at("Vary"), "Accept-Encoding");
  EXPECT_FALSE(plain.headers.contains("Content-Encoding"));
  HttpReply other = text_of(2000);
  other.headers["Vary"] = "Accept";
  other.headers["ETag"] = "W/\"v1\"";
  const HttpReply packed = encoded(other, "gzip");
  EXPECT_EQ(packed.body, gzip(std::string(2000, 'a')));
  EXPECT_EQ(packed.headers.at("Content-Encoding"), "gzip");
  EXPECT_EQ(packed.headers.at("ETag"), "W/\"v1-gzip\"");
  EXPECT_EQ(packed.headers.at("Vary"), "Accept, Accept-Encoding");
}

TEST(Encoding, pictures_short_texts_and_files_stay_as_they_are) {
  HttpReply picture = text_of(2000);
  picture.content_type = "image/jpeg";
  HttpReply file = text_of(0);
  file.content_type = "text/plain";
  file.file = FilePart{"film.txt", 0, 5000};
  for (const HttpReply& reply : {picture, file, text_of(least_packed_bytes - 1)}) {
    const HttpReply same = encoded(reply, "gzip");
    EXPECT_EQ(same.body, reply.body);
    EXPECT_EQ(same.headers, reply.headers);
  }
}

TEST(Encoding, what_is_kept_as_gzip_is_sent_as_it_is_kept) {
  HttpReply kept = text_of(10);
  kept.gzip = "packed";
  EXPECT_EQ(encoded(kept, "gzip").body, "packed");
  EXPECT_EQ(encoded(kept, "").body, kept.body);
}

TEST(Encoding, on_the_line_heads_and_304_agree_with_what_is_sent) {
  House house(quick_settings(), [](const HttpQuestion&) { return text_of(5000); });
  RawClient client(house.port());
  const std::string lines = "Accept-Encoding: br\r\nAccept-Encoding: gzip;q=0.5\r\n";
  const auto get = client.ask("/", lines);
  EXPECT_EQ(get.body, gzip(std::string(5000, 'a')));
  EXPECT_EQ(get.header("Content-Encoding"), "gzip");
  const auto head = client.ask("/", lines, "HEAD");
  for (const char* name : {"Content-Length", "Content-Encoding", "ETag", "Vary", "Content-Type"})
    EXPECT_EQ(head.header(name), get.header(name)) << name;
  const auto known = client.ask("/", lines + "If-None-Match: " + get.header("ETag") + "\r\n");
  EXPECT_EQ(known.status, 304);
  EXPECT_EQ(known.header("ETag"), get.header("ETag"));
  EXPECT_EQ(known.header("Vary"), "Accept-Encoding");
  EXPECT_EQ(known.header("Content-Encoding"), "");
  const auto plain = client.ask("/", "If-None-Match: " + get.header("ETag") + "\r\n");
  EXPECT_EQ(plain.status, 200) << "that is the other form's";
  EXPECT_EQ(plain.body, std::string(5000, 'a'));
}

}  // namespace
}  // namespace wellspring::test
