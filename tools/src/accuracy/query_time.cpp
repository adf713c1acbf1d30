#include "accuracy/query_time.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <vector>

namespace palpate::tools {
namespace {

using Clock = std::chrono::steady_clock;

double nanoseconds(Clock::duration time) {
  return std::chrono::duration<double, std::nano>(time).count();
}

/// Uses `value`, so that the compiler does not optimize its computation away.
void use(double value) noexcept {
  volatile double sink = value;
  (void)sink;
}

double sumOf(const FieldSample& s) noexcept {
  return s.value + s.gradient.x + s.gradient.y + s.gradient.z;
}

double runIndependent(const Field& field, std::span<const Vec3> path) {
  double sum = 0.0;
  const auto before = Clock::now();
  for (const Vec3& p : path) sum += sumOf(field.sample(p));
  const auto after = Clock::now();
  use(sum);
  return nanoseconds(after - before);
}

double runDependent(const Field& field, std::span<const Vec3> path) {
  // So small a factor changes no position, but neither compiler nor processor can know that.
  constexpr double kNothing = 1e-40;
  double last = 0.0;
  const auto before = Clock::now();
  for (const Vec3& p : path) last = sumOf(field.sample(p + Vec3(kNothing * last)));
  const auto after = Clock::now();
  use(last);
  return nanoseconds(after - before);
}

double runCold(const Field& field, const Vec3& p) {
  const auto before = Clock::now();
  const double sum = sumOf(field.sample(p));
  use(sum);
  const auto after = Clock::now();
  return nanoseconds(after - before);
}

}  // namespace

QueryTimes timeQueries(const Field& field, std::span<const Vec3> path,
                       std::span<const Vec3> scattered, int repeats, std::size_t cold_queries,
                       double clock_ns, CacheFlood& flood) {
  QueryTimes out;
  if (!path.empty()) {
    double independent = std::numeric_limits<double>::infinity();
    double dependent = independent;
    for (int i = 0; i < repeats; ++i) {
      independent = std::min(independent, runIndependent(field, path));
      dependent = std::min(dependent, runDependent(field, path));
    }
    const auto count = static_cast<double>(path.size());
    out.independent = independent / count;
    out.dependent = dependent / count;
  }
  std::vector<double> cold;
  const std::size_t queries = std::min(cold_queries, scattered.size());
  for (std::size_t i = 0; i < queries; ++i) {
    flood.run();
    cold.push_back(runCold(field, scattered[i * (scattered.size() / queries)]));
  }
  if (!cold.empty()) {
    const auto middle = cold.begin() + static_cast<std::ptrdiff_t>(cold.size() / 2);
    std::nth_element(cold.begin(), middle, cold.end());
    out.cold = std::max(0.0, *middle - clock_ns);
  }
  return out;
}

}  // namespace palpate::tools
