#pragma once
/// Runs work in a child process with limits, and hands its result back.

#include <cstdint>
#include <cstring>
#include <functional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace palpate::vdb {

/// The result of a child, as bytes. Both ends are this process's own code, of one build.
class ChildWriter {
 public:
  template <typename T>
  void put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    put(&value, sizeof value);
  }
  template <typename T>
  void put(const std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    put<std::uint64_t>(values.size());
    put(values.data(), values.size() * sizeof(T));
  }
  void put(const std::string& text) {
    put<std::uint64_t>(text.size());
    put(text.data(), text.size());
  }
  [[nodiscard]] const std::string& bytes() const noexcept { return bytes_; }

 private:
  void put(const void* data, std::size_t size) {
    bytes_.append(static_cast<const char*>(data), size);
  }
  std::string bytes_;
};

/// Takes values in the order in which they were put. @throws std::out_of_range if fewer bytes are
/// left than asked for.
class ChildReader {
 public:
  explicit ChildReader(std::string bytes) : bytes_(std::move(bytes)) {}

  template <typename T>
  T take() {
    T value{};
    copy(&value, sizeof value);
    return value;
  }
  template <typename T>
  std::vector<T> takeAll() {
    const auto count = take<std::uint64_t>();
    if (count > (bytes_.size() - at_) / sizeof(T)) throw std::out_of_range("a child's result");
    std::vector<T> values(count);
    copy(values.data(), count * sizeof(T));
    return values;
  }
  std::string takeText() {
    const std::vector<char> text = takeAll<char>();
    return {text.begin(), text.end()};
  }

 private:
  void copy(void* to, std::size_t size) {
    if (size > bytes_.size() - at_) throw std::out_of_range("a child's result");
    if (size > 0) std::memcpy(to, bytes_.data() + at_, size);
    at_ += size;
  }
  std::string bytes_;
  std::size_t at_ = 0;
};

struct ChildTask {
  std::uint64_t file_bytes = 0;  ///< size of the file that the limits depend on
  std::string code;              ///< code of the error if the child dies: "mesh.unreadable"
  std::string library;           ///< "Assimp"
  std::string hint;
  std::string path;
};

/// Runs `work` in a child with the limits of libraryLimits(), and returns what the child wrote.
/// `work` must need no thread but its own. An Error that it throws is thrown here. Polls the stop
/// flag while it waits.
/// @throws Error (kInput, `code`) if the child crashed, took too long or too much memory;
/// kOperation if no child can be made; kCancelled.
[[nodiscard]] ChildReader runInChild(const ChildTask& task,
                                     const std::function<void(ChildWriter&)>& work);

}  // namespace palpate::vdb
