#pragma once
/// SeqLock: one thread stores a value, any number of threads load it, and no thread waits for
/// another.

#include <array>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <optional>
#include <type_traits>

namespace palpate::devices {

/// A value that one thread stores and others load whole. store() is real-time safe and never waits;
/// load() tries a few times. Words are atomic, after H.-J. Boehm, "Can seqlocks get along with
/// programming language memory models?", MSPC 2012.
template <typename Value>
class SeqLock {
  static_assert(std::is_trivially_copyable_v<Value>);

 public:
  void store(const Value& value) noexcept {
    std::array<std::uint64_t, kWords> words{};
    std::memcpy(words.data(), &value, sizeof(Value));
    const std::uint64_t turn = turn_.load(std::memory_order_relaxed);
    turn_.store(turn + 1, std::memory_order_relaxed);
    // A reader that sees one of the new words sees a changed turn as well, and tries again.
    for (std::size_t i = 0; i < kWords; ++i) words_[i].store(words[i], std::memory_order_release);
    turn_.store(turn + 2, std::memory_order_release);
  }

  /// No value before the first store(), or if the value changed during each of several attempts.
  [[nodiscard]] std::optional<Value> load() const noexcept {
    constexpr int kAttempts = 100;
    for (int i = 0; i < kAttempts; ++i) {
      const std::uint64_t before = turn_.load(std::memory_order_acquire);
      if (before == 0) return std::nullopt;
      if (before % 2 != 0) continue;
      std::array<std::uint64_t, kWords> words{};
      for (std::size_t k = 0; k < kWords; ++k) words[k] = words_[k].load(std::memory_order_acquire);
      if (turn_.load(std::memory_order_relaxed) != before) continue;
      Value value;
      std::memcpy(static_cast<void*>(&value), words.data(), sizeof(Value));
      return value;
    }
    return std::nullopt;
  }

 private:
  static constexpr std::size_t kWords = (sizeof(Value) + 7) / 8;
  std::atomic<std::uint64_t> turn_{0};
  std::array<std::atomic<std::uint64_t>, kWords> words_{};
};

}  // namespace palpate::devices
