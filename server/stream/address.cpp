// SPDX-License-Identifier: Apache-2.0
#include "stream/address.h"

#include <arpa/inet.h>

#include <algorithm>
#include <charconv>
#include <stdexcept>

namespace wellspring::stream {

static constexpr std::array<uint8_t, 12> v4_prefix{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xff};

bool Address::is_v4() const {
  return std::equal(v4_prefix.begin(), v4_prefix.end(), bytes.begin());
}

static bool is_port(std::string_view text) {
  return !text.empty() && text.size() <= 5 &&
         std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
}

std::optional<Address> read_address(std::string_view text) {
  if (text.starts_with('[')) {
    const size_t end = text.find(']');
    if (end == text.npos) return std::nullopt;
    const std::string_view rest = text.substr(end + 1);
    if (!rest.empty() && !(rest[0] == ':' && is_port(rest.substr(1)))) return std::nullopt;
    text = text.substr(1, end - 1);
    if (text.find(':') == text.npos) return std::nullopt;
  } else if (std::ranges::count(text, ':') == 1) {
    const size_t colon = text.find(':');
    if (!is_port(text.substr(colon + 1))) return std::nullopt;
    text = text.substr(0, colon);
  }
  const std::string plain(text.substr(0, text.find('%')));
  Address address;
  if (inet_pton(AF_INET6, plain.c_str(), address.bytes.data()) == 1) return address;
  std::copy(v4_prefix.begin(), v4_prefix.end(), address.bytes.begin());
  if (inet_pton(AF_INET, plain.c_str(), address.bytes.data() + 12) == 1) return address;
  return std::nullopt;
}

std::string to_string(const Address& address) {
  char text[INET6_ADDRSTRLEN] = "";
  if (address.is_v4()) inet_ntop(AF_INET, address.bytes.data() + 12, text, sizeof(text));
  else inet_ntop(AF_INET6, address.bytes.data(), text, sizeof(text));
  return text;
}

bool Network::holds(const Address& one) const {
  for (int bit = 0; bit < bits; bit += 8) {
    const int mask = 0xff00 >> std::min(8, bits - bit) & 0xff;
    if ((address.bytes[size_t(bit / 8)] ^ one.bytes[size_t(bit / 8)]) & mask) return false;
  }
  return true;
}

Network read_network(const std::string& text) {
  const size_t slash = text.find('/');
  const auto address = read_address(text.substr(0, slash));
  if (!address) throw std::runtime_error("'" + text + "' is no address");
  Network network{*address, 128};
  if (slash == text.npos) return network;
  const int most = address->is_v4() ? 32 : 128;
  int bits = -1;
  const char *begin = text.data() + slash + 1, *end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(begin, end, bits);
  if (error != std::errc() || rest != end || bits < 0 || bits > most)
    throw std::runtime_error("'" + text + "': a prefix is 0 to " + std::to_string(most));
  network.bits = 128 - most + bits;
  return network;
}

bool any_holds(std::span<const Network> networks, const Address& one) {
  return std::ranges::any_of(networks, [&](const Network& network) { return network.holds(one); });
}

Address limited_part(const Address& address) {
  Address part = address;
  if (!address.is_v4()) std::fill(part.bytes.begin() + 8, part.bytes.end(), uint8_t(0));
  return part;
}

std::string shortened(const Address& address) {
  const bool v4 = address.is_v4();
  Address part = address;
  std::fill(part.bytes.begin() + (v4 ? 15 : 6), part.bytes.end(), uint8_t(0));
  return to_string(part) + (v4 ? "/24" : "/48");
}

std::optional<Address> find_client(const Address& peer, std::string_view forwarded,
                                   std::span<const Network> proxies) {
  Address client = peer;
  while (!forwarded.empty() && any_holds(proxies, client)) {
    const size_t comma = forwarded.rfind(',');
    std::string_view entry = comma == forwarded.npos ? forwarded : forwarded.substr(comma + 1);
    forwarded = comma == forwarded.npos ? std::string_view() : forwarded.substr(0, comma);
    while (!entry.empty() && (entry.front() == ' ' || entry.front() == '\t'))
      entry.remove_prefix(1);
    while (!entry.empty() && (entry.back() == ' ' || entry.back() == '\t')) entry.remove_suffix(1);
    const auto address = read_address(entry);
    if (!address) return std::nullopt;
    client = *address;
  }
  return client;
}

}  // namespace wellspring::stream
