#include "grid/vdb_walk.h"

#include <openvdb/version.h>

#include <algorithm>
#include <array>
#include <bit>
#include <map>
#include <optional>
#include <string_view>
#include <tuple>

#include "grid/vdb_bytes.h"

namespace palpate::vdb {
namespace {

constexpr std::int64_t kMagic = 0x56444220;
constexpr std::uint32_t kOldest = 222;
constexpr std::uint32_t kNewest = openvdb::OPENVDB_FILE_VERSION;
constexpr std::int64_t kUuidBytes = 36;
constexpr std::uint32_t kLongestName = 1U << 16U;
constexpr std::uint32_t kLongestText = 1U << 26U;  ///< of metadata, which may hold whole documents
constexpr std::uint32_t kZip = 1;
constexpr std::uint32_t kActiveMask = 2;
constexpr std::uint32_t kBlosc = 4;
constexpr std::int64_t kBloscHead = 16;
constexpr std::int32_t kRootChild = 4096;  ///< voxels along a child of the root

[[noreturn]] void fail(const std::string& what) { throw std::runtime_error(what); }

/// Bytes of a voxel's value, and of the same value as half floats.
struct ValueKind {
  std::int64_t bytes;
  std::int64_t half_bytes;
  enum class Leaf { kNumbers, kBool, kMask } leaf = Leaf::kNumbers;
};

std::optional<ValueKind> kindOf(std::string_view grid_type) {
  using Leaf = ValueKind::Leaf;
  static const std::map<std::string_view, ValueKind> kinds = {{"float", {4, 2}},
                                                              {"double", {8, 2}},
                                                              {"int32", {4, 4}},
                                                              {"uint32", {4, 4}},
                                                              {"int64", {8, 8}},
                                                              {"vec2s", {8, 4}},
                                                              {"vec2d", {16, 4}},
                                                              {"vec2i", {8, 8}},
                                                              {"vec3s", {12, 6}},
                                                              {"vec3d", {24, 6}},
                                                              {"vec3i", {12, 12}},
                                                              {"bool", {1, 1, Leaf::kBool}},
                                                              {"mask", {1, 1, Leaf::kMask}}};
  constexpr std::string_view kBegin = "Tree_";
  constexpr std::string_view kEnd = "_5_4_3";
  if (!grid_type.starts_with(kBegin) || !grid_type.ends_with(kEnd)) return {};
  grid_type.remove_prefix(kBegin.size());
  grid_type.remove_suffix(std::min(grid_type.size(), kEnd.size()));
  const auto found = kinds.find(grid_type);
  return found == kinds.end() ? std::nullopt : std::optional(found->second);
}

/// Size of metadata whose type fixes it: OpenVDB reads that many bytes, whatever size the file
/// states.
std::optional<std::uint32_t> fixedBytes(const std::string& type) {
  static const std::map<std::string, std::uint32_t> sizes = {
      {"bool", 1},   {"int32", 4},  {"int64", 8},  {"float", 4},  {"double", 8}, {"vec2i", 8},
      {"vec2s", 8},  {"vec2d", 16}, {"vec3i", 12}, {"vec3s", 12}, {"vec3d", 24}, {"vec4i", 16},
      {"vec4s", 16}, {"vec4d", 32}, {"mat4s", 64}, {"mat4d", 128}};
  const auto found = sizes.find(type);
  return found == sizes.end() ? std::nullopt : std::optional(found->second);
}

std::optional<std::int64_t> mapBytes(const std::string& type) {
  constexpr std::int64_t kVector = 24;
  if (type == "TranslationMap") return kVector;
  if (type == "ScaleMap" || type == "UniformScaleMap") return 5 * kVector;
  if (type == "ScaleTranslateMap" || type == "UniformScaleTranslateMap") return 6 * kVector;
  if (type == "AffineMap" || type == "UnitaryMap") return 128;
  return {};
}

int countOn(const std::vector<std::uint64_t>& mask) {
  int on = 0;
  for (const std::uint64_t word : mask) on += std::popcount(word);
  return on;
}

}  // namespace

class VdbWalk::Impl {
 public:
  explicit Impl(std::istream& stream) : bytes_(stream) {}

  void heads() {
    bytes_.seek(0);
    header();
    metadata();
    const auto grids = bytes_.take<std::int32_t>();
    if (grids < 0) fail("it says that it holds " + std::to_string(grids) + " grids");
    for (std::int32_t i = 0; i < grids; ++i) descriptor();
    bytes_.stream().seekg(0);
  }

  void tree(std::int64_t position, const std::string& type, bool is_half, bool with_voxels) {
    const auto before = bytes_.stream().tellg();
    if (version_ == 0) heads();
    bytes_.seek(position);
    gridHead();
    treeHere(type, is_half, with_voxels);
    bytes_.stream().seekg(before);
  }

 private:
  void header() {
    if (bytes_.take<std::int64_t>() != kMagic) fail("it does not begin as a .vdb file does");
    version_ = bytes_.take<std::uint32_t>();
    if (version_ < kOldest) {
      fail("it is of format " + std::to_string(version_) + ", older than " +
           std::to_string(kOldest) + "; open and save it with OpenVDB 3 or later");
    }
    if (version_ > kNewest) {
      fail("it is of format " + std::to_string(version_) + ", newer than " +
           std::to_string(kNewest));
    }
    bytes_.skip(8);  // the library's version
    has_offsets_ = bytes_.take<std::uint8_t>() != 0;
    bytes_.skip(kUuidBytes);
  }

  void metadata() {
    const auto count = bytes_.take<std::uint32_t>();
    for (std::uint32_t i = 0; i < count; ++i) {
      static_cast<void>(bytes_.takeText(kLongestName));
      const std::string type = bytes_.takeText(kLongestName);
      const auto size = bytes_.take<std::uint32_t>();
      const auto fixed = fixedBytes(type);
      if ((fixed && *fixed != size) || size > kLongestText || size > bytes_.left()) {
        fail("metadata of " + std::to_string(size) + " bytes for a value of type " + type);
      }
      const std::int64_t end = bytes_.position() + size;
      if (type == "__delayedload") delayedLoad(size, end);
      bytes_.seek(end);
    }
  }

  /// Two lists with an entry for each leaf; each list is a count of packed bytes (0: not packed),
  /// and its bytes.
  void delayedLoad(std::uint32_t size, std::int64_t end) {
    if (size == 0) return;  // a tree without leaves
    if (size < 4) fail("an index of leaves that is cut short");
    const auto leaves = bytes_.take<std::uint32_t>();
    // Every leaf has two masks of 64 bytes, one in the tree's topology and one among its values.
    if (leaves > bytes_.left() / 64) fail("an index of more leaves than the file can hold");
    for (const std::int64_t entry : {1, 8}) {
      if (bytes_.position() >= end) break;
      const auto packed = bytes_.take<std::uint32_t>();
      const std::int64_t plain = entry * static_cast<std::int64_t>(leaves);
      const std::int64_t here = packed > 0 ? packed : plain;
      if (entry == 8 && packed == 0xFFFFFFFFU) break;
      if (here > end - bytes_.position()) fail("an index of leaves that is cut short");
      const std::int64_t next = bytes_.position() + here;
      if (packed > 0) bloscHead(packed, plain);
      bytes_.seek(next);
    }
  }

  void descriptor() {
    static_cast<void>(bytes_.takeText(kLongestName));
    std::string type = bytes_.takeText(kLongestName);
    const bool is_instance = !bytes_.takeText(kLongestName).empty();
    const auto grid = bytes_.take<std::int64_t>();
    static_cast<void>(bytes_.take<std::int64_t>());  // where its voxels begin; not needed
    const auto end = bytes_.take<std::int64_t>();
    if (!has_offsets_) {
      gridHead();
      constexpr std::string_view kHalf = "_HalfFloat";
      const bool is_half = type.ends_with(kHalf);
      if (is_half) type.resize(type.size() - kHalf.size());
      if (!is_instance) treeHere(type, is_half, true);
      return;
    }
    // Each grid must lie behind the one before; otherwise a damaged file could keep its reader here
    // for ever.
    if (grid < bytes_.position() || end <= grid) fail("its table of contents is inconsistent");
    bytes_.seek(grid);
    gridHead();
    if (end < bytes_.position()) fail("its table of contents is inconsistent");
    bytes_.seek(end);
  }

  void gridHead() {
    compression_ = bytes_.take<std::uint32_t>();
    if (compression_ > (kZip | kActiveMask | kBlosc)) {
      fail("compression " + std::to_string(compression_) + " is unknown");
    }
    metadata();
    const std::string map = bytes_.takeText(kLongestName);
    if (map == "NonlinearFrustumMap") {
      bytes_.skip(48 + 8 + 8);  // its box, taper and depth
      skipMap(bytes_.takeText(kLongestName));
    } else {
      skipMap(map);
    }
  }

  void skipMap(const std::string& type) {
    const auto size = mapBytes(type);
    if (!size) fail("a transform of kind '" + type.substr(0, 40) + "'");
    bytes_.skip(*size);
  }

  void treeHere(const std::string& type, bool is_half, bool with_voxels) {
    const auto kind = kindOf(type);
    if (!kind) fail("a grid of kind '" + type.substr(0, 60) + "' cannot be read");
    kind_ = *kind;
    is_half_ = is_half && kind_.half_bytes != kind_.bytes;
    leaves_.clear();
    bytes_.skip(4);            // a count of buffers, which is always one
    bytes_.skip(kind_.bytes);  // the background
    const auto tiles = bytes_.take<std::uint32_t>();
    const auto children = bytes_.take<std::uint32_t>();
    for (std::uint32_t i = 0; i < tiles; ++i) {
      rootPlace();
      bytes_.skip(kind_.bytes);
      if (bytes_.take<std::uint8_t>() > 1) fail("a tile with an invalid activity flag");
    }
    using Place = std::array<std::int32_t, 3>;
    std::optional<Place> last;
    for (std::uint32_t i = 0; i < children; ++i) {
      // OpenVDB keeps children sorted, and writes and reads them in that order.
      const Place place = rootPlace();
      if (last && !(*last < place)) fail("parts of its tree that are out of order");
      last = place;
      node<5, true>(place);
    }
    if (!with_voxels) return;
    for (const Leaf& leaf : leaves_) voxels(leaf);
  }

  std::array<std::int32_t, 3> rootPlace() {
    std::array<std::int32_t, 3> place{};
    bytes_.take(place.data(), sizeof place);
    for (const std::int32_t c : place) {
      if (c % kRootChild != 0) fail("a part of its tree at a place where none can be");
    }
    return place;
  }

  std::vector<std::uint64_t> mask(std::size_t bits) {
    std::vector<std::uint64_t> words(bits / 64);
    bytes_.take(words.data(), static_cast<std::int64_t>(bits / 8));
    return words;
  }

  template <int Log2, bool HasNodes>
  void node(const std::array<std::int32_t, 3>& place) {
    constexpr std::size_t kValues = std::size_t{1} << (3U * Log2);
    const auto children = mask(kValues);
    const auto active = mask(kValues);
    values(kValues, active);
    constexpr std::int32_t kStep = HasNodes ? 128 : 8;
    for (std::size_t i = 0; i < kValues; ++i) {
      if ((children[i / 64] >> (i % 64) & 1U) == 0) continue;
      const auto x = static_cast<std::int32_t>(i >> (2U * Log2));
      const auto y = static_cast<std::int32_t>(i >> Log2 & ((1U << Log2) - 1));
      const auto z = static_cast<std::int32_t>(i & ((1U << Log2) - 1));
      const std::array<std::int32_t, 3> inner = {place[0] + kStep * x, place[1] + kStep * y,
                                                 place[2] + kStep * z};
      if constexpr (HasNodes) {
        node<4, false>(inner);
      } else {
        leaves_.push_back({inner, mask(512)});
      }
    }
  }

  /// Checks `count` values as OpenVDB packs them; `active` is the mask of the active ones.
  void values(std::size_t count, const std::vector<std::uint64_t>& active) {
    constexpr int kMaskAndOne = 4;
    constexpr int kMaskAndTwo = 5;
    constexpr int kAllValues = 6;
    const auto how = static_cast<int>(bytes_.take<std::int8_t>());
    if (how < 0 || how > kAllValues) fail("values that are packed in no known way");
    if (how == 2 || how == kMaskAndOne || how == kMaskAndTwo) bytes_.skip(kind_.bytes);
    if (how == kMaskAndTwo) bytes_.skip(kind_.bytes);
    if (how == 3 || how == kMaskAndOne || how == kMaskAndTwo) {
      bytes_.skip(static_cast<std::int64_t>(count / 8));
    }
    std::int64_t stored = static_cast<std::int64_t>(count);
    if ((compression_ & kActiveMask) != 0 && how != kAllValues) stored = countOn(active);
    if (is_half_ && stored == 0) return;
    chunk(stored * (is_half_ ? kind_.half_bytes : kind_.bytes));
  }

  void chunk(std::int64_t plain) {
    if ((compression_ & (kBlosc | kZip)) == 0) return bytes_.skip(plain);
    const auto packed = bytes_.take<std::int64_t>();
    if (packed <= 0) {
      // Not packed, and -packed is the size: OpenVDB reads that many bytes before it checks the
      // size.
      if (packed != -plain) fail("a number of voxels that differs from that of its tree");
      return bytes_.skip(plain);
    }
    if (packed > bytes_.left()) throw std::ios_base::failure("the end of the file");
    const std::int64_t end = bytes_.position() + packed;
    if ((compression_ & kBlosc) != 0) bloscHead(packed, plain);
    bytes_.seek(end);
  }

  /// Checks the header that Blosc trusts: how many bytes there are, and how many they unpack to.
  void bloscHead(std::int64_t packed, std::int64_t plain) {
    if (packed < kBloscHead) fail("packed voxels that are cut short");
    bytes_.skip(4);
    const std::int64_t unpacked = bytes_.take<std::uint32_t>();
    const std::int64_t block = bytes_.take<std::uint32_t>();
    const std::int64_t whole = bytes_.take<std::uint32_t>();
    // OpenVDB pads short buffers before it packs them, and removes the padding after unpacking.
    constexpr std::int64_t kPadded = 128;
    const bool fits = unpacked == plain || (plain < kPadded && unpacked == kPadded);
    if (!fits || whole != packed || block > std::max<std::int64_t>(unpacked, 1)) {
      fail("a number of packed voxels that differs from that of its tree");
    }
  }

  struct Leaf {
    std::array<std::int32_t, 3> place;
    std::vector<std::uint64_t> active;
  };

  void voxels(const Leaf& leaf) {
    if (mask(512) != leaf.active) fail("two lists of active voxels that differ");
    if (kind_.leaf == ValueKind::Leaf::kNumbers) return values(512, leaf.active);
    std::array<std::int32_t, 3> place{};
    bytes_.take(place.data(), sizeof place);
    if (place != leaf.place) fail("voxels that are not where its tree has them");
    if (kind_.leaf == ValueKind::Leaf::kBool) bytes_.skip(64);
  }

  VdbBytes bytes_;
  std::uint32_t version_ = 0;
  bool has_offsets_ = false;
  std::uint32_t compression_ = 0;
  ValueKind kind_{4, 2};
  bool is_half_ = false;
  std::vector<Leaf> leaves_;
};

VdbWalk::VdbWalk(std::istream& stream) : impl_(std::make_unique<Impl>(stream)) {}
VdbWalk::~VdbWalk() = default;
void VdbWalk::checkHeads() { impl_->heads(); }
void VdbWalk::checkTree(std::int64_t grid_position, const std::string& grid_type, bool is_half,
                        bool with_voxels) {
  impl_->tree(grid_position, grid_type, is_half, with_voxels);
}
bool VdbWalk::canWalk(const std::string& grid_type) { return kindOf(grid_type).has_value(); }

}  // namespace palpate::vdb
