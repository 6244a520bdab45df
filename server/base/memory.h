// SPDX-License-Identifier: Apache-2.0
// How much memory arrays hold, whether they use it or not.
#pragma once
#include <cstddef>

#include "base/layers.h"

namespace wellspring {

template <class... Vectors>
size_t bytes_of(const Vectors&... vectors) {
  return (size_t(0) + ... + (vectors.capacity() * sizeof(typename Vectors::value_type)));
}

}  // namespace wellspring
