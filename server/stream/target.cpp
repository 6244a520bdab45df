// SPDX-License-Identifier: Apache-2.0
#include "stream/target.h"

#include <algorithm>
#include <optional>
#include <unistd.h>

#include "stream/address.h"
#include "stream/reply.h"

namespace wellspring::stream {

static int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

static bool is_escape(std::string_view text, size_t at) {
  return at + 2 < text.size() && text[at] == '%' && hex_digit(text[at + 1]) >= 0 &&
         hex_digit(text[at + 2]) >= 0;
}

static std::optional<std::string> percent_decode(std::string_view text, bool plus_is_space) {
  std::string out;
  out.reserve(text.size());
  for (size_t i = 0; i < text.size(); i++) {
    if (text[i] == '%') {
      if (!is_escape(text, i)) return std::nullopt;
      out += char(hex_digit(text[i + 1]) * 16 + hex_digit(text[i + 2]));
      i += 2;
    } else {
      out += plus_is_space && text[i] == '+' ? ' ' : text[i];
    }
  }
  return out;
}

static bool is_utf8(std::string_view text) {
  for (size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i]);
    if ((lead >= 0x80 && lead < 0xc2) || lead > 0xf4) return false;  // starts no character
    const size_t more = lead < 0x80 ? 0 : lead < 0xe0 ? 1 : lead < 0xf0 ? 2 : 3;
    if (i + more >= text.size()) return false;
    for (size_t k = 1; k <= more; k++)
      if ((static_cast<unsigned char>(text[i + k]) & 0xc0) != 0x80) return false;
    const auto second = more ? static_cast<unsigned char>(text[i + 1]) : 0;
    if ((lead == 0xe0 && second < 0xa0) || (lead == 0xed && second > 0x9f) ||
        (lead == 0xf0 && second < 0x90) || (lead == 0xf4 && second > 0x8f))
      return false;  // overlong, surrogate, beyond U+10FFFF
    i += more + 1;
  }
  return true;
}

static bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

static bool good_path(std::string_view path) {
  if (path.empty() || path[0] != '/' || !is_utf8(path)) return false;
  for (size_t i = 0; i < path.size(); i++)
    if (path[i] == '\\' || is_control(path[i]) || is_escape(path, i)) return false;
  for (size_t begin = 1; begin < path.size();) {  // a slash at the very end is fine
    const size_t end = std::min(path.find('/', begin), path.size());
    const std::string_view segment = path.substr(begin, end - begin);
    if (segment.empty() || segment == "." || segment == "..") return false;
    begin = end + 1;
  }
  return true;
}

static bool has_encoded_slash(std::string_view path) {
  for (size_t i = 0; i + 2 < path.size(); i++)
    if (path[i] == '%' && path[i + 1] == '2' && (path[i + 2] == 'f' || path[i + 2] == 'F'))
      return true;
  return false;
}

static bool read_query(std::string_view text, HttpQuestion& question) {
  size_t fields = 0;
  while (!text.empty()) {
    const size_t end = std::min(text.find('&'), text.size());
    const std::string_view field = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (field.empty()) continue;
    if (++fields > max_query_fields) return false;
    const size_t equals = std::min(field.find('='), field.size());
    const auto name = percent_decode(field.substr(0, equals), true);
    const auto value = percent_decode(field.substr(std::min(equals + 1, field.size())), true);
    if (!name || !value || !is_utf8(*name) || !is_utf8(*value)) return false;
    if (name->find('\0') != std::string::npos || value->find('\0') != std::string::npos)
      return false;
    question.query[*name] = *value;
  }
  return true;
}

int read_target(std::string_view target, HttpQuestion& question) {
  if (target.size() > max_target_bytes) return 414;
  if (target.starts_with("http://") || target.starts_with("https://")) {  // the form for proxies
    const size_t slash = target.find('/', target.find("//") + 2);
    target = slash == target.npos ? "/" : target.substr(slash);
  }
  if (target.find('#') != target.npos) return 400;
  const size_t mark = std::min(target.find('?'), target.size());
  const std::string_view raw_path = target.substr(0, mark);
  const auto path = percent_decode(raw_path, false);
  if (!path || has_encoded_slash(raw_path) || !good_path(*path)) return 400;
  question.path = *path;
  question.query.clear();
  return read_query(target.substr(std::min(mark + 1, target.size())), question) ? 200 : 400;
}

struct Authority {
  std::string host, port;
  bool operator==(const Authority&) const = default;
};

// Reads "host", "host:80", "[::1]:80"; returns nothing for other texts.
static std::optional<Authority> read_authority(std::string_view text,
                                               std::string_view default_port) {
  size_t end = text.find(':');
  if (text.starts_with('[')) {
    end = text.find(']');
    if (end == text.npos) return std::nullopt;
    end++;
  }
  end = std::min(end, text.size());
  Authority authority{std::string(text.substr(0, end)), std::string(default_port)};
  if (end < text.size()) {
    if (text[end] != ':') return std::nullopt;
    authority.port = std::string(text.substr(end + 1));
  }
  const bool digits =
      std::ranges::all_of(authority.port, [](char c) { return c >= '0' && c <= '9'; });
  if (authority.host.empty() || authority.port.empty() || authority.port.size() > 5 || !digits)
    return std::nullopt;
  if (authority.host.find_first_of("/@?#\\ \t,") != std::string::npos) return std::nullopt;
  return authority;
}

bool origin_allowed(const std::vector<std::string_view>& origins, std::string_view host,
                    const std::vector<std::string>& allowed) {
  if (origins.empty()) return true;
  if (origins.size() > 1) return false;
  const std::string origin = lower(origins[0]);
  for (const std::string& one : allowed)
    if (one == "*" || (!one.empty() && origin == lower(one))) return true;
  const size_t colon = origin.find("://");
  if (colon == origin.npos) return false;  // also "null"
  const std::string scheme = origin.substr(0, colon);
  if (scheme != "http" && scheme != "https") return false;
  const std::string_view default_port = scheme == "http" ? "80" : "443";
  const auto theirs = read_authority(std::string_view(origin).substr(colon + 3), default_port);
  const auto ours = read_authority(lower(host), default_port);
  return theirs && ours && *theirs == *ours;
}

std::string host_name(std::string_view host_header) {
  const auto authority = read_authority(lower(host_header), "80");
  if (!authority) return "";
  std::string name = authority->host;
  if (name.ends_with('.')) name.pop_back();
  const bool plain = std::ranges::all_of(name, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') ||
           std::string_view(".-_:[]").find(c) != std::string_view::npos;
  });
  return plain ? name : "";
}

HostNames::HostNames(const std::vector<std::string>& hosts, const std::vector<std::string>& origins,
                     const std::string& listens_on) {
  add("localhost");
  add(listens_on);
  char own[256] = "";
  if (gethostname(own, sizeof(own) - 1) == 0) {
    const std::string name = own, first = name.substr(0, name.find('.'));
    for (const std::string& one : {name, first, first + ".local"}) add(one);
  }
  for (const std::string& host : hosts) {
    any_ = any_ || host == "*";
    add(host);
  }
  for (const std::string& origin : origins)
    if (const size_t colon = origin.find("://"); colon != origin.npos)
      add(origin.substr(colon + 3));
}

void HostNames::add(std::string name) {
  name = host_name(name);
  if (!name.empty()) names_.insert(std::move(name));
}

bool HostNames::hold(std::string_view host_header) const {
  if (any_) return true;
  const std::string name = host_name(host_header);
  if (name.empty()) return false;
  if (names_.contains(name)) return true;
  return name.starts_with('[') == (name.find(':') != name.npos) && read_address(name).has_value();
}

static bool is_loopback(std::string_view address) {
  // IPv4 on a socket for both versions.
  if (address.starts_with("::ffff:")) address.remove_prefix(7);
  return address == "::1" || address.starts_with("127.");
}

bool is_from_this_machine(std::string_view peer, bool proxied, std::string_view host) {
  if (proxied || !is_loopback(peer.substr(0, peer.rfind(':')))) return false;
  const auto named = read_authority(lower(host), "80");
  if (!named) return false;
  const std::string& name = named->host;
  const bool is_number = name.find_first_not_of("0123456789.") == std::string::npos;
  return name == "localhost" || name == "[::1]" || (is_number && is_loopback(name));
}

bool is_proxy_header(std::string_view name) {
  const std::string small = lower(name);
  return small.starts_with("x-forwarded") || small == "forwarded" || small == "x-real-ip" ||
         small == "via";
}

bool offers_protocol(std::string_view header, std::string_view wanted) {
  while (!header.empty())
    if (take_item(header) == wanted) return true;
  return false;
}

}  // namespace wellspring::stream
