// SPDX-License-Identifier: Apache-2.0
// Long work that may be cancelled, such as loading an exhibit. Who begins it opens a CancelScope;
// what is done within, however deep, asks check_cancelled() between steps of at most some tenths of
// a second, and so ends with the exception Cancelled.
#pragma once
#include <stop_token>

namespace wellspring {

// No std::exception: nobody takes it for something that is wrong with the work.
struct Cancelled {};

// What the calling thread does until the scope ends may be cancelled by `token`.
class CancelScope {
 public:
  explicit CancelScope(std::stop_token token);
  ~CancelScope();
  CancelScope(const CancelScope&) = delete;
  CancelScope& operator=(const CancelScope&) = delete;

 private:
  std::stop_token before_;
};

// The innermost scope's, for other threads that help; without a scope one that never says stop.
std::stop_token cancel_token();
// Throws Cancelled where the calling thread's work is to end. Not from within loops over cores,
// whose bodies must not throw.
void check_cancelled();

}  // namespace wellspring
