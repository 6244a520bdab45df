// SPDX-License-Identifier: Apache-2.0
// What the process that sees pictures gives up, once its camera and its weights are open: it can
// open no file to write, no network, no other program, and leaves no memory image behind. What it
// has open already it keeps. Enforced by the kernel (seccomp), for all threads and for good.
#pragma once

namespace wellspring::kiosk {

struct SandboxSettings {
  // A camera device has to be opened to read and write; also again, when it was unplugged.
  bool device = false;
};

// Throws std::runtime_error where the kernel does not do it.
void enter_sandbox(const SandboxSettings& settings = {});

}  // namespace wellspring::kiosk
