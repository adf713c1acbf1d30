#pragma once
/// What the source paper leaves open, or does not print clearly: parameters of its renderer.

#include <cstdint>
#include <optional>

namespace palpate {

/// How the paper's algorithms nudge the contact point back onto the surface (its alpha term).
enum class AlphaForm : std::uint8_t {
  kByMetric,  ///< kLength for distances (exact and bound fields), kNewton for implicit ones
  kLength,    ///< alpha S N / |N|, as printed: its strength depends on the field's scale
  kNewton,    ///< alpha S N / (N . N)
};

/// What is felt at the wall from within (row 3 of Table I).
enum class PaperInterior : std::uint8_t {
  kTogether,  ///< wall and content at once, as the text says
  kWall,      ///< the wall alone, as the table says
};

/// What is not given is as the scene has it, or else as written here.
struct PaperParameters {
  static constexpr int kMaxHalvings = 48;
  static constexpr double kAlpha = 1.0;

  /// [m] epsilon: so near to the surface the contact point counts as on it; more than 0. By default 1 um, but at
  /// most a ten-thousandth of the field's feature size. |S| is held against it times the slope of S.
  std::optional<double> epsilon = {};
  std::optional<int> max_halvings =
      {};  ///< MAX_N: of the segment in which the surface is searched; 1 to 1000
  std::optional<double> alpha = {};  ///< [-] share of the nudge; 0 or more
  std::optional<AlphaForm> alpha_form = {};
  std::optional<PaperInterior> interior = {};

  /// These, and of `others` what these do not give.
  [[nodiscard]] PaperParameters over(const PaperParameters& others) const {
    PaperParameters out = *this;
    if (!out.epsilon) out.epsilon = others.epsilon;
    if (!out.max_halvings) out.max_halvings = others.max_halvings;
    if (!out.alpha) out.alpha = others.alpha;
    if (!out.alpha_form) out.alpha_form = others.alpha_form;
    if (!out.interior) out.interior = others.interior;
    return out;
  }
};

}  // namespace palpate
