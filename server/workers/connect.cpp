// SPDX-License-Identifier: Apache-2.0
#include "workers/connect.h"

#include <algorithm>
#include <stdexcept>

#include "base/log.h"

namespace wellspring::workers {
namespace {

constexpr int64_t reconnect_wait_ms = 500, ping_interval_ms = 2000, write_deadline_ms = 2000,
                  connect_timeout_ms = 2000;
constexpr int most_pings_out = 2;

void need(natsStatus status, const std::string& what) {
  if (status != NATS_OK) throw std::invalid_argument(what + ": " + natsStatus_GetText(status));
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts;
  for (size_t from = 0; from <= text.size();) {
    const size_t to = std::min(text.find(',', from), text.size());
    if (to > from) parts.push_back(text.substr(from, to - from));
    from = to + 1;
  }
  return parts;
}

// The library tells its threads' news here.
void say_lost(natsConnection*, void*) { log::warn("the connection to NATS is lost"); }
void say_back(natsConnection*, void*) { log::info("connected to NATS again"); }
void say_connected(natsConnection*, void*) { log::info("connected to NATS"); }
void say_error(natsConnection*, natsSubscription*, natsStatus status, void*) {
  log::debug("NATS: {}", natsStatus_GetText(status));
}

}  // namespace

ConnectOptions make_options(const ChannelSettings& settings) {
  natsOptions* options = nullptr;
  need(natsOptions_Create(&options), "NATS");
  ConnectOptions made(options);
  const std::vector<std::string> urls = split(settings.url);
  std::vector<const char*> names;
  for (const std::string& url : urls) names.push_back(url.c_str());
  if (names.empty()) throw std::invalid_argument("no address of a NATS server");
  need(natsOptions_SetServers(options, names.data(), int(names.size())), settings.url);
  if (!settings.token.empty())
    need(natsOptions_SetToken(options, settings.token.c_str()), "token of NATS");
  const bool tls = settings.url.starts_with("tls://") || !settings.authority.empty() ||
                   !settings.certificate.empty();
  if (tls) need(natsOptions_SetSecure(options, true), "TLS");
  if (!settings.authority.empty())
    need(natsOptions_LoadCATrustedCertificates(options, settings.authority.c_str()),
         settings.authority);
  if (!settings.certificate.empty())
    need(natsOptions_LoadCertificatesChain(options, settings.certificate.c_str(),
                                           settings.key.c_str()),
         settings.certificate);
  need(natsOptions_SetName(options, settings.name.c_str()), "name");
  natsOptions_DisableNoResponders(options, true);  // who is not there says nothing
  natsOptions_SetMaxReconnect(options, -1);
  natsOptions_SetReconnectWait(options, reconnect_wait_ms);
  natsOptions_SetTimeout(options, connect_timeout_ms);
  natsOptions_SetPingInterval(options, ping_interval_ms);
  natsOptions_SetMaxPingsOut(options, most_pings_out);
  natsOptions_SetWriteDeadline(options, write_deadline_ms);
  natsOptions_SetDisconnectedCB(options, say_lost, nullptr);
  natsOptions_SetReconnectedCB(options, say_back, nullptr);
  natsOptions_SetErrorHandler(options, say_error, nullptr);
  natsOptions_SetRetryOnFailedConnect(options, true, say_connected, nullptr);
  return made;
}

}  // namespace wellspring::workers
