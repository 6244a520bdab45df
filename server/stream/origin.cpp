// SPDX-License-Identifier: Apache-2.0
#include "stream/origin.h"

#include <unistd.h>

#include <algorithm>
#include <optional>

#include "stream/address.h"
#include "stream/header_text.h"

namespace wellspring::stream {

struct Authority {
  std::string host, port;
  bool operator==(const Authority&) const = default;
};

// "host", "host:80", "[::1]:80"; nothing for what is neither.
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
  if (address.starts_with("::ffff:")) address.remove_prefix(7);  // IPv4 on a socket of both
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
