// SPDX-License-Identifier: Apache-2.0
// Addresses of peers: read, compared with networks, and found behind reverse proxies.
#pragma once
#include <array>
#include <compare>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace wellspring::stream {

// An IPv6 address, or an IPv4 address as ::ffff:a.b.c.d.
struct Address {
  std::array<uint8_t, 16> bytes{};
  auto operator<=>(const Address&) const = default;
  bool is_v4() const;
};

// "192.0.2.7", "192.0.2.7:80", "2001:db8::1", "[2001:db8::1]", "[2001:db8::1]:80"; a zone ("%eth0")
// is left out. Nothing for what is none of these.
std::optional<Address> read_address(std::string_view text);
std::string to_string(const Address& address);

struct Network {
  Address address;
  int bits = 128;  // of the prefix, counted in 128
  bool holds(const Address& one) const;
};

// "ADDRESS" or "ADDRESS/PREFIX". Throws std::runtime_error that names `text`.
Network read_network(const std::string& text);
bool any_holds(std::span<const Network> networks, const Address& one);

// What counts as one address for the limits: IPv4 whole, of IPv6 the first 64 bits, since a single
// house has all the rest.
Address limited_part(const Address& address);

// For the log: "192.0.2.0/24", "2001:db8:1::/48", which is nobody's own.
std::string shortened(const Address& address);

// The address that asks, when `peer` is one of `proxies`: each proxy appends whom it serves to
// X-Forwarded-For, so the last entry that is no proxy is believed and nothing before it.
// `forwarded`: all such headers in order, joined by commas. Nothing for an entry that is no
// address.
std::optional<Address> find_client(const Address& peer, std::string_view forwarded,
                                   std::span<const Network> proxies);

}  // namespace wellspring::stream
