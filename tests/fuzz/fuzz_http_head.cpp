// SPDX-License-Identifier: Apache-2.0
// Target of a request, then Host, Origin, Sec-WebSocket-Protocol, Range and Accept-Encoding, a line
// each.
#include "fuzz/fuzz.h"
#include "stream/reply.h"
#include "stream/target.h"

namespace wellspring::fuzz {

void fuzz_http_head(Bytes bytes) {
  HttpQuestion question;
  if (read_target(text_of(take_until(bytes, '\n')), question) == 200) {
    const std::string& path = question.path;
    require(path.starts_with('/'), "a path starts with /");
    require(path.find_first_of(std::string("\\\0", 2)) == std::string::npos,
            "a path holds no backslash and no NUL");
    require(path.find("//") == std::string::npos, "a path has no empty segment");
    for (const char* part : {"/./", "/../"})
      require((path + "/").find(part) == std::string::npos, "a path goes nowhere else");
    require(question.query.size() <= max_query_fields, "queries are short");
  }
  static const HostNames names({"museum.example"}, {"https://tickets.example"}, "::1");
  const std::string host = text_of(take_until(bytes, '\n')),
                    origin = text_of(take_until(bytes, '\n'));
  names.hold(host);
  is_from_this_machine("127.0.0.1:80", is_proxy_header(origin), host);
  require(host_name(host).find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789.-_:[]") ==
              std::string::npos,
          "a name of a host has letters that can be shown anywhere");
  origin_allowed({origin}, host, {"https://tickets.example"});
  offers_protocol(text_of(take_until(bytes, '\n')), "wellspring.v1");
  const std::string asked_range = text_of(take_until(bytes, '\n'));
  for (uint64_t size : {uint64_t(0), uint64_t(1), uint64_t(1000), ~uint64_t(0)})
    if (const auto range = read_range(asked_range, size))
      require(range->begin <= size && range->size <= size - range->begin, "ranges lie in the file");
  const std::string codings = text_of(bytes);
  if (wants_gzip(codings))
    require(codings.find_first_of("*zZ") != std::string::npos, "gzip goes to who names it");
}

}  // namespace wellspring::fuzz
