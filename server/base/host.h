// SPDX-License-Identifier: Apache-2.0
// Tells the program that started this service (systemd) its state: sd_notify(3), "Standalone
// implementations". If NOTIFY_SOCKET is not set, nobody listens and nothing is sent.
#pragma once
#include <string>

namespace wellspring {

// Finds the files of an installed program by the place of the program itself: programs lie in
// PREFIX/bin or PREFIX/libexec/wellspring, the rest in PREFIX/share/wellspring.

// Returns PREFIX/share/wellspring/NAME, or "" if it does not exist.
std::string installed_share(const std::string& name);

// Returns the path for the configuration file NAME: in /etc/wellspring for /usr; in
// ROOT/etc/wellspring for ROOT/usr; in PREFIX/etc/wellspring for others; "" if this program is not
// installed.
std::string installed_config(const std::string& name);

class ServiceManager {
 public:
  // Takes NOTIFY_SOCKET, WATCHDOG_USEC and WATCHDOG_PID out of the environment, so that programs
  // that are started here do not see them.
  ServiceManager();
  ~ServiceManager();
  ServiceManager(const ServiceManager&) = delete;
  ServiceManager& operator=(const ServiceManager&) = delete;

  // Sends lines of VARIABLE=value in one datagram. Never blocks; a failure is ignored.
  void say(const std::string& lines) const;
  // Sends "READY=1" (the service runs) and a sentence for `systemctl status`.
  void say_ready(const std::string& status) const;
  // Sends "RELOADING=1", which holds until say_ready().
  void say_reloading() const;
  // Sends "WATCHDOG=1", if systemd asks for it, at most four times in the period that it asks for.
  // `now`: seconds.
  void ping(double now);

 private:
  int socket_ = -1;                      // connected; -1: nobody listens
  double interval_ = 0, pinged_ = -1e9;  // seconds; 0: no pings are asked for
};

}  // namespace wellspring
