// SPDX-License-Identifier: Apache-2.0
// Reads motions of an X3D humanoid: HAnimMotion nodes (ISO/IEC 19774-2), and interpolators that a
// TimeSensor drives and that ROUTEs lead to joints, the humanoid or displacers: one Motion a
// TimeSensor.
#pragma once
#include "avatar/load/x3d_reader.h"

namespace wellspring::avatar {

// Adds to reader.character.motions. Angles of HAnimMotion are degrees, as all files have them; if
// it gives the root's place instead of its way, the way is found by putting the feet on the floor.
void read_x3d_motions(HumanoidReader& reader, int humanoid);

}  // namespace wellspring::avatar
