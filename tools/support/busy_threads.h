#pragma once
/// Load on the machine during a measurement, for `palpate bench servo` and tests/bench.

#include <atomic>
#include <cmath>
#include <thread>
#include <vector>

namespace palpate {

/// Threads that compute until the object is destroyed.
class BusyThreads {
 public:
  explicit BusyThreads(unsigned count) {
    for (unsigned i = 0; i < count; ++i) {
      threads_.emplace_back([this] {
        double x = 1.0;
        while (!is_over_.load(std::memory_order_relaxed)) x = std::sqrt(x + 1.0);
        sink_.store(x, std::memory_order_relaxed);
      });
    }
  }
  ~BusyThreads() {
    is_over_ = true;
    for (std::thread& thread : threads_) thread.join();
  }
  BusyThreads(const BusyThreads&) = delete;
  BusyThreads& operator=(const BusyThreads&) = delete;

 private:
  std::atomic<bool> is_over_{false};
  std::atomic<double> sink_{0.0};
  std::vector<std::thread> threads_;
};

}  // namespace palpate
