#include "tests/support/lock_count.h"

#include "common/base/sanitizers.h"

#if defined(__linux__) && !PALPATE_UNDER_ASAN && !PALPATE_UNDER_TSAN
#define PALPATE_COUNTS_LOCKS
#include <dlfcn.h>
#include <pthread.h>
#endif

namespace {

thread_local std::size_t locks = 0;

}  // namespace

namespace palpate::test {

LockCount::LockCount() noexcept : before_(locks) {}
std::size_t LockCount::count() const noexcept { return locks - before_; }

}  // namespace palpate::test

#ifdef PALPATE_COUNTS_LOCKS

namespace {

template <typename Function>
Function* next_of(const char* name) noexcept {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}  // namespace

// Found before those of the C library, by every library of the program.
extern "C" {
int pthread_mutex_lock(pthread_mutex_t* mutex) {
  static auto* const next = next_of<int(pthread_mutex_t*)>("pthread_mutex_lock");
  ++locks;
  return next(mutex);
}
int pthread_mutex_trylock(pthread_mutex_t* mutex) {
  static auto* const next = next_of<int(pthread_mutex_t*)>("pthread_mutex_trylock");
  ++locks;
  return next(mutex);
}
int pthread_rwlock_rdlock(pthread_rwlock_t* lock) {
  static auto* const next = next_of<int(pthread_rwlock_t*)>("pthread_rwlock_rdlock");
  ++locks;
  return next(lock);
}
int pthread_rwlock_wrlock(pthread_rwlock_t* lock) {
  static auto* const next = next_of<int(pthread_rwlock_t*)>("pthread_rwlock_wrlock");
  ++locks;
  return next(lock);
}
}

bool palpate::test::counts_locks() noexcept { return true; }
#else
bool palpate::test::counts_locks() noexcept { return false; }
#endif
