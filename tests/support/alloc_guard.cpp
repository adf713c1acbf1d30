#include "support/alloc_guard.h"

#include <dlfcn.h>
#include <pthread.h>

#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <typeinfo>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define PALPATE_SANITIZED 1
#include <sanitizer/common_interface_defs.h>
// Declared in sanitizer/allocator_interface.h, which GCC does not install.
extern "C" int __sanitizer_install_malloc_and_free_hooks(  // NOLINT(bugprone-reserved-identifier)
    void (*malloc_hook)(const volatile void*, std::size_t),
    void (*free_hook)(const volatile void*));
#endif

namespace palpate::testing {
namespace {

// Plain thread-local integers: reading them from inside malloc must not itself allocate.
constinit thread_local int armed = 0;
constinit thread_local AllocGuard::Counts totals{};

}  // namespace

/// Not inlined, so that a debugger can stop here.
[[gnu::noinline]] void noteViolation(std::int64_t AllocGuard::Counts::*what) noexcept {
  totals.*what += 1;
}

namespace {

inline void note(std::int64_t AllocGuard::Counts::*what) noexcept {
  if (armed > 0) noteViolation(what);
}

/// The definition of a function behind the test executable's own. Looked up at the first call,
/// which may happen before any constructor of this file has run.
template <typename Function>
class Next {
 public:
  constexpr explicit Next(const char* name) noexcept : name_(name) {}
  Function* get() noexcept {
    Function* found = found_.load(std::memory_order_relaxed);
    if (found == nullptr) {
      found = reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name_));
      found_.store(found, std::memory_order_relaxed);
    }
    return found;
  }

 private:
  const char* name_;
  std::atomic<Function*> found_{nullptr};
};

constinit Next<int(pthread_mutex_t*)> next_mutex_lock("pthread_mutex_lock");
constinit Next<int(pthread_rwlock_t*)> next_rdlock("pthread_rwlock_rdlock");
constinit Next<int(pthread_rwlock_t*)> next_wrlock("pthread_rwlock_wrlock");
constinit Next<void(void*, std::type_info*, void (*)(void*))> next_throw("__cxa_throw");

}  // namespace

AllocGuard::AllocGuard() noexcept : before_(totals) { ++armed; }
AllocGuard::~AllocGuard() { --armed; }

AllocGuard::Counts AllocGuard::counts() const noexcept {
  return {totals.allocations - before_.allocations, totals.releases - before_.releases,
          totals.locks - before_.locks, totals.throws - before_.throws};
}

std::int64_t AllocGuard::violations() const noexcept {
  const Counts now = counts();
  return now.allocations + now.releases + now.locks + now.throws;
}

}  // namespace palpate::testing

using palpate::testing::AllocGuard;
using palpate::testing::note;

// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming,cppcoreguidelines-*)
#ifdef PALPATE_SANITIZED

namespace {

void onMalloc(const volatile void* /*block*/, std::size_t /*size*/) {
  note(&AllocGuard::Counts::allocations);
}
void onFree(const volatile void* block) {
  if (block != nullptr) note(&AllocGuard::Counts::releases);
}
[[maybe_unused]] const int kHooked = __sanitizer_install_malloc_and_free_hooks(onMalloc, onFree);

}  // namespace

#else

extern "C" {

// The C library's own names for the functions replaced here.
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* block, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void __libc_free(void* block);

void* malloc(std::size_t size) {
  note(&AllocGuard::Counts::allocations);
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  note(&AllocGuard::Counts::allocations);
  return __libc_calloc(count, size);
}
void* realloc(void* block, std::size_t size) {
  note(&AllocGuard::Counts::allocations);
  return __libc_realloc(block, size);
}
void* memalign(std::size_t alignment, std::size_t size) {
  note(&AllocGuard::Counts::allocations);
  return __libc_memalign(alignment, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  note(&AllocGuard::Counts::allocations);
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** out, std::size_t alignment, std::size_t size) {
  note(&AllocGuard::Counts::allocations);
  const bool power_of_two = alignment != 0 && (alignment & (alignment - 1)) == 0;
  if (!power_of_two || alignment % sizeof(void*) != 0) return EINVAL;
  void* block = __libc_memalign(alignment, size);
  if (block == nullptr) return ENOMEM;
  *out = block;
  return 0;
}
void free(void* block) {
  if (block != nullptr) note(&AllocGuard::Counts::releases);
  __libc_free(block);
}

}  // extern "C"

#endif

extern "C" {

int pthread_mutex_lock(pthread_mutex_t* mutex) {
  note(&AllocGuard::Counts::locks);
  return palpate::testing::next_mutex_lock.get()(mutex);
}
int pthread_rwlock_rdlock(pthread_rwlock_t* lock) {
  note(&AllocGuard::Counts::locks);
  return palpate::testing::next_rdlock.get()(lock);
}
int pthread_rwlock_wrlock(pthread_rwlock_t* lock) {
  note(&AllocGuard::Counts::locks);
  return palpate::testing::next_wrlock.get()(lock);
}

[[noreturn]] void __cxa_throw(void* object, std::type_info* type, void (*destroy)(void*)) {
  note(&AllocGuard::Counts::throws);
  palpate::testing::next_throw.get()(object, type, destroy);
  std::abort();
}

}  // extern "C"
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming,cppcoreguidelines-*)
