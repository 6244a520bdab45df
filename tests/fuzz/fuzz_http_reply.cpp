// SPDX-License-Identifier: Apache-2.0
// Headers that ask for a part of a file, or for a newer one.
#include "fuzz/fuzz.h"
#include "stream/reply.h"

namespace wellspring::fuzz {

void fuzz_http_reply(Bytes bytes) {
  HttpQuestion question;
  question.method = "GET";
  question.if_none_match = text_of(take_until(bytes, '\n'));
  question.if_range = text_of(take_until(bytes, '\n'));
  question.range = text_of(take_until(bytes, '\n'));
  for (uint64_t size : {uint64_t(0), uint64_t(1000)}) {
    HttpReply reply;
    reply.file = FilePart{"film.webm", 0, size};
    reply.headers["ETag"] = "\"a, b\"";
    reply.headers["Location"] = text_of(bytes);
    finish_reply(question, reply);
    require(
        reply.status == 200 || reply.status == 206 || reply.status == 304 || reply.status == 416,
        "a file is there, as a whole or in part, is known, or has no such part");
    require(bool(reply.file) == (reply.status < 300), "a file is sent where there is one to send");
    if (reply.file)
      require(reply.file->begin <= size && reply.file->size <= size - reply.file->begin,
              "what is sent lies in the file");
    for (const auto& [name, value] : reply.headers)
      require(value.find_first_of(std::string("\r\n\0", 3)) == std::string::npos,
              "a header is one line");
  }
}

}  // namespace wellspring::fuzz
