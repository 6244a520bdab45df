// SPDX-License-Identifier: Apache-2.0
// What a service tells the program that started it (systemd): sd_notify(3), "Standalone
// implementations". Nobody listens where NOTIFY_SOCKET is not set; then nothing is sent.
#pragma once
#include <string>

namespace wellspring {

// Where an installed program finds what belongs to it, by the place of the program itself:
// PREFIX/bin or PREFIX/libexec/wellspring has the programs, PREFIX/share/wellspring the rest.

// PREFIX/share/wellspring/NAME, or "" where that is not there.
std::string installed_share(const std::string& name);

// Where the configuration file NAME belongs: /etc/wellspring for /usr; ROOT/etc/wellspring for
// ROOT/usr; PREFIX/etc/wellspring for others; "" where this program is not installed.
std::string installed_config(const std::string& name);

class ServiceManager {
 public:
  // Takes NOTIFY_SOCKET, WATCHDOG_USEC and WATCHDOG_PID out of the environment: programs that are
  // started here are none of its business.
  ServiceManager();
  ~ServiceManager();
  ServiceManager(const ServiceManager&) = delete;
  ServiceManager& operator=(const ServiceManager&) = delete;

  // Lines of VARIABLE=value in one datagram. Never blocks; a failure is ignored.
  void say(const std::string& lines) const;
  // "READY=1": it serves, and how, in a sentence for `systemctl status`.
  void say_ready(const std::string& status) const;
  // "RELOADING=1", until say_ready().
  void say_reloading() const;
  // "WATCHDOG=1", where it is asked for and four times in its time at most. `now`: seconds.
  void ping(double now);

 private:
  int socket_ = -1;                      // connected; -1: nobody listens
  double interval_ = 0, pinged_ = -1e9;  // seconds; 0: no pings are asked for
};

}  // namespace wellspring
