#include "child/child.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <stdexcept>

#include "palpate/core/error.h"
#include "palpate/core/stop.h"
#include "palpate/vdb/image.h"

namespace palpate::vdb {
namespace {

#if defined(__SANITIZE_ADDRESS__)
constexpr bool kReservesTerabytes = true;
#elif defined(__has_feature)
constexpr bool kReservesTerabytes = __has_feature(address_sanitizer);
#else
constexpr bool kReservesTerabytes = false;
#endif

LibraryLimits limits;

/// How a child ended: the first byte that it writes.
enum class Ending : std::uint8_t { kDone, kError, kNoMemory, kOther };

constexpr int kPollInterval = 50;  // [ms]

/// [bytes] of this process's address space in use.
std::uint64_t ownSize() noexcept {
  std::FILE* const file = std::fopen("/proc/self/statm", "r");
  if (file == nullptr) return 0;
  unsigned long long pages = 0;
  const bool is_read = std::fscanf(file, "%llu", &pages) == 1;
  std::fclose(file);
  return is_read ? pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE)) : 0;
}

void limit(int resource, std::uint64_t most) noexcept {
  rlimit now{};
  if (getrlimit(static_cast<__rlimit_resource_t>(resource), &now) != 0) return;
  const rlim_t wanted = now.rlim_max == RLIM_INFINITY ? most : std::min<rlim_t>(most, now.rlim_max);
  const rlimit next{now.rlim_cur == RLIM_INFINITY ? wanted : std::min(wanted, now.rlim_cur),
                    now.rlim_max};
  setrlimit(static_cast<__rlimit_resource_t>(resource), &next);
}

void limitSelf(const ChildTask& task) noexcept {
  const std::uint64_t more =
      limits.memory > 0 ? limits.memory : (std::uint64_t{512} << 20U) + 32 * task.file_bytes;
  if (!kReservesTerabytes) limit(RLIMIT_AS, ownSize() + more);
  const double seconds =
      limits.seconds > 0.0 ? limits.seconds : 15.0 + static_cast<double>(task.file_bytes) / 1e6;
  limit(RLIMIT_CPU, static_cast<std::uint64_t>(seconds) + 1);
  limit(RLIMIT_CORE, 0);
}

bool writeAll(int to, const void* data, std::size_t size) noexcept {
  const auto* from = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t done = write(to, from, size);
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return false;
    from += done;
    size -= static_cast<std::size_t>(done);
  }
  return true;
}

[[noreturn]] void beChild(int to, const ChildTask& task,
                          const std::function<void(ChildWriter&)>& work) noexcept {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  // The parent handles a stop signal, and kills this process.
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, SIG_IGN);
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) std::signal(signal, SIG_DFL);
  const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (nowhere >= 0) dup2(nowhere, STDERR_FILENO);  // the message of a failed assertion helps nobody
  limitSelf(task);
  ChildWriter result;
  auto ending = Ending::kDone;
  try {
    work(result);
  } catch (const Error& error) {
    ending = Ending::kError;
    result = {};
    const Problem& problem = error.problem();
    result.put(error.kind());
    for (const std::string* text :
         {&problem.code, &problem.message, &problem.hint, &problem.file, &problem.excerpt}) {
      result.put(*text);
    }
    result.put(problem.line);
    result.put(problem.column);
  } catch (const std::bad_alloc&) {
    ending = Ending::kNoMemory;
    result = {};
  } catch (const std::exception& error) {
    ending = Ending::kOther;
    result = {};
    result.put(std::string(error.what()));
  }
  const bool is_sent = writeAll(to, &ending, sizeof ending) &&
                       writeAll(to, result.bytes().data(), result.bytes().size());
  _exit(is_sent ? 0 : 1);
}

/// The child process. The destructor kills it if need be and reaps it, however the scope is left.
class Child {
 public:
  Child(pid_t process, int from) noexcept : process_(process), from_(from) {}
  ~Child() {
    close(from_);
    if (process_ > 0) {
      kill(process_, SIGKILL);
      static_cast<void>(wait());
    }
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// Everything that the child writes until it closes its end.
  std::string readAll() {
    std::string bytes;
    std::vector<char> buffer(std::size_t{1} << 16U);
    while (true) {
      pollStop();
      pollfd ready{from_, POLLIN, 0};
      const int events = poll(&ready, 1, kPollInterval);
      if (events == 0 || (events < 0 && errno == EINTR)) continue;
      const ssize_t got = read(from_, buffer.data(), buffer.size());
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) return bytes;
      bytes.append(buffer.data(), static_cast<std::size_t>(got));
    }
  }

  /// Waits for the child; returns its status as waitpid() reports it.
  int wait() noexcept {
    int status = 0;
    while (waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
    process_ = -1;
    return status;
  }

 private:
  pid_t process_;
  int from_;
};

Error deathOf(const ChildTask& task, int status) {
  std::string how = task.library + " ended without a result";
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    how = signal == SIGXCPU || signal == SIGKILL
              ? task.library + " takes too long over this file"
              : task.library + " crashes on this file (" + sigdescr_np(signal) + ")";
  }
  return inputError(task.code, how, task.hint, task.path);
}

[[noreturn]] void rethrow(ChildReader& result) {
  const auto kind = result.take<ErrorKind>();
  Problem problem;
  for (std::string* text :
       {&problem.code, &problem.message, &problem.hint, &problem.file, &problem.excerpt}) {
    *text = result.takeText();
  }
  problem.line = result.take<int>();
  problem.column = result.take<int>();
  throw Error(kind, std::move(problem));
}

}  // namespace

void setLibraryLimits(const LibraryLimits& wanted) noexcept { limits = wanted; }
LibraryLimits libraryLimits() noexcept { return limits; }

ChildReader runInChild(const ChildTask& task, const std::function<void(ChildWriter&)>& work) {
  int ends[2] = {-1, -1};
  const auto fail = [&](const char* what) {
    return Error(ErrorKind::kOperation,
                 {"child.none",
                  std::string("a process to read this file in could not be made: ") + what + ": " +
                      std::strerror(errno),
                  "close other programs", task.path});
  };
  if (pipe2(ends, O_CLOEXEC) != 0) throw fail("pipe");
  // Otherwise the child would write the text that waits in this process's buffers
  std::fflush(nullptr);
  const pid_t process = fork();
  if (process < 0) {
    const Error error = fail("fork");
    close(ends[0]);
    close(ends[1]);
    throw error;
  }
  if (process == 0) {
    close(ends[0]);
    beChild(ends[1], task, work);
  }
  close(ends[1]);
  Child child(process, ends[0]);
  std::string bytes = child.readAll();
  const int status = child.wait();
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || bytes.empty()) throw deathOf(task, status);
  ChildReader result(std::move(bytes));
  switch (result.take<Ending>()) {
    case Ending::kDone:
      return result;
    case Ending::kError:
      rethrow(result);
    case Ending::kNoMemory:
      throw inputError(task.code, task.library + " asks for too much memory for this file",
                       task.hint, task.path);
    case Ending::kOther:
      break;
  }
  throw inputError(task.code, task.library + " fails on this file: " + result.takeText(), task.hint,
                   task.path);
}

}  // namespace palpate::vdb
