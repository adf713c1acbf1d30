#pragma once
/// Collects the shortest times over all repetitions, as a table and as JSON under the machine's
/// name.

#include <benchmark/benchmark.h>

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/machine.h"

namespace palpate::bench {

/// [ns] Times of a query, for one sampler on one shape.
struct Times {
  double independent = 0.0;
  double dependent = 0.0;
};

/// Names of benchmarks are "shape|sampler|independent" and "...|dependent".
class Results final : public benchmark::BenchmarkReporter {
 public:
  /// Adds a row to the table, which keeps this order; benchmarks may run in any order.
  void expect(const std::string& shape, const std::string& sampler) { (void)at(shape, sampler); }

  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override;

  [[nodiscard]] std::string table() const;
  [[nodiscard]] nlohmann::ordered_json json(const tools::Machine& machine) const;

 private:
  struct Shape {
    std::string name;
    std::vector<std::pair<std::string, Times>> samplers;
  };
  [[nodiscard]] Times& at(const std::string& shape, const std::string& sampler);
  [[nodiscard]] static Times yardstickOf(const Shape& shape);

  std::vector<Shape> shapes_;
};

}  // namespace palpate::bench
