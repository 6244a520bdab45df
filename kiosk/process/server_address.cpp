// SPDX-License-Identifier: Apache-2.0
#include "kiosk/process/server_address.h"

namespace wellspring::kiosk {

std::optional<ServerAddress> parse_address(const std::string& url) {
  ServerAddress address;
  address.tls = url.starts_with("wss://");
  if (!address.tls && !url.starts_with("ws://")) return {};
  if (address.tls) address.port = "443";
  std::string rest = url.substr(address.tls ? 6 : 5);
  for (unsigned char c : rest)
    if (c <= ' ' || c == 127 || c == '#' || c == '@' || c == '\\') return {};
  size_t slash = rest.find('/');
  address.path = slash == std::string::npos ? "" : rest.substr(slash);
  if (address.path.empty() || address.path == "/") address.path = "/api/v1/eye";
  std::string place = rest.substr(0, slash);
  size_t colon = place.rfind(':');
  if (!place.empty() && place[0] == '[') {
    size_t end = place.find(']');
    if (end == std::string::npos) return {};
    address.host = place.substr(1, end - 1);
    if (end + 1 == place.size()) colon = std::string::npos;
    else if (place[end + 1] != ':') return {};
    else colon = end + 1;
  } else {
    address.host = place.substr(0, colon);
    if (address.host.find(':') != std::string::npos) return {};
  }
  if (address.host.empty()) return {};
  if (colon != std::string::npos) {
    address.port = place.substr(colon + 1);
    if (address.port.empty() || address.port.size() > 5 ||
        address.port.find_first_not_of("0123456789") != std::string::npos)
      return {};
    int port = std::stoi(address.port);
    if (port < 1 || port > 65535) return {};
  }
  return address;
}

}  // namespace wellspring::kiosk
