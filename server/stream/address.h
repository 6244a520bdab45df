// SPDX-License-Identifier: Apache-2.0
// Reads addresses of peers, compares them with networks, and finds them behind reverse proxies.
#pragma once
#include <array>
#include <compare>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace wellspring::stream {

// Holds an IPv6 address, or an IPv4 address as ::ffff:a.b.c.d.
struct Address {
  std::array<uint8_t, 16> bytes{};
  auto operator<=>(const Address&) const = default;
  bool is_v4() const;
};

// Reads "192.0.2.7", "192.0.2.7:80", "2001:db8::1", "[2001:db8::1]", "[2001:db8::1]:80"; a zone
// ("%eth0") is left out. Returns nothing for other texts.
std::optional<Address> read_address(std::string_view text);
std::string to_string(const Address& address);

struct Network {
  Address address;
  int bits = 128;  // bits of the prefix, counted in 128
  bool holds(const Address& one) const;
};

// Reads "ADDRESS" or "ADDRESS/PREFIX". Throws std::runtime_error that names `text`.
Network read_network(const std::string& text);
bool any_holds(std::span<const Network> networks, const Address& one);

// Returns the part that counts as one address for the limits: an IPv4 address as a whole, the first
// 64 bits of an IPv6 address, since a single house has all the rest.
Address limited_part(const Address& address);

// Returns the address for the log as "192.0.2.0/24" or "2001:db8:1::/48", which belongs to no
// single person.
std::string shortened(const Address& address);

// Returns the client's address, if `peer` is one of `proxies`, from X-Forwarded-For: each proxy
// appends the address that it serves, so the last entry that is no proxy is believed and nothing
// before it. `forwarded`: all such headers in order, joined by commas. Returns nothing for an entry
// that is no address.
std::optional<Address> find_client(const Address& peer, std::string_view forwarded,
                                   std::span<const Network> proxies);

}  // namespace wellspring::stream
