#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <system_error>
#include <utility>

#include "palpate/core/error.h"
#include "palpate/devices/path.h"

namespace palpate::devices {
namespace {

constexpr std::string_view kHeader = "t,x,y,z";
constexpr std::string_view kDeviceHeader = "t,device_x,device_y,device_z";
constexpr std::size_t kColumns = 4;
constexpr std::array<const char*, kColumns> kNames{"t", "x", "y", "z"};

/// Reads lines from a file that is read in pieces, so that a file of any length takes little
/// memory.
class LineReader {
 public:
  explicit LineReader(const std::string& file)
      : file_(file), stream_(file, std::ios::binary), buffer_(kPiece) {}

  [[nodiscard]] bool isOpen() const { return stream_.is_open(); }
  [[nodiscard]] bool failed() const { return stream_.bad(); }

  /// The next line without its end, or false at the end of the file. Valid until the next call.
  bool next(std::string_view& line) {
    while (true) {
      const char* begin = buffer_.data() + begin_;
      const auto* end = static_cast<const char*>(std::memchr(begin, '\n', end_ - begin_));
      if (end != nullptr) {
        line = {begin, static_cast<std::size_t>(end - begin)};
        begin_ += line.size() + 1;
        break;
      }
      if (at_end_) {
        if (begin_ == end_) return false;
        line = {begin, end_ - begin_};
        begin_ = end_;
        break;
      }
      refill();
    }
    ++number_;
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    return true;
  }

  /// An error in the line that next() returned last.
  [[nodiscard]] Error error(std::string code, std::string message, std::string hint,
                            std::string_view line, std::size_t column) const {
    Problem problem{std::move(code), std::move(message), std::move(hint), file_, number_};
    problem.column = static_cast<int>(column) + 1;
    problem.excerpt = printable(line);
    return {ErrorKind::kInput, std::move(problem)};
  }

  /// A text that can safely be printed on a terminal, since the file can contain anything.
  static std::string printable(std::string_view text) {
    constexpr std::size_t kLongest = 160;
    std::string out(text.substr(0, kLongest));
    for (char& c : out) {
      if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
    }
    if (text.size() > kLongest) out += "...";
    return out;
  }

 private:
  static constexpr std::size_t kPiece = std::size_t{1} << 20U;

  void refill() {
    std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
    end_ -= begin_;
    begin_ = 0;
    if (end_ == buffer_.size()) {
      // A line that fills the whole buffer cannot be a row of four numbers: return it as it is.
      at_end_ = true;
      return;
    }
    stream_.read(buffer_.data() + end_, static_cast<std::streamsize>(buffer_.size() - end_));
    end_ += static_cast<std::size_t>(stream_.gcount());
    at_end_ = !stream_;
  }

  std::string file_;
  std::ifstream stream_;
  std::vector<char> buffer_;
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  int number_ = 0;
  bool at_end_ = false;
};

/// True if `line` is exactly four numbers between commas, which must be finite for kSound.
bool parseRow(std::string_view line, PathRules rules, std::array<double, kColumns>& out) {
  const char* at = line.data();
  const char* end = at + line.size();
  for (std::size_t i = 0; i < kColumns; ++i) {
    const auto [after, error] = std::from_chars(at, end, out[i]);
    if (error != std::errc{}) return false;
    if (rules == PathRules::kSound && !std::isfinite(out[i])) return false;
    at = after;
    if (i + 1 == kColumns) return at == end;
    if (at == end || *at != ',') return false;
    ++at;
  }
  return false;
}

/// Finds out why parseRow() refused a line.
Error badRow(const LineReader& reader, std::string_view line) {
  const std::string hint = "a row is four plain numbers between commas: t [s], x, y, z [m]";
  if (line.empty()) return reader.error("path.blank", "blank line", hint, line, 0);
  if (line.front() == '#' || line.substr(0, 2) == "//") {
    return reader.error("path.comment", "comments are not allowed here", "remove this line", line,
                        0);
  }
  const auto columns = static_cast<std::size_t>(std::count(line.begin(), line.end(), ',')) + 1;
  if (columns != kColumns) {
    return reader.error("path.columns", std::to_string(columns) + " columns instead of 4 (t,x,y,z)",
                        hint, line, 0);
  }
  std::size_t start = 0;
  for (const char* name : kNames) {
    const std::size_t stop = std::min(line.find(',', start), line.size());
    const std::string_view text = line.substr(start, stop - start);
    double value = 0.0;
    const auto [after, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const std::string what = std::string(name) + " = '" + LineReader::printable(text) + "'";
    const bool whole = !text.empty() && after == text.data() + text.size();
    if (whole && (error == std::errc::result_out_of_range ||
                  (error == std::errc{} && !std::isfinite(value)))) {
      return reader.error("path.not_finite", what + " is not finite, or too large or small to hold",
                          hint, line, start);
    }
    if (!whole || error != std::errc{}) {
      return reader.error("path.number", what + " is not a number", hint, line, start);
    }
    start = stop + 1;
  }
  return reader.error("path.number", "not a row of four numbers", hint, line, 0);
}

DeviceFrame readHeader(LineReader& reader, const std::string& file) {
  std::string_view line;
  if (!reader.next(line)) {
    throw inputError("path.empty", "the file is empty",
                     "it must begin with the line t,x,y,z and hold one row a tick", file);
  }
  if (line == kHeader) return DeviceFrame::kWorld;
  if (line == kDeviceHeader) return DeviceFrame::kDevice;
  const bool has_mark = line.substr(0, 3) == "\xEF\xBB\xBF";
  throw reader.error("path.header",
                     has_mark ? "the file begins with a byte order mark"
                              : "the first line must be exactly t,x,y,z",
                     has_mark
                         ? "save it as plain UTF-8, without the mark"
                         : "put the header t,x,y,z (s, m, m, m) on the first line, or "
                           "t,device_x,device_y,device_z for positions in a device's own frame",
                     line, 0);
}

}  // namespace

RecordedPath readPath(const std::string& file, PathRules rules) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) {
    throw inputError("path.unreadable", "this is a folder, not a file", "give a CSV file", file);
  }
  LineReader reader(file);
  if (!reader.isOpen()) {
    const bool exists = std::filesystem::exists(file, ignored);
    throw inputError("path.unreadable",
                     exists ? "the file cannot be opened" : "there is no such file",
                     exists ? "check its permissions" : "check the path and its spelling", file);
  }
  RecordedPath recorded{.points = {}, .frame = readHeader(reader, file)};
  Path& path = recorded.points;
  std::string_view line;
  std::array<double, kColumns> row{};
  while (reader.next(line)) {
    if (!parseRow(line, rules, row)) throw badRow(reader, line);
    if (rules == PathRules::kSound && !path.empty() && !(row[0] > path.back().t)) {
      throw reader.error(
          "path.time",
          "t = '" + std::string(line.substr(0, line.find(','))) +
              "' does not come after the row before it",
          "times must rise from row to row; to feel a record with its faults, take it as "
          "recorded (on the command line --as-recorded)",
          line, 0);
    }
    path.push_back({row[0], {row[1], row[2], row[3]}});
  }
  if (reader.failed()) {
    throw inputError("path.unreadable", "reading failed before the end of the file", {}, file);
  }
  if (path.empty()) {
    throw inputError("path.empty", "there is a header but no row", "add one row a tick", file);
  }
  return recorded;
}

}  // namespace palpate::devices
