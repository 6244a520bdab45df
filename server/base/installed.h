// SPDX-License-Identifier: Apache-2.0
// Where an installed program finds what belongs to it, by the place of the program itself:
// PREFIX/bin or PREFIX/libexec/wellspring has the programs, PREFIX/share/wellspring the rest.
#pragma once
#include <string>

namespace wellspring {

// PREFIX/share/wellspring/NAME, or "" where that is not there.
std::string installed_share(const std::string& name);

// Where the configuration file NAME belongs: /etc/wellspring for /usr; ROOT/etc/wellspring for
// ROOT/usr; PREFIX/etc/wellspring for others; "" where this program is not installed.
std::string installed_config(const std::string& name);

}  // namespace wellspring
