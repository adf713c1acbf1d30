#include "palpate/vdb/bake_threads.h"

#include <sched.h>
#include <tbb/task_arena.h>
#include <tbb/task_scheduler_observer.h>

#include <atomic>
#include <chrono>
#include <string>
#include <thread>

#include "palpate/core/error.h"

namespace palpate::vdb {
namespace {

/// The processors that this thread may run on, without `processor`.
cpu_set_t processorsWithout(int processor) {
  cpu_set_t set;
  CPU_ZERO(&set);
  (void)sched_getaffinity(0, sizeof set, &set);
  const bool may_run = processor >= 0 && processor < CPU_SETSIZE &&
                       CPU_ISSET(static_cast<std::size_t>(processor), &set);
  if (!may_run) {
    throw Error(ErrorKind::kUsage, {"bake.processor",
                                    "this thread may not run on processor " +
                                        std::to_string(processor) + ", so it cannot be kept free",
                                    "taskset -p PID says which there are"});
  }
  CPU_CLR(static_cast<std::size_t>(processor), &set);
  if (CPU_COUNT(&set) == 0) {
    throw Error(ErrorKind::kUsage, {"bake.processor",
                                    "only processor " + std::to_string(processor) +
                                        " may be used, so none would be left to bake on",
                                    "bake before the loop begins"});
  }
  return set;
}

/// The processors that this thread may run on while it is not baking.
thread_local cpu_set_t before;

/// TBB calls it for each thread that starts or stops working in an arena.
class Watch final : public tbb::task_scheduler_observer {
 public:
  Watch(tbb::task_arena& arena, const cpu_set_t& allowed)
      : tbb::task_scheduler_observer(arena), allowed_(allowed) {
    observe(true);
  }
  ~Watch() override {
    // Wait until threads that are just leaving have their processors back; they have no work left
    // to do, so that this is short.
    const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(1);
    while (inside_ > 0 && std::chrono::steady_clock::now() < until) std::this_thread::yield();
    observe(false);
  }
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

  void on_scheduler_entry(bool /*is_worker*/) override {
    ++inside_;
    (void)sched_getaffinity(0, sizeof before, &before);
    (void)sched_setaffinity(0, sizeof allowed_, &allowed_);
  }
  void on_scheduler_exit(bool /*is_worker*/) override {
    (void)sched_setaffinity(0, sizeof before, &before);
    --inside_;
  }

 private:
  cpu_set_t allowed_;
  std::atomic<int> inside_{0};
};

}  // namespace

void bakeOffProcessor(int processor, const std::function<void()>& bake) {
  const cpu_set_t allowed = processorsWithout(processor);
  tbb::task_arena arena(CPU_COUNT(&allowed));
  const Watch watch(arena, allowed);
  arena.execute(bake);
}

}  // namespace palpate::vdb
