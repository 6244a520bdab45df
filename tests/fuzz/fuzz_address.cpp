// SPDX-License-Identifier: Apache-2.0
// Addresses, networks, and X-Forwarded-For.
#include "fuzz/fuzz.h"
#include "stream/address.h"

namespace wellspring::fuzz {

void fuzz_address(Bytes bytes) {
  const std::string text = text_of(take_until(bytes, '\n')), forwarded = text_of(bytes);
  if (const auto address = read_address(text)) {
    require(read_address(to_string(*address)) == *address, "what was written can be read");
    require(limited_part(limited_part(*address)) == limited_part(*address), "a part is whole");
  }
  try {
    const Network network = read_network(text);
    require(network.bits >= 0 && network.bits <= 128, "a prefix is no longer than an address");
    require(network.holds(network.address), "a network holds its own address");
  } catch (const std::runtime_error& error) {
    require(!std::string(error.what()).empty(), "a refusal says why");
  }
  static const Network proxies[] = {read_network("10.0.0.0/8"), read_network("2001:db8::/33")};
  static const Address peer = *read_address("10.0.0.1");
  const auto client = find_client(peer, forwarded, proxies);
  if (client && any_holds(proxies, *client)) return;  // it goes on to what stands before
  require(find_client(peer, "192.0.2.7," + forwarded, proxies) == client,
          "what a client puts before counts for nothing");
}

}  // namespace wellspring::fuzz
