#pragma once
/// What an author says about a scene: plain data, from a scene file or from code, not yet checked
/// against geometry. compile() turns it into a Scene.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "palpate/core/math.h"
#include "palpate/core/progress.h"
#include "palpate/export.h"
#include "palpate/fields/field.h"
#include "palpate/interior/port.h"
#include "palpate/materials/material.h"

namespace palpate {

/// How the energy of the loop is counted and controlled (devices/passivity.h). Members without a
/// value take the device's.
struct PassivityRequest {
  bool controls = true;                   ///< false: the energy is only counted
  std::optional<double> mass = {};        ///< [kg] smallest mass of the device
  std::optional<double> damping = {};     ///< [N s/m] smallest damping of the device
  std::optional<double> friction = {};    ///< [N] smallest friction of the device
  std::optional<double> encoder = {};     ///< [m] one encoder step
  std::optional<double> hand_force = {};  ///< [N] the hand's largest
  /// Compares all members.
  friend bool operator==(const PassivityRequest&, const PassivityRequest&) = default;
};

/// A spring and a damper between the hand and the tool (devices/virtual_coupling.h).
struct CouplingRequest {
  /// What the coupling is designed for, if it has no stiffness of its own.
  enum class For : std::uint8_t {
    kSprings,   ///< walls that do not move
    kAnyScene,  ///< any passive scene
  };
  For design = For::kSprings;            ///< ignored if `stiffness` has a value
  std::optional<double> stiffness = {};  ///< [N/m] at the hand
  double damping = 0.0;                  ///< [N s/m] beside `stiffness`
  /// Compares all members.
  friend bool operator==(const CouplingRequest&, const CouplingRequest&) = default;
};

/// World = offset + scale * rotation * device, in [m]; forces go back by the rotation, `force`
/// times as large. So the hand does force / scale times the work that is done in the world, and a
/// stiffness feels scale * force times as stiff. The workspace is the space that the device's tip
/// can reach.
struct DeviceMapping {
  Vec3 offset{0.0, 0.0, 0.0};  ///< [m, world] where the device's origin is
  Mat3 rotation{1.0};   ///< [-] from the device's axes to the world's; proper (determinant +1)
  double scale = 1.0;   ///< [-] world per device, more than 0
  double force = 1.0;   ///< [-] force at the hand per force in the world, more than 0
  bool clutch = false;  ///< the hand can take hold elsewhere: the whole world is in reach
  Box3 workspace{Vec3(-kInfinity), Vec3(kInfinity)};  ///< [m, device] box around it
  std::optional<PassivityRequest> passivity = {};     ///< no value: off
  std::optional<CouplingRequest> coupling = {};       ///< no value: off

  /// Converts a position [m, device] to the world's frame [m, world].
  [[nodiscard]] Vec3 toWorld(const Vec3& device) const noexcept {
    return offset + scale * (rotation * device);
  }
  /// Converts a velocity [m/s, device] to the world's frame [m/s, world].
  [[nodiscard]] Vec3 velocityToWorld(const Vec3& device) const noexcept {
    return scale * (rotation * device);
  }
  /// Converts a force [N, world] to the force at the hand [N, device].
  [[nodiscard]] Vec3 forceToDevice(const Vec3& world) const noexcept {
    return force * (glm::transpose(rotation) * world);
  }
  /// [-] Work at the hand per work in the world.
  [[nodiscard]] double workAtHand() const noexcept { return force / scale; }
  /// [-] Stiffness at the hand per stiffness in the world.
  [[nodiscard]] double stiffnessAtHand() const noexcept { return force * scale; }

  /// [m, world] A box around everything that the hand can reach; all space if the workspace is not
  /// bounded or there is a clutch.
  [[nodiscard]] Box3 reach() const noexcept {
    if (clutch || !workspace.isBounded()) return {Vec3(-kInfinity), Vec3(kInfinity)};
    return Pose{scale * rotation, offset}.apply(workspace);
  }
};

/// Limits of the rendered force that the author of a scene asks for. Members without a value set no
/// limit.
struct ForceRequest {
  std::optional<double> max = {};   ///< [N] more than 0; longer forces are shortened to it
  std::optional<double> slew = {};  ///< [N/s] more than 0; the rate at which the force may grow
  std::optional<double> ramp = {};  ///< [s] more than 0; time from zero to full force
  /// Compares all members.
  friend bool operator==(const ForceRequest&, const ForceRequest&) = default;
};

/// How the paper's algorithms nudge the contact point back onto the surface (its alpha term).
enum class AlphaForm : std::uint8_t {
  kByMetric,  ///< kLength for distances (exact and bound fields), kNewton for implicit ones
  kLength,    ///< alpha S N / |N|, as printed: its strength depends on the field's scale
  kNewton,    ///< alpha S N / (N . N)
};

/// What is felt when the wall is touched from within (row 3 of Table I).
enum class PaperInterior : std::uint8_t {
  kTogether,  ///< wall and content at once, as the text says
  kWall,      ///< the wall alone, as the table says
};

/// Members without a value are as the scene has them, or else as written here.
struct PaperParameters {
  /// Default of max_halvings.
  static constexpr int kMaxHalvings = 48;
  /// [-] Default of alpha.
  static constexpr double kAlpha = 1.0;

  /// [m] epsilon: within this distance of the surface the contact point counts as on it; more than
  /// 0. By default 1 um, but at most a ten-thousandth of the field's feature size. |S| is compared
  /// with epsilon times the slope of S.
  std::optional<double> epsilon = {};
  std::optional<int> max_halvings =
      {};  ///< MAX_N: halvings of the segment on which the surface is searched; 1 to 1000
  std::optional<double> alpha = {};            ///< [-] share of the nudge; 0 or more
  std::optional<AlphaForm> alpha_form = {};    ///< default: kByMetric
  std::optional<PaperInterior> interior = {};  ///< default: kTogether

  /// These parameters; where one has no value, that of `others`.
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

/// The place in a file where something was stated, so that later errors can point at it. Line 0:
/// none.
struct SourcePlace {
  std::string file = {};     ///< as the user named it; empty: not from a file
  int line = 0;              ///< from 1
  int column = 0;            ///< [characters] from 1; 0: unknown
  std::string excerpt = {};  ///< the line's text, shortened if it is very long
};

/// An error about something stated at `place`.
[[nodiscard]] PALPATE_EXPORT Error errorAt(const SourcePlace& place, std::string code,
                                           std::string message, std::string hint = {});

/// A field that is ready, or one that is costly (from a mesh, a scan) and is made when first asked
/// for, so that a field the scene does not need is never made. Set-up thread only.
class PALPATE_EXPORT FieldSource {
 public:
  /// Makes the whole field; may throw Error. Called at most once, unless it throws.
  using Maker = std::function<FieldPtr(const Progress&)>;

  /// Makes a field that is right within the box [m], and beyond it keeps the sign that it has at
  /// the box's faces (knownWithin()).
  using PartMaker = std::function<FieldPtr(const Box3& within, const Progress&)>;

  /// [m] A box around the field to be made, much cheaper than making it.
  using Measurer = std::function<Box3(const Progress&)>;

  /// A field that is ready; summary() is empty.
  explicit FieldSource(FieldPtr ready) : made_(std::move(ready)) {}
  /// A field that `maker` makes. `summary` says what it is made from; without `measurer`, bounds()
  /// has no value until the field is made.
  FieldSource(std::string summary, Maker maker, Measurer measurer = {})
      : summary_(std::move(summary)), maker_(std::move(maker)), measurer_(std::move(measurer)) {}
  /// To make the whole field, `maker` is called with a box that is all of space.
  FieldSource(std::string summary, PartMaker maker, Measurer measurer = {})
      : summary_(std::move(summary)),
        part_maker_(std::move(maker)),
        measurer_(std::move(measurer)) {}

  /// The field, made now if need be. The same pointer every time.
  [[nodiscard]] const FieldPtr& get(const Progress& progress = {}) const;
  /// The part of the field that is needed where only `within` [m] matters: the whole field if it is
  /// made already, or cannot be made in part. The same pointer every time for the same box.
  [[nodiscard]] const FieldPtr& get(const Box3& within, const Progress& progress = {}) const;
  /// [m] A box around the field; no value if only making the field would tell.
  [[nodiscard]] std::optional<Box3> bounds(const Progress& progress = {}) const;
  /// True if the whole field exists already, so that get() is cheap.
  [[nodiscard]] bool isMade() const noexcept { return made_ != nullptr; }
  /// The part that was made last for a box; null if none was.
  [[nodiscard]] const FieldPtr& part() const noexcept { return part_; }
  /// What it is made from ("mesh bone.stl"); empty for analytic fields.
  [[nodiscard]] const std::string& summary() const noexcept { return summary_; }

 private:
  std::string summary_;
  Maker maker_;
  PartMaker part_maker_;
  Measurer measurer_;
  mutable FieldPtr made_;
  mutable FieldPtr part_;
  mutable Box3 part_within_;
};
using FieldSourcePtr = std::shared_ptr<const FieldSource>;  ///< shared by all that use the field

/// An entry of `fields:`.
struct NamedField {
  std::string name;       ///< by which layers, ports and other fields use it
  FieldSourcePtr source;  ///< made when it is first asked for
};

/// The wall between a layer and its surroundings.
struct WallDescription {
  bool absent = false;        ///< true: no wall, a free crossing both ways
  std::string material = {};  ///< name; empty (and not absent): the documented default wall
};

/// A layer as a scene states it.
struct LayerDescription {
  std::string name;           ///< unique within the scene; not "outside"
  FieldSourcePtr inside;      ///< negative inside the layer; later layers win where they overlap it
  std::string content = {};   ///< material name; empty: nothing is felt inside
  WallDescription wall = {};  ///< towards all regions for which no WallOverride says otherwise
  /// Layers with the same non-empty group come from one label image: where they meet, a point
  /// belongs to the one whose field is smallest. Their fields should overlap a little where edges
  /// meet, so that no part of the image is left over between them.
  std::string label_group = {};
  /// Labels of the group's image, ascending. Two layers that share a label do not limit each other:
  /// the later layer owns points that are in both.
  std::vector<int> labels = {};
  SourcePlace place = {};  ///< of its name
};

/// Overrides the wall between two regions. Globs allowed.
struct WallOverride {
  std::string a;               ///< name of a region, or a glob
  std::string b;               ///< the same, for the other side
  WallDescription wall;        ///< in place of the wall that belongs to the inner layer
  std::string felt_from = {};  ///< empty: from both sides; else `a` or `b`
  SourcePlace place = {};      ///< of the entry in `walls:`
};

/// A port that must have been passed before, and the least number of times.
struct AfterDescription {
  std::string port;  ///< name of the other port
  int times = 1;     ///< 1 or more

  /// `at_least` passes of port `before`; a name alone means one.
  AfterDescription(std::string before, int at_least = 1)
      : port(std::move(before)), times(at_least) {}
  /// One pass of port `before`, given as a literal.
  AfterDescription(const char* before) : port(before) {}
  /// Compares all members.
  friend bool operator==(const AfterDescription&, const AfterDescription&) = default;
};

/// A port as a scene states it.
struct PortDescription {
  std::string name;  ///< unique within the scene
  std::string from;  ///< region names and globs, with ", " between them
  std::string to;    ///< the same
  /// The port opens this sheet and not a wall. Then `from` and `to` are empty, there is no `on`,
  /// and inward is against the gradient of the field that the sheet lies on.
  std::string sheet = {};
  FieldSourcePtr on = {};    ///< null: any facet
  std::string on_name = {};  ///< the name that the author gave it
  /// Why `on` may not be a face although the scene uses it (it went into a blend); compile() adds
  /// this to its error. Empty: no reason is known.
  std::string on_note = {};
  FieldSourcePtr where = {};  ///< null: everywhere
  PortDirection direction =
      PortDirection::kBoth;                  ///< kIn: only from `from` to `to`; kOut: only back
  std::vector<AfterDescription> after = {};  ///< all of these must hold for it to open
  Parameter opens_at = 0.0;                  ///< [N]
  std::optional<Parameter> back = {};        ///< [N]; not given: as opens_at
  RuptureRate rate = {};                     ///< of both `opens_at` and `back`
  double hole_radius = 0.0;                  ///< [m] 0: force that opens it leaves no hole
  Parameter reopens_at = 0.0;                ///< [N] in a hole, in place of `opens_at`
  double rearm = 0.0;                        ///< [m]
  SourcePlace place = {};                    ///< of its name
};

/// An open surface: the part of `on`'s zero set where `where` is negative, with the same region on
/// both sides (a dangling edge, a plate without thickness).
struct SheetDescription {
  std::string name;           ///< unique within the scene
  FieldSourcePtr on;          ///< the field whose zero set the sheet is part of
  FieldSourcePtr where = {};  ///< null: the whole zero set
  std::string material = {};  ///< name; empty: the documented default wall
  SourcePlace place = {};     ///< of its name
};

/// The renderer that a scene asks for.
enum class RendererKind {
  kConstraint,  ///< the proxy decides about contact and ports
  kPaper        ///< the published algorithm to the letter, driven by the HIP
};

/// A whole scene as its author states it, before any check of its parts against each other;
/// compile() makes a Scene of it.
struct SceneDescription {
  std::string file = {};                 ///< for messages; empty: not from a file
  std::string length_unit = "m";         ///< as named in the file, for output that people read
  double meters_per_unit = 1.0;          ///< [m]
  std::vector<Material> materials = {};  ///< in any order; the default wall is not among them
  std::vector<NamedField> fields = {};   ///< for Scene::fields(); layers need not use them
  /// From the outside in: where two overlap, the later one wins.
  std::vector<LayerDescription> layers = {};
  std::vector<WallOverride> walls = {};       ///< exceptions to the layers' walls; later ones win
  std::vector<PortDescription> ports = {};    ///< PortId is the index here
  std::vector<SheetDescription> sheets = {};  ///< surfaces without thickness
  std::string start_region = "outside";       ///< the region in which the proxy begins
  SourcePlace start_place = {};               ///< of `start_region`
  bool keep_memory = false;  ///< `memory: keep`: ports passed are never taken back nor cleared
  RendererKind renderer = RendererKind::kConstraint;  ///< RendererSettings::kind takes precedence
  ForceRequest force = {};                            ///< ForceLimits take precedence
  PaperParameters paper = {};                         ///< RendererSettings::paper takes precedence
  DeviceMapping device = {};                          ///< how the device's space lies in the world
};

}  // namespace palpate
