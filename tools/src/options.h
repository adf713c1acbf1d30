#pragma once
/// The user's options: one plain struct for each verb. Lengths and points stay text until the unit
/// of the input is known.

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace palpate::tools {

/// Options of every verb.
struct GeneralOptions {
  bool json = false;
  bool quiet = false;
  bool force = false;  ///< only for verbs that write files
  /// The whole command in shell syntax, for outputs that say how they were made
  std::string command = {};
};

/// Facts that a scan or a mesh may not state.
struct ScanOptions {
  std::string affine;        ///< image: "sform", "qform" or "spacing"; empty: as the file says
  std::string space;         ///< mesh, NRRD image: "RAS" or "LPS"; empty: as the file says
  std::optional<int> frame;  ///< 4-D image
  std::string series;        ///< DICOM
  bool resample = false;     ///< DICOM series
};

/// Which device the hand holds.
struct DeviceOptions {
  std::string name;          ///< empty: none; the hand follows its path whatever it feels
  std::string hand;          ///< empty: "relaxed"
  std::optional<int> delay;  ///< [samples]
};

/// How to reach a device that a hand holds.
struct RealDeviceOptions {
  std::string serial;             ///< falcon; empty: the first
  std::optional<int> descriptor;  ///< falcon: file descriptor of its open device node
  std::string firmware;           ///< falcon: image file
  std::string calibration;        ///< falcon: file of constants
  std::string library;            ///< hd, dhd: the manufacturer's library
  std::string service;            ///< inverse3: HOST:PORT
};

struct TouchOptions {
  std::string scene;
  // Exactly one of these five says how the hand moves.
  std::string path;                 ///< CSV file
  std::string press;                ///< point
  std::vector<std::string> stroke;  ///< two points
  std::string tap;                  ///< point
  std::vector<std::string> insert;  ///< two points or more
  // Parameters of the generators; motion.cpp checks which of them apply.
  std::string normal;
  std::string depth;
  std::string clearance;
  std::string speed;
  std::optional<double> hold;       ///< [s]
  std::optional<double> frequency;  ///< [Hz]
  std::optional<int> repeats;
  std::optional<int> taps;
  bool back = false;

  std::string renderer;          ///< empty: as the scene says
  std::vector<std::string> set;  ///< MATERIAL.KEY=VALUE@TIME
  // For the paper's renderer; if not given, the scene decides.
  std::string epsilon;
  std::optional<int> halvings;
  std::optional<double> alpha;
  std::string alpha_form;  ///< "by_field", "printed" or "newton"
  std::string interior;    ///< "together" or "wall"
  bool realtime = false;
  bool as_recorded = false;  ///< path: keep its faults too
  int states = 10000;        ///< [ticks] record: interval between saved states; 0: save none
  double rate = 1000.0;      ///< [Hz]
  DeviceOptions device;
  std::string passivity;   ///< "observe" or "control"; empty: as the scene says
  std::string hand_force;  ///< parameter of `passivity`
  std::string
      coupling;  ///< "springs", "any_scene" or "STIFFNESS,DAMPING"; empty: as the scene says
  RealDeviceOptions real;
  /// [s] For a device that a hand holds; not given: until the user stops it
  std::optional<double> seconds;
  std::string max_force;
  std::string slew;
  std::string ramp;
  std::string trace;
  std::string record;
  std::string image;
  std::string plot;

  // If `scene` is a mesh, a scan or a grid:
  std::optional<double> above;
  bool distances = false;  ///< image: its voxels are signed distances, negative inside
  std::vector<std::string> labels;
  std::string names;
  std::string units;
  std::string layer;  ///< name of a grid in a .vdb
  std::string voxel;
  ScanOptions scan;
  std::string write_scene;
};

struct ViewOptions {
  TouchOptions touch;  ///< only scene, renderer, device, real, seconds and record
  std::string replay;  ///< a trace or a record; empty: a hand
  int port = 0;        ///< 0: any free port
  bool no_open = false;
};

struct ReplayOptions {
  std::string record;
  std::string scene;       ///< empty: that of the record
  std::string renderer;    ///< empty: that of the record
  std::uint64_t from = 0;  ///< [tick]
};

struct BakeOptions {
  std::string input;
  std::string output;
  std::vector<std::string> layers;  ///< scene: which layers; threshold and mesh: name for the layer
  std::string units;                ///< mesh
  ScanOptions scan;
  std::string sign;              ///< mesh: "vote", "winding" or "flood"; empty: vote
  std::string shell;             ///< mesh: thickness; empty: a solid
  std::optional<double> smooth;  ///< mesh: [degrees]
  std::optional<double> above;
  bool distances = false;  ///< image: its voxels are signed distances, negative inside
  std::string keep;        ///< "largest" or "all"; empty: largest
  bool fill = false;
  std::vector<std::string> labels;
  std::string names;
  std::string voxel;
  double half_width = 6.0;  ///< [voxels]
  std::string max_memory;   ///< limit for all grids together; empty: 80 % of the machine's
  std::string parts;  ///< bake of a scene: file for the scene that combines the parts again; empty:
                      ///< whole layers
  bool level_set = false;  ///< grid: its values are signed distances, though it has no class
};

/// The bake that precedes the conversion, and the kind of output.
struct ConvertOptions {
  BakeOptions bake;      ///< its output may be a mesh or an image; --layer names a grid of a .vdb
  std::string to_units;  ///< mesh; empty: the input's
};

struct ImportOptions {
  std::vector<std::string> scans;  ///< the label image; or masks, one for each structure
  std::string output;
  bool dry_run = false;
  std::vector<std::string> labels;   ///< values, ranges, names, globs; empty: all
  std::vector<std::string> regions;  ///< NAME=LABELS
  std::string names;
  std::string image;                 ///< gray values
  std::optional<double> skin;        ///< the body is where `image` is brighter
  bool hounsfield = false;           ///< `image` is a CT, and stiffness is derived from it
  std::string body;                  ///< mask of the body
  std::optional<int> min_island;     ///< [voxels]
  std::string islands;               ///< "merge" or "drop"; empty: merge
  std::vector<std::string> tissues;  ///< LABELS=TISSUE
  std::string tissue_file;           ///< file with lines of the same form
  std::string codes;      ///< table whose label numbers these are: "freesurfer"; empty: none
  bool strict = false;    ///< labels that fit no tissue are an error
  std::string materials;  ///< table of tissues; empty: the project's
  /// Region, label or Markups file with a point to find a way to; empty: none.
  std::string to;
  std::string way;        ///< Markups file to write the way to; empty: none
  std::string burr_hole;  ///< diameter, in mm or with a unit; empty: no hole is drilled
  std::string voxel;
  ScanOptions reading;                ///< of all images
  std::vector<std::string> priority;  ///< where structures overlap, the first one gets the voxel

  [[nodiscard]] const std::string& scan() const { return scans.front(); }
};

struct InfoOptions {
  std::vector<std::string> files;
  std::string units;
  ScanOptions scan;
  std::string names;
};

struct CheckOptions {
  std::vector<std::string> files;
  std::string units;  ///< mesh, or grid without a unit
  ScanOptions scan;   ///< mesh: its space
  std::string voxel;  ///< mesh: voxel size of the trial bake
  std::string layer;  ///< grid; empty: all grids of the file
  bool level_set = false;
};

struct QueryOptions {
  std::string input;
  std::vector<std::string> at;
  std::string points;
  std::string field;
  ScanOptions scan;
};

struct ExplainOptions {
  std::string scene;
  DeviceOptions device;        ///< for the stability budget
  std::optional<double> rate;  ///< [Hz] for the budget; not given: 1000
  bool measure = false;
  std::string svg;
};

struct RenderOptions {
  std::string scene;
  std::string output;
  std::string plane;  ///< "x=VALUE"
  std::string cut;    ///< "X,Y,Z,NX,NY,NZ"
  std::string size;   ///< "WxH"
  std::string trace;
  std::string image;
  std::string iso;            ///< a length
  std::optional<int> forces;  ///< arrows along the longer side
  // For a picture in space:
  std::string view;                  ///< "corner", "front", "+x", "X,Y,Z"; empty: a flat cut
  std::string around;                ///< "X,Y,Z,RADIUS"
  std::vector<std::string> opacity;  ///< "LAYER=SHARE"
  std::vector<std::string> slices;   ///< "x=VALUE"
  std::optional<int> turn;           ///< frames
  std::optional<int> replay;         ///< frames
};

struct ReportOptions {
  std::vector<std::string> inputs;  ///< traces, records, scenes, JSON of benches
  std::string output;
  DeviceOptions device;        ///< for the stability budget
  std::optional<double> rate;  ///< [Hz] for the budget; not given: 1000
};

struct BenchOptions {
  std::string what;  ///< "contact", "stability" or "servo"
  std::vector<std::string> scenes;
  std::string renderer;  ///< empty: all
  // For stability:
  bool full = false;  ///< where nothing else is given: all scenes, four devices, three rates
  std::vector<std::string> devices;  ///< empty: Falcon and Touch
  std::string curvature_svg;
  // For contact:
  int repeats = 10;
  int paced = 2000;
  int cold = 30;
  std::string csv;
  std::string svg;
  std::vector<double> rates;  ///< stability and servo: [Hz]; empty: 1000, of servo 4000 too
  double seconds = 5.0;       ///< [s] servo: length of each run
  std::optional<int> load;    ///< servo: busy threads; not given: one run without, and one with as
                              ///< many as there are cores
};

struct DevicesOptions {
  std::string test;       ///< name of a device
  std::string calibrate;  ///< file to write
  bool states = false;
  double seconds = 10.0;
  RealDeviceOptions device;
};

struct DoctorOptions {};

struct AccuracyOptions {
  std::string scene;
  std::vector<std::string> fields;    ///< empty: every layer
  std::vector<std::string> voxels;    ///< lengths
  std::string ladder;                 ///< "A,B,C": the same as a list
  std::vector<std::string> samplers;  ///< empty: all
  int points = 100000;
  double band = 1.0;  ///< [voxels]
  int repeats = 10;
  std::string csv;
  std::string svg;
};

/// `palpate help`: everything, one verb, or the keys of scene files.
struct HelpOptions {
  std::string verb;  ///< or "scene"
  std::string key;   ///< of a scene; empty: all
  bool markdown = false;
  bool schema = false;
  bool man = false;
  std::string completion;  ///< "bash", "zsh" or "fish"
};

using VerbOptions =
    std::variant<HelpOptions, TouchOptions, BakeOptions, ConvertOptions, ImportOptions, InfoOptions,
                 CheckOptions, QueryOptions, ExplainOptions, RenderOptions, BenchOptions,
                 AccuracyOptions, ReplayOptions, ReportOptions, DevicesOptions, DoctorOptions,
                 ViewOptions>;

}  // namespace palpate::tools
