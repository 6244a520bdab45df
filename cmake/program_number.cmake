# SPDX-License-Identifier: Apache-2.0
# Writes OUT, a source with a number of all sources below ROOT/server and of COMPILER: run by the
# build whenever one of them has changed.
file(GLOB_RECURSE sources ${ROOT}/server/*.h ${ROOT}/server/*.cpp)
list(SORT sources)
set(all "${COMPILER}")
foreach(source ${sources})
  file(SHA256 ${source} hash)
  string(APPEND all " ${hash}")
endforeach()
string(SHA256 number "${all}")
string(SUBSTRING ${number} 0 8 number)
file(CONFIGURE OUTPUT ${OUT} CONTENT [[
#include "workers/program_number.h"

namespace wellspring::workers {

std::string program_number(const std::string& version) { return version + "+@number@"; }

}  // namespace wellspring::workers
]] @ONLY)
