// SPDX-License-Identifier: Apache-2.0
#include "base/cancel.h"

#include <utility>

namespace wellspring {

static thread_local std::stop_token of_thread;

CancelScope::CancelScope(std::stop_token token)
    : before_(std::exchange(of_thread, std::move(token))) {}
CancelScope::~CancelScope() { of_thread = std::move(before_); }

std::stop_token cancel_token() { return of_thread; }

void check_cancelled() {
  if (of_thread.stop_requested()) throw Cancelled{};
}

}  // namespace wellspring
