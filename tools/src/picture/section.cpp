#include "picture/section.h"

#include <algorithm>
#include <array>
#include <unordered_map>

#include "palpate/interior/port_machine.h"
#include "picture/parallel_rows.h"

namespace palpate::tools {
namespace {

constexpr int kHalvings = 10;  // bisections of a pixel: to a thousandth of it

std::uint64_t cellOf(const Scene& scene, const Signs& signs) {
  return scene.partition().regionOf(signs) | sheetSides(scene, signs).inner << 16U;
}

/// True if a sheet lies between two cells of one region; the second cell is beyond the line only by
/// rounding.
bool sheetBetween(const Scene& scene, const Signs& here, const Signs& there) {
  const SheetSides beyond = sheetSides(scene, there);
  return ((sheetSides(scene, here).inner ^ beyond.inner) & beyond.extent) != 0;
}

/// Finds the lines by examining every square of four pixel centers: each side whose ends are in
/// different regions is crossed once, at a point found by bisection.
class Tracer {
 public:
  Tracer(const Scene& scene, const View& view, const Section& section)
      : scene_(scene),
        view_(view),
        section_(section),
        low_(scene.partition().leaves().size()),
        high_(low_),
        middle_(low_) {}

  std::vector<Boundary> trace() {
    for (int y = 0; y + 1 < section_.height; ++y) {
      for (int x = 0; x + 1 < section_.width; ++x) square(x, y);
    }
    return chain();
  }

 private:
  struct Crossing {
    Pixel at;
    Boundary kind;
  };
  struct Piece {
    std::size_t from;
    std::size_t to;
    bool used = false;
  };

  [[nodiscard]] std::int64_t sideKey(int x, int y, bool down) const {
    return (static_cast<std::int64_t>(y) * section_.width + x) * 2 + (down ? 1 : 0);
  }

  std::size_t crossing(int x, int y, bool down) {
    const auto [at, fresh] = crossing_of_.try_emplace(sideKey(x, y, down), crossings_.size());
    if (!fresh) return at->second;
    const auto center = [&](double share) {
      return Pixel{x + 0.5 + (down ? 0.0 : share), y + 0.5 + (down ? share : 0.0)};
    };
    const auto signs = [&](double share, Signs& out) {
      const Pixel p = center(share);
      scene_.partition().signsAt(view_.world(p.x, p.y), out);
    };
    double low = 0.0;
    double high = 1.0;
    signs(low, low_);
    signs(high, high_);
    const std::uint64_t first = cellOf(scene_, low_);
    for (int i = 0; i < kHalvings; ++i) {
      const double half = 0.5 * (low + high);
      signs(half, middle_);
      if (cellOf(scene_, middle_) == first) {
        low = half;
        std::swap(low_, middle_);
      } else {
        high = half;
        std::swap(high_, middle_);
      }
    }
    crossings_.push_back({center(0.5 * (low + high)), classify(scene_, low_, high_)});
    return crossings_.size() - 1;
  }

  void square(int x, int y) {
    const std::uint64_t a = section_.cell(x, y), b = section_.cell(x + 1, y);
    const std::uint64_t c = section_.cell(x, y + 1), d = section_.cell(x + 1, y + 1);
    if (a == b && a == c && a == d) return;
    std::array<std::size_t, 4> met{};
    std::size_t count = 0;
    if (a != b) met[count++] = crossing(x, y, false);
    if (c != d) met[count++] = crossing(x, y + 1, false);
    if (a != c) met[count++] = crossing(x, y, true);
    if (b != d) met[count++] = crossing(x + 1, y, true);
    if (count == 2) {
      pieces_.push_back({met[0], met[1]});
      return;
    }
    // Three or more regions meet: their lines end in the middle of the square.
    Pixel middle;
    for (std::size_t i = 0; i < count; ++i) {
      middle.x += crossings_[met[i]].at.x / static_cast<double>(count);
      middle.y += crossings_[met[i]].at.y / static_cast<double>(count);
    }
    for (std::size_t i = 0; i < count; ++i) {
      crossings_.push_back({middle, crossings_[met[i]].kind});
      pieces_.push_back({met[i], crossings_.size() - 1});
    }
  }

  std::vector<Boundary> chain() {
    std::unordered_map<std::size_t, std::vector<std::size_t>> pieces_at;
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      pieces_at[pieces_[i].from].push_back(i);
      pieces_at[pieces_[i].to].push_back(i);
    }
    std::vector<Boundary> lines;
    const auto follow = [&](std::size_t piece, std::size_t end, std::vector<Pixel>& out) {
      const Boundary& kind = crossings_[pieces_[piece].from].kind;
      for (;;) {
        out.push_back(crossings_[end].at);
        std::size_t next = pieces_.size();
        for (const std::size_t candidate : pieces_at[end]) {
          if (!pieces_[candidate].used && crossings_[pieces_[candidate].from].kind.sameLine(kind)) {
            next = candidate;
          }
        }
        if (next == pieces_.size()) return;
        pieces_[next].used = true;
        end = pieces_[next].from == end ? pieces_[next].to : pieces_[next].from;
      }
    };
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      if (pieces_[i].used) continue;
      pieces_[i].used = true;
      Boundary line = crossings_[pieces_[i].from].kind;
      std::vector<Pixel> backward;
      follow(i, pieces_[i].from, backward);
      line.points.assign(backward.rbegin(), backward.rend());
      follow(i, pieces_[i].to, line.points);
      lines.push_back(std::move(line));
    }
    return lines;
  }

  const Scene& scene_;
  const View& view_;
  const Section& section_;
  Signs low_, high_, middle_;
  std::unordered_map<std::int64_t, std::size_t> crossing_of_;
  std::vector<Crossing> crossings_;
  std::vector<Piece> pieces_;
};

}  // namespace

SheetSides sheetSides(const Scene& scene, const Signs& signs) {
  const Partition& partition = scene.partition();
  const auto sheets = scene.passages().sheets();
  SheetSides out;
  for (std::size_t i = 0; i < std::min(sheets.size(), kMostSheets); ++i) {
    const std::uint64_t bit = std::uint64_t{1} << i;
    const auto holds = [&](int mask) {
      return partition.maskHolds(static_cast<std::size_t>(mask), signs);
    };
    if (holds(sheets[i].solid)) out.inner |= bit;
    if (sheets[i].mask < 0 || holds(sheets[i].mask)) out.extent |= bit;
  }
  return out;
}

Boundary classify(const Scene& scene, const Signs& here, const Signs& there) {
  const Partition& partition = scene.partition();
  Boundary line;
  line.a = partition.regionOf(here);
  line.b = partition.regionOf(there);
  const Signs* first = &here;
  const Signs* second = &there;
  if (line.a == line.b) {
    line.kind =
        sheetBetween(scene, here, there) ? Boundary::Kind::kSheet : Boundary::Kind::kNothing;
    return line;
  }
  if (line.a > line.b) {
    std::swap(line.a, line.b);
    std::swap(first, second);
  }
  std::vector<LeafId> crossed;
  for (std::size_t i = 0; i < partition.leaves().size(); ++i) {
    const auto leaf = static_cast<LeafId>(i);
    if (here.inside(leaf) != there.inside(leaf)) crossed.push_back(leaf);
  }
  PassedPorts all;  // a port that requires others first is still shown as a port
  for (const Port& port : scene.ports()) {
    for (const PassedBefore& before : port.after) {
      const auto slot = static_cast<std::size_t>(scene.ports()[before.port].slot);
      while (all.times(slot) < before.times) all.pass(slot, true, true);
    }
  }
  const Vec3 anywhere(0.0);  // for a varying opening force, its value anywhere will do
  const Facet inward = scene.passages().facet(partition, line.a, *second, crossed, all, anywhere);
  const Facet outward = scene.passages().facet(partition, line.b, *first, crossed, all, anywhere);
  const auto passable = [](const Facet& f) { return f.kind == Facet::Kind::kOpen || f.opens; };
  if (inward.kind == Facet::Kind::kAbsent || outward.kind == Facet::Kind::kAbsent) {
    line.kind = Boundary::Kind::kAbsent;
  } else if (passable(inward) || passable(outward)) {
    const bool open = inward.kind == Facet::Kind::kOpen || outward.kind == Facet::Kind::kOpen;
    line.kind = open ? Boundary::Kind::kPort : Boundary::Kind::kPressed;
    line.from_a = passable(inward);
    line.from_b = passable(outward);
    line.port = line.from_a ? inward.port : outward.port;
  }
  return line;
}

Section cutSection(const Scene& scene, const View& view, const Progress& progress) {
  Section section;
  section.width = view.width;
  section.height = view.height;
  section.cells.resize(static_cast<std::size_t>(view.width) *
                       static_cast<std::size_t>(view.height));
  std::vector<Signs> scratch(workerCount(), Signs(scene.partition().leaves().size()));
  parallelRows(view.height, progress, "cutting the scene", [&](int y, std::size_t worker) {
    for (int x = 0; x < view.width; ++x) {
      scene.partition().signsAt(view.world(x + 0.5, y + 0.5), scratch[worker]);
      section.cells[static_cast<std::size_t>(x) +
                    static_cast<std::size_t>(view.width) * static_cast<std::size_t>(y)] =
          cellOf(scene, scratch[worker]);
    }
  });
  section.boundaries = Tracer(scene, view, section).trace();
  return section;
}

}  // namespace palpate::tools
