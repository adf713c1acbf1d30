#pragma once
// A second implementation of the source paper, from its text alone: Algorithms I and II, and the
// rule by which its tables of states display surfaces. Figures add their own tables of ports.
// Lengths are in mm for tables, in m for surfaces.

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "lib/render/drive.h"
#include "palpate/fields/field.h"

namespace palpate::test {

/// A surface S with its normal N.
using Surface = std::function<FieldSample(const Vec3&)>;

/// "The same, with its sign reversed."
inline Surface reversed(const Surface& surface) {
  return [surface](const Vec3& p) {
    FieldSample s = surface(p);
    s.value = -s.value;
    s.gradient = -s.gradient;
    return s;
  };
}

/// The intersection of several surfaces: where the point is inside all of them.
inline Surface insideAll(std::vector<Surface> all) {
  return [all = std::move(all)](const Vec3& p) {
    FieldSample most = all.front()(p);
    for (const Surface& one : all) {
      const FieldSample s = one(p);
      if (s.value > most.value) most = s;
    }
    return most;
  };
}

struct PaperNumbers {
  double epsilon = 1e-6;  ///< bound of |S|
  int max_n = 48;
  double alpha = 1.0;
  bool newton = false;
};

/// Algorithms I and II for one surface at a time.
class PaperText {
 public:
  Vec3 po{0.0};
  Vec3 pi{0.0};

  /// "P(k) is inside the object for the first time": between P(k-1) and P(k).
  void algorithm1(const Surface& s, const PaperNumbers& n, Vec3 outside, Vec3 inside,
                  const Vec3& probe) {
    if (s(outside).value > 0.0) {
      for (int i = 0; i <= n.max_n; ++i) {
        po = 0.5 * (outside + inside);
        const double value = s(po).value;
        if (std::fabs(value) < n.epsilon) break;
        if (value > 0.0) {
          outside = po;
        } else {
          inside = po;
        }
      }
    } else {
      // There is no segment to search: the documentation says to follow the gradient.
      po = probe;
      for (int i = 0; i < 32; ++i) {
        const FieldSample at = s(po);
        if (std::fabs(at.value) < n.epsilon || !(glm::length(at.gradient) > 0.0)) break;
        po = po - at.gradient * (at.value / glm::dot(at.gradient, at.gradient));
      }
    }
    finish1(s, n, probe);
  }

  void algorithm2(const Surface& s, const PaperNumbers& n, const Vec3& last_probe,
                  const Vec3& probe) {
    const FieldSample at = s(po);
    const Vec3 v = probe - last_probe;
    const Vec3 normal = at.gradient;
    po = po + (v - normal * (glm::dot(normal, v) / glm::dot(normal, normal))) - nudge(at, n);
    project(s(po).gradient, probe);
    if (s(po).value <= n.epsilon) return;
    // "Too far outside": "recalculated as the surface crossing point on the line segment from Po to
    // Pi".
    const Vec3 end = s(pi).value <= 0.0 ? pi : probe;
    Vec3 outside = po;
    Vec3 inside = end;
    for (int i = 0; i <= n.max_n; ++i) {
      po = 0.5 * (outside + inside);
      const double value = s(po).value;
      if (std::fabs(value) < n.epsilon) break;
      (value > 0.0 ? outside : inside) = po;
    }
    finish1(s, n, probe);
  }

 private:
  static Vec3 nudge(const FieldSample& at, const PaperNumbers& n) {
    const double length = glm::length(at.gradient);
    return at.gradient * (n.alpha * at.value / (n.newton ? length * length : length));
  }
  void project(const Vec3& normal, const Vec3& probe) {
    pi = po + normal * (glm::dot(normal, probe - po) / glm::dot(normal, normal));
  }
  void finish1(const Surface& s, const PaperNumbers& n, const Vec3& probe) {
    const FieldSample at = s(po);
    project(at.gradient, probe);
    if (at.value < 0.0) po = po - nudge(at, n);
  }
};

/// The result of a table for one tick.
struct Display {
  int state = 0;
  std::string passed;    ///< ports, in order
  bool is_free = false;  ///< F = 0
  int surface = -1;      ///< index of the one in contact; -1: none
  bool is_reversed = false;
  double viscosity = 0.0;  ///< [N s/m] of the content that is felt
};

/// One figure of the paper: its surfaces, and its table.
class PrintedFigure {
 public:
  virtual ~PrintedFigure() = default;
  /// The result of a tick with the previous and the present probe [m].
  [[nodiscard]] virtual Display tick(const Vec3& last, const Vec3& now) = 0;
  /// The surface with that number in the present state of the table.
  [[nodiscard]] virtual Surface surface(int number) const = 0;
  /// Changes when the surface of some number becomes another one.
  [[nodiscard]] virtual int version() const { return 0; }
};

}  // namespace palpate::test
