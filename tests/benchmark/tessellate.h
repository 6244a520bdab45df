// SPDX-License-Identifier: Apache-2.0
// The same surfaces in more triangles.
#pragma once
#include "world/scene.h"

namespace wellspring::test {

// Every triangle of what does not emit light is cut into n * n alike, n such that about `triangles`
// come out. Lamps stay as they are: their triangles are a matter of choosing lights, not of tracing
// rays.
Scene tessellate(const Scene& scene, size_t triangles);

}  // namespace wellspring::test
