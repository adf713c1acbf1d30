#include "picture/parallel_rows.h"

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

namespace palpate::tools {

std::size_t workerCount() {
  return std::clamp<std::size_t>(std::thread::hardware_concurrency(), 1, 16);
}

void parallelRows(int rows, const Progress& progress, const char* what,
                  const std::function<void(int y, std::size_t worker)>& row) {
  std::atomic<int> next = 0;
  std::atomic<bool> stopped = false;
  std::vector<std::jthread> helpers;
  for (std::size_t worker = 1; worker < workerCount(); ++worker) {
    helpers.emplace_back([&, worker] {
      for (int y = 0; !stopped.load() && (y = next.fetch_add(1)) < rows;) row(y, worker);
    });
  }
  try {
    for (int y = 0; (y = next.fetch_add(1)) < rows;) {
      report(progress, what, static_cast<double>(y) / rows);
      row(y, 0);
    }
  } catch (...) {
    stopped = true;
    throw;  // the helper threads are joined while the stack unwinds
  }
}

}  // namespace palpate::tools
