#pragma once
/// The number types that image and mesh files use.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <optional>
#include <string_view>
#include <type_traits>

namespace palpate::vdb {

enum class Scalar {
  kUint8,
  kInt8,
  kUint16,
  kInt16,
  kUint32,
  kInt32,
  kUint64,
  kInt64,
  kFloat32,
  kFloat64
};

/// Calls use() with a 0 of that type.
template <typename Use>
decltype(auto) withKind(Scalar kind, const Use& use) {
  switch (kind) {
    case Scalar::kUint8:
      return use(std::uint8_t{});
    case Scalar::kInt8:
      return use(std::int8_t{});
    case Scalar::kUint16:
      return use(std::uint16_t{});
    case Scalar::kInt16:
      return use(std::int16_t{});
    case Scalar::kUint32:
      return use(std::uint32_t{});
    case Scalar::kInt32:
      return use(std::int32_t{});
    case Scalar::kUint64:
      return use(std::uint64_t{});
    case Scalar::kInt64:
      return use(std::int64_t{});
    case Scalar::kFloat32:
      return use(float{});
    case Scalar::kFloat64:
      break;
  }
  return use(double{});
}

[[nodiscard]] inline std::size_t bytesOf(Scalar kind) noexcept {
  return withKind(kind, [](auto zero) { return sizeof zero; });
}
[[nodiscard]] inline bool isInteger(Scalar kind) noexcept {
  return withKind(kind, [](auto zero) { return std::is_integral_v<decltype(zero)>; });
}

/// "uint8"
[[nodiscard]] const char* nameOf(Scalar kind) noexcept;

/// A format's name for a type.
struct ScalarName {
  std::string_view name;
  Scalar kind;
};

/// The type whose name in `names` is `name`; nothing if there is none.
template <typename Names>
[[nodiscard]] std::optional<Scalar> scalarCalled(std::string_view name, const Names& names) {
  const auto at = std::find_if(std::begin(names), std::end(names),
                               [&](const ScalarName& known) { return known.name == name; });
  return at == std::end(names) ? std::nullopt : std::optional(at->kind);
}

}  // namespace palpate::vdb
