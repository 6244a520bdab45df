// SPDX-License-Identifier: Apache-2.0
#include "kiosk/process/sandbox.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <malloc.h>
#include <memory>
#include <sched.h>
#include <seccomp.h>
#include <stdexcept>
#include <string>
#include <sys/prctl.h>
#include <sys/resource.h>

#ifdef __SANITIZE_ADDRESS__
// LeakSanitizer asks at the end. It looks for leaks by means that the sandbox refuses.
static bool entered = false;
extern "C" int __lsan_is_turned_off() { return entered; }
#endif

namespace wellspring::kiosk {
namespace {

[[noreturn]] void refuse(const char* what, int error) {
  throw std::runtime_error("sandbox: " + std::string(what) + ": " + std::strerror(error));
}

struct Release {
  void operator()(void* filter) const { seccomp_release(filter); }
};
using Filter = std::unique_ptr<void, Release>;

// Calls that nothing here needs, and by which pictures could leave.
constexpr int refused[] = {
    // files made, named or cut
    SCMP_SYS(creat), SCMP_SYS(truncate), SCMP_SYS(ftruncate), SCMP_SYS(fallocate), SCMP_SYS(rename),
    SCMP_SYS(renameat), SCMP_SYS(renameat2), SCMP_SYS(link), SCMP_SYS(linkat), SCMP_SYS(symlink),
    SCMP_SYS(symlinkat), SCMP_SYS(unlink), SCMP_SYS(unlinkat), SCMP_SYS(mkdir), SCMP_SYS(mkdirat),
    SCMP_SYS(rmdir), SCMP_SYS(mknod), SCMP_SYS(mknodat), SCMP_SYS(openat2),
    SCMP_SYS(open_by_handle_at), SCMP_SYS(setxattr), SCMP_SYS(lsetxattr), SCMP_SYS(fsetxattr),
    SCMP_SYS(sendfile), SCMP_SYS(copy_file_range), SCMP_SYS(splice), SCMP_SYS(vmsplice),
    // the network
    SCMP_SYS(socket), SCMP_SYS(connect), SCMP_SYS(bind), SCMP_SYS(listen), SCMP_SYS(accept),
    SCMP_SYS(accept4),
    // other processes
    SCMP_SYS(execve), SCMP_SYS(execveat), SCMP_SYS(fork), SCMP_SYS(vfork), SCMP_SYS(ptrace),
    SCMP_SYS(process_vm_readv), SCMP_SYS(process_vm_writev), SCMP_SYS(pidfd_getfd),
    SCMP_SYS(msgget), SCMP_SYS(shmget), SCMP_SYS(shmat), SCMP_SYS(mq_open),
    // ways round all that
    SCMP_SYS(io_uring_setup), SCMP_SYS(mount), SCMP_SYS(chroot), SCMP_SYS(unshare), SCMP_SYS(setns),
    SCMP_SYS(bpf), SCMP_SYS(userfaultfd), SCMP_SYS(kexec_load), SCMP_SYS(init_module),
    SCMP_SYS(finit_module)};

void refuse(const Filter& filter, int call, std::initializer_list<scmp_arg_cmp> where = {}) {
  int error =
      seccomp_rule_add_array(filter.get(), SCMP_ACT_ERRNO(EPERM), call, unsigned(where.size()),
                             where.size() ? where.begin() : nullptr);
  // A call that this processor does not have is none to refuse.
  if (error != 0 && error != -EDOM && error != -EOPNOTSUPP) refuse("a rule", -error);
}

// `flags`: which argument of the call they are.
void refuse_writing(const Filter& filter, int call, unsigned flags, bool device) {
  auto has = [&](scmp_datum_t mask, scmp_datum_t value) {
    refuse(filter, call, {SCMP_CMP(flags, SCMP_CMP_MASKED_EQ, mask, value)});
  };
  has(O_ACCMODE, O_WRONLY);
  if (!device) has(O_ACCMODE, O_RDWR);
  for (scmp_datum_t one : {O_CREAT, O_TRUNC, O_APPEND}) has(one, one);
}

}  // namespace

void enter_sandbox(const SandboxSettings& settings) {
  const rlimit none{0, 0};
  if (setrlimit(RLIMIT_CORE, &none) != 0) refuse("core dumps", errno);
  if (prctl(PR_SET_DUMPABLE, 0) != 0) refuse("memory images", errno);
  mallopt(M_PERTURB, 0x55);  // memory that is given back is overwritten

  Filter filter(seccomp_init(SCMP_ACT_ALLOW));
  if (!filter) refuse("seccomp", ENOSYS);
  seccomp_attr_set(filter.get(), SCMP_FLTATR_CTL_TSYNC, 1);  // threads that run already, too
  for (int call : refused) refuse(filter, call);
  refuse_writing(filter, SCMP_SYS(open), 1, settings.device);
  refuse_writing(filter, SCMP_SYS(openat), 2, settings.device);
  // Threads may begin, processes not. What clone3() is asked for cannot be looked at: without it
  // the C library takes clone().
  refuse(filter, SCMP_SYS(clone), {SCMP_CMP(0, SCMP_CMP_MASKED_EQ, CLONE_THREAD, 0)});
  if (int error = seccomp_rule_add(filter.get(), SCMP_ACT_ERRNO(ENOSYS), SCMP_SYS(clone3), 0);
      error != 0 && error != -EDOM)
    refuse("a rule", -error);
  if (int error = seccomp_load(filter.get()); error != 0) refuse("seccomp", -error);
#ifdef __SANITIZE_ADDRESS__
  entered = true;
#endif
}

}  // namespace wellspring::kiosk
