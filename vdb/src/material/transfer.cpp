#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "palpate/core/error.h"
#include "palpate/vdb/material_grid.h"

namespace palpate::vdb {
namespace {

void check(const Transfer& transfer) {
  if (transfer.empty()) throw inputError("material.transfer", "the transfer function has no point");
  for (std::size_t i = 1; i < transfer.size(); ++i) {
    if (transfer[i].first > transfer[i - 1].first) continue;
    throw inputError("material.transfer",
                     "the transfer function does not go from smaller to larger image values",
                     "each point's first number must be more than that of the point before");
  }
}

double at(const Transfer& transfer, double value) noexcept {
  const auto above = std::upper_bound(transfer.begin(), transfer.end(), value,
                                      [](double v, const auto& point) { return v < point.first; });
  if (above == transfer.begin()) return transfer.front().second;
  if (above == transfer.end()) return transfer.back().second;
  const auto& [x0, y0] = *(above - 1);
  const auto& [x1, y1] = *above;
  return y0 + (y1 - y0) * ((value - x0) / (x1 - x0));
}

}  // namespace

MaterialGridPtr materialFromImage(const Image& image, const Transfer& transfer, double tolerance,
                                  std::uint64_t max_memory) {
  check(transfer);
  Image mapped;
  mapped.source = image.source;
  mapped.size = image.size;
  mapped.axes = image.axes;
  mapped.origin = image.origin;
  mapped.values.resize(image.values.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, image.values.size()), [&](const auto& r) {
    for (std::size_t i = r.begin(); i != r.end(); ++i) {
      const float value = image.values[i];
      mapped.values[i] =
          std::isnan(value) ? value : static_cast<float>(at(transfer, static_cast<double>(value)));
    }
  });
  return std::make_shared<MaterialGrid>(std::move(mapped), tolerance, max_memory);
}

}  // namespace palpate::vdb
