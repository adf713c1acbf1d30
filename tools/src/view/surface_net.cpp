#include "view/surface_net.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

namespace palpate::tools {
namespace {

static_assert(std::endian::native == std::endian::little, "surfaces travel as they are in memory");

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// The corners of cubic cells, with their values.
class Lattice {
 public:
  Lattice(const Field& field, const Box3& box, int cells) : lo_(box.lo) {
    const Vec3 size = box.size();
    step_ = std::max({size.x, size.y, size.z}) / cells;
    for (int i = 0; i < 3; ++i) {
      count_[at(i)] = std::max(1, static_cast<int>(std::ceil(size[i] / step_ - 1e-9))) + 1;
    }
    values_.resize(index({0, 0, count_[2] - 1}) + index({count_[0] - 1, count_[1] - 1, 0}) + 1);
    PointBatch batch{};
    ValueBatch out{};
    std::size_t done = 0;
    for (std::size_t first = 0; first < values_.size(); first += PointBatch::kCount) {
      const std::size_t used = std::min(PointBatch::kCount, values_.size() - first);
      for (std::size_t n = 0; n < PointBatch::kCount; ++n) {
        const Vec3 p = point(std::min(first + n, values_.size() - 1));
        batch.x[n] = p.x;
        batch.y[n] = p.y;
        batch.z[n] = p.z;
      }
      field.values(batch, out);
      for (std::size_t n = 0; n < used; ++n) values_[done++] = out[n];
    }
  }

  using Corner = std::array<int, 3>;

  [[nodiscard]] std::size_t index(const Corner& c) const {
    return static_cast<std::size_t>(c[0]) +
           static_cast<std::size_t>(count_[0]) *
               (static_cast<std::size_t>(c[1]) +
                static_cast<std::size_t>(count_[1]) * static_cast<std::size_t>(c[2]));
  }
  [[nodiscard]] Vec3 point(const Corner& c) const { return lo_ + step_ * Vec3(c[0], c[1], c[2]); }
  [[nodiscard]] double value(const Corner& c) const { return values_[index(c)]; }
  [[nodiscard]] const std::array<int, 3>& corners() const { return count_; }
  [[nodiscard]] double step() const { return step_; }
  [[nodiscard]] std::size_t size() const { return values_.size(); }

 private:
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  [[nodiscard]] Vec3 point(std::size_t index) const {
    const auto nx = static_cast<std::size_t>(count_[0]);
    const auto ny = static_cast<std::size_t>(count_[1]);
    return point(Corner{static_cast<int>(index % nx), static_cast<int>(index / nx % ny),
                        static_cast<int>(index / nx / ny)});
  }

  Vec3 lo_;
  double step_ = 0.0;
  std::array<int, 3> count_{};
  std::vector<double> values_;
};

bool isInside(double value) { return value < 0.0; }

/// [m] Distance to first order; 0 where the gradient vanishes.
double distanceOf(const FieldSample& sample) {
  const double slope = glm::length(sample.gradient);
  return slope > 0.0 ? std::fabs(sample.value) / slope : 0.0;
}

/// Makes the points of cells on demand.
class Net {
 public:
  Net(const Field& field, const Lattice& lattice, SurfaceNet& out)
      : field_(field), lattice_(lattice), out_(out), known_(lattice.size(), kNone) {}

  /// The point of the cell whose lowest corner is `cell`.
  std::uint32_t pointOf(const Lattice::Corner& cell) {
    std::uint32_t& known = known_[lattice_.index(cell)];
    if (known != kNone) return known;
    Vec3 sum(0.0);
    int count = 0;
    for (int axis = 0; axis < 3; ++axis) {
      for (int edge = 0; edge < 4; ++edge) {
        Lattice::Corner a = cell;
        a[static_cast<std::size_t>((axis + 1) % 3)] += edge & 1;
        a[static_cast<std::size_t>((axis + 2) % 3)] += edge >> 1;
        Lattice::Corner b = a;
        ++b[static_cast<std::size_t>(axis)];
        const double va = lattice_.value(a);
        const double vb = lattice_.value(b);
        if (isInside(va) == isInside(vb)) continue;
        const double share = std::clamp(va / (va - vb), 0.0, 1.0);
        sum += lattice_.point(a) + share * (lattice_.point(b) - lattice_.point(a));
        ++count;
      }
    }
    const Vec3 p = onSurface(field_, sum / static_cast<double>(count), 0.5 * lattice_.step());
    known = static_cast<std::uint32_t>(out_.points.size());
    out_.points.push_back(p);
    out_.normals.push_back(unitOr(field_.sample(p).gradient, Vec3(0.0, 0.0, 1.0)));
    return known;
  }

  void quad(const std::array<Lattice::Corner, 4>& cells, bool is_turned) {
    std::array<std::uint32_t, 4> p{};
    for (std::size_t i = 0; i < 4; ++i) p[i] = pointOf(cells[i]);
    if (is_turned) std::swap(p[1], p[3]);
    out_.triangles.push_back({p[0], p[1], p[2]});
    out_.triangles.push_back({p[0], p[2], p[3]});
  }

 private:
  const Field& field_;
  const Lattice& lattice_;
  SurfaceNet& out_;
  std::vector<std::uint32_t> known_;
};

double errorOf(const Field& field, const SurfaceNet& net) {
  double most = 0.0;
  for (const auto& t : net.triangles) {
    const Vec3 middle = (net.points[t[0]] + net.points[t[1]] + net.points[t[2]]) / 3.0;
    const FieldSample sample = field.sample(middle);
    if (sample.in_band) most = std::max(most, distanceOf(sample));
  }
  return most;
}

template <typename Value>
void append(std::string& bytes, const Value& value) {
  std::array<char, sizeof(Value)> raw{};
  std::memcpy(raw.data(), &value, sizeof(Value));
  bytes.append(raw.data(), raw.size());
}

void appendVector(std::string& bytes, const Vec3& v) {
  for (int i = 0; i < 3; ++i) append(bytes, static_cast<float>(v[i]));
}

}  // namespace

Vec3 onSurface(const Field& field, Vec3 p, double reach) {
  constexpr int kSteps = 5;
  const Vec3 begin = p;
  for (int i = 0; i < kSteps; ++i) {
    const FieldSample sample = field.sample(p);
    const double slope = glm::dot(sample.gradient, sample.gradient);
    if (!(slope > 0.0) || sample.value == 0.0) break;
    const Vec3 next = p - sample.value / slope * sample.gradient;
    if (!isFinite(next) || glm::length(next - begin) > reach) break;
    p = next;
  }
  return p;
}

SurfaceNet surfaceNet(const Field& field, const Box3& box, int cells) {
  SurfaceNet out;
  out.cells = cells;
  const Lattice lattice(field, box, cells);
  Net net(field, lattice, out);
  const auto& count = lattice.corners();
  for (int z = 0; z < count[2]; ++z) {
    for (int y = 0; y < count[1]; ++y) {
      for (int x = 0; x < count[0]; ++x) {
        const Lattice::Corner here = {x, y, z};
        const bool is_inside = isInside(lattice.value(here));
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const std::size_t u = (axis + 1) % 3;
          const std::size_t v = (axis + 2) % 3;
          // For an edge in the interior of the lattice: four cells share it.
          if (here[axis] + 1 >= count[axis] || here[u] == 0 || here[v] == 0) continue;
          if (here[u] + 1 >= count[u] || here[v] + 1 >= count[v]) continue;
          Lattice::Corner next = here;
          ++next[axis];
          if (isInside(lattice.value(next)) == is_inside) continue;
          std::array<Lattice::Corner, 4> cells_around = {here, here, here, here};
          --cells_around[0][u];
          --cells_around[0][v];
          --cells_around[1][v];
          --cells_around[3][u];
          net.quad(cells_around, !is_inside);
        }
      }
    }
  }
  out.error = errorOf(field, out);
  return out;
}

SurfaceNet surfaceWithin(const Field& field, const Box3& box, double tolerance) {
  SurfaceNet net;
  for (const int cells : {32, 64, 128}) {
    net = surfaceNet(field, box, cells);
    if (!net.triangles.empty() && net.error <= tolerance) break;
  }
  return net;
}

std::string surfaceBytes(const SurfaceNet& net) {
  std::string bytes = "PSRF";
  append(bytes, static_cast<std::uint32_t>(net.points.size()));
  append(bytes, static_cast<std::uint32_t>(net.triangles.size()));
  for (const Vec3& p : net.points) appendVector(bytes, p);
  for (const Vec3& n : net.normals) appendVector(bytes, n);
  for (const auto& t : net.triangles) append(bytes, t);
  return bytes;
}

}  // namespace palpate::tools
