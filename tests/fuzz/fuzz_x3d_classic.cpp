// SPDX-License-Identifier: Apache-2.0
// Figures in ClassicVRML and VRML97.
#include "avatar/load/x3d_humanoid.h"
#include "fuzz/shown_figure.h"

namespace wellspring::fuzz {

void fuzz_x3d_classic(Bytes bytes) {
  load([&] {
    X3dFile file = parse_x3d_classic("fuzz", text_of(bytes));
    show_figure(character_from_x3d(file));
  });
}

}  // namespace wellspring::fuzz
