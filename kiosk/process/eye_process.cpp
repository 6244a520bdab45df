// SPDX-License-Identifier: Apache-2.0
#include "kiosk/process/eye_process.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <malloc.h>
#include <memory>
#include <poll.h>
#include <sched.h>
#include <seccomp.h>
#include <stdexcept>
#include <string>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>
#include <utility>

#include "wire/json.h"

namespace wellspring::kiosk {
namespace {

constexpr size_t longest_line = 64 * 1024;

// Adds what tells the program that it is an eye.
std::vector<std::string> words_of(std::vector<std::string> arguments, size_t eye) {
  for (const std::string& word : {std::string(observe_to), std::to_string(observe_fd),
                                  std::string(of_camera), std::to_string(eye)})
    arguments.push_back(word);
  return arguments;
}

}  // namespace

bool write_line(int fd, const std::string& line) {
  std::string text = line + '\n';
  for (size_t done = 0; done < text.size();) {
    ssize_t wrote = write(fd, text.data() + done, text.size() - done);
    if (wrote < 0 && errno == EINTR) continue;
    if (wrote <= 0) return false;
    done += size_t(wrote);
  }
  return true;
}

std::optional<EyeOrder> Orders::take() {
  pollfd readable{STDIN_FILENO, POLLIN, 0};
  char piece[4096];
  while (text_.size() <= longest_line && poll(&readable, 1, 0) > 0) {
    const ssize_t count = read(STDIN_FILENO, piece, sizeof piece);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    text_.append(piece, size_t(count));
  }
  std::optional<EyeOrder> newest;
  for (size_t end; (end = text_.find('\n')) != std::string::npos; text_.erase(0, end + 1)) {
    auto order = read_eye_order(std::string_view(text_).substr(0, end));
    if (EyeOrder* found = std::get_if<EyeOrder>(&order)) newest = std::move(*found);
  }
  if (text_.size() > longest_line) text_.clear();
  return newest;
}

HandedText::HandedText(const std::string& text) {
  // Its number is beyond those that an eye gives to other files.
  constexpr int least = 16;
  const int made = memfd_create("wellspring", MFD_CLOEXEC | MFD_ALLOW_SEALING);
  fd_ = fcntl(made, F_DUPFD_CLOEXEC, least);
  close(made);
  size_t done = 0;
  while (fd_ >= 0 && done < text.size()) {
    const ssize_t wrote = write(fd_, text.data() + done, text.size() - done);
    if (wrote < 0 && errno == EINTR) continue;
    if (wrote <= 0) break;
    done += size_t(wrote);
  }
  constexpr int never_changes = F_SEAL_WRITE | F_SEAL_GROW | F_SEAL_SHRINK | F_SEAL_SEAL;
  if (fd_ >= 0 && done == text.size() && fcntl(fd_, F_ADD_SEALS, never_changes) == 0) return;
  const int error = errno;
  if (fd_ >= 0) close(fd_);
  throw std::runtime_error(std::string("memory for a file: ") + std::strerror(error));
}

HandedText::~HandedText() { close(fd_); }

// The eye has no other open file: the way to the server is closed to it.
EyeProcess::EyeProcess(std::vector<std::string> arguments, size_t eye, const HandedText* handed)
    : process_({.words = words_of(std::move(arguments), eye),
                .program = "/proc/self/exe",
                .reads = STDIN_FILENO,
                .writes = observe_fd,
                .files = handed ? std::vector{std::pair(handed->fd(), handed_fd)}
                                : std::vector<std::pair<int, int>>{},
                .patience = 2}) {
  fcntl(process_.to(), F_SETFL, O_NONBLOCK);
}

void EyeProcess::tell(const std::string& line) {
  const std::string text = line + '\n';
  // The line is written whole or not at all: it is shorter than PIPE_BUF.
  [[maybe_unused]] const ssize_t wrote = write(process_.to(), text.data(), text.size());
}

EyeProcess::Heard EyeProcess::take(std::string& line, double seconds) {
  bool waited = false;
  for (;;) {
    if (size_t end = text_.find('\n'); end != std::string::npos) {
      line = text_.substr(0, end);
      text_.erase(0, end + 1);
      if (!std::exchange(too_long_, false)) return Heard::line;
      continue;
    }
    if (text_.size() > longest_line) text_.clear(), too_long_ = true;
    pollfd readable{process_.from(), POLLIN, 0};
    const int wait = std::exchange(waited, true) ? 0 : int(1000 * seconds);
    if (poll(&readable, 1, wait) <= 0) return Heard::nothing;
    char piece[4096];
    ssize_t count = read(process_.from(), piece, sizeof piece);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return Heard::ended;
    text_.append(piece, size_t(count));
  }
}

}  // namespace wellspring::kiosk

#ifdef __SANITIZE_ADDRESS__
// LeakSanitizer calls this at the end. It looks for leaks by means that the sandbox refuses.
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

// Nothing here needs these calls, by which pictures could leave.
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
  // If this processor lacks a call, there is nothing to refuse.
  if (error != 0 && error != -EDOM && error != -EOPNOTSUPP) refuse("a rule", -error);
}

// Refuses writing; `flags` is the index of the call's argument that holds them.
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
  mallopt(M_PERTURB, 0x55);  // overwrites memory that is given back

  Filter filter(seccomp_init(SCMP_ACT_ALLOW));
  if (!filter) refuse("seccomp", ENOSYS);
  seccomp_attr_set(filter.get(), SCMP_FLTATR_CTL_TSYNC, 1);  // covers threads that run already, too
  for (int call : refused) refuse(filter, call);
  refuse_writing(filter, SCMP_SYS(open), 1, settings.device);
  refuse_writing(filter, SCMP_SYS(openat), 2, settings.device);
  // Threads may begin, processes not. The arguments of clone3() cannot be inspected: without it the
  // C library takes clone().
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
