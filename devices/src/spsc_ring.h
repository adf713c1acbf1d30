#pragma once
// A ring buffer between two threads: one puts items in, the other takes them out.

#include <atomic>
#include <cstddef>
#include <type_traits>
#include <vector>

namespace palpate::devices {

/// Fixed capacity, a power of two. Neither side ever waits for the other, locks or allocates.
template <typename Item>
class SpscRing {
  static_assert(std::is_trivially_copyable_v<Item>);

 public:
  /// Room for at least `least` items.
  explicit SpscRing(std::size_t least) {
    std::size_t size = 2;
    while (size < least) size *= 2;
    items_.resize(size);
  }

  [[nodiscard]] std::size_t capacity() const noexcept { return items_.size(); }

  // For the thread that puts in.

  [[nodiscard]] std::size_t room() const noexcept {
    return items_.size() -
           (put_.load(std::memory_order_relaxed) - taken_.load(std::memory_order_acquire));
  }
  /// Call this only if there is room.
  void put(const Item& item) noexcept {
    const std::size_t at = put_.load(std::memory_order_relaxed);
    items_[at & (items_.size() - 1)] = item;
    put_.store(at + 1, std::memory_order_release);
  }

  // For the thread that takes out.

  [[nodiscard]] std::size_t count() const noexcept {
    return put_.load(std::memory_order_acquire) - taken_.load(std::memory_order_relaxed);
  }
  /// Call this only if there is an item; valid until pop().
  [[nodiscard]] const Item& front() const noexcept {
    return items_[taken_.load(std::memory_order_relaxed) & (items_.size() - 1)];
  }
  void pop() noexcept {
    taken_.store(taken_.load(std::memory_order_relaxed) + 1, std::memory_order_release);
  }

 private:
  static constexpr std::size_t kCacheLine = 64;  // separates the two sides' indices
  alignas(kCacheLine) std::atomic<std::size_t> put_{0};
  alignas(kCacheLine) std::atomic<std::size_t> taken_{0};
  std::vector<Item> items_;
};

}  // namespace palpate::devices
