// SPDX-License-Identifier: Apache-2.0
// Tells which instructions Embree has chosen on this processor.
#pragma once

namespace wellspring::world {

// Returns how many rays Embree traces at once: 4 (SSE), 8 (AVX) or 16 (AVX-512). The environment's
// WELLSPRING_EMBREE has settings for it, as rtcNewDevice() takes them: "isa=sse2" traces as an
// older processor does. Throws std::runtime_error if Embree cannot start.
int native_rays();

}  // namespace wellspring::world
