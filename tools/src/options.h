#pragma once
/// What the user asked for: one plain struct a verb. Lengths and points stay text until the unit of
/// the input is known.

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace palpate::tools {

/// Holds for every verb.
struct GeneralOptions {
  bool json = false;
  bool quiet = false;
  bool force = false;        ///< verbs that write files only
  std::string command = {};  ///< as a shell takes it, for what names how it was made
};

/// What a scan or a mesh leaves open.
struct ScanOptions {
  std::string affine;        ///< image: "sform", "qform" or "spacing"; empty: as the file says
  std::string space;         ///< mesh, NRRD image: "RAS" or "LPS"; empty: as the file says
  std::optional<int> frame;  ///< 4-D image
  std::string series;        ///< DICOM
};

/// Which device the hand holds.
struct DeviceOptions {
  std::string name;          ///< empty: none, the hand follows its path whatever it feels
  std::string hand;          ///< empty: "relaxed"
  std::optional<int> delay;  ///< [samples]
};

/// How a device that a hand holds is reached.
struct RealDeviceOptions {
  std::string serial;             ///< falcon; empty: the first
  std::optional<int> descriptor;  ///< falcon: of its node, open
  std::string firmware;           ///< falcon: image file
  std::string calibration;        ///< falcon: file of constants
  std::string library;            ///< hd, dhd: the maker's library
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
  // Parameters of the generators; which apply is checked in motion.cpp.
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
  // Of the paper's renderer; what is not given is as the scene says.
  std::string epsilon;
  std::optional<int> halvings;
  std::optional<double> alpha;
  std::string alpha_form;  ///< "by_field", "printed" or "newton"
  std::string interior;    ///< "together" or "wall"
  bool realtime = false;
  bool as_recorded = false;  ///< path: its faults, too
  int states = 10000;        ///< [ticks] record: from state to state; 0: none
  double rate = 1000.0;      ///< [Hz]
  DeviceOptions device;
  std::string passivity;   ///< "observe" or "control"; empty: as the scene says
  std::string hand_force;  ///< of `passivity`
  std::string
      coupling;  ///< "springs", "any_scene" or "STIFFNESS,DAMPING"; empty: as the scene says
  RealDeviceOptions real;
  std::optional<double> seconds;  ///< [s] of a device that a hand holds; none: until a stop
  std::string max_force;
  std::string slew;
  std::string ramp;
  std::string trace;
  std::string record;
  std::string image;
  std::string plot;

  // Where `scene` is a mesh, a scan or a grid.
  std::optional<double> above;
  bool distances = false;  ///< image: its voxels are signed distances, negative inside
  std::vector<std::string> labels;
  std::string names;
  std::string units;
  std::string layer;  ///< which grid of a .vdb
  std::string voxel;
  ScanOptions scan;
  std::string write_scene;
};

struct ViewOptions {
  TouchOptions touch;  ///< scene, renderer, device, real, seconds and record only
  std::string replay;  ///< a trace or a record; empty: a hand
  int port = 0;        ///< 0: any that is free
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
  std::vector<std::string> layers;  ///< scene: which layers; threshold and mesh: the layer's name
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
  std::string max_memory;   ///< of all grids together; empty: 80 % of the machine's
  std::string parts;       ///< bake of a scene: the scene file that recombines; empty: whole layers
  bool level_set = false;  ///< grid: signed distances, though it has no class
};

/// What is baked on the way, and into what kind of file it goes.
struct ConvertOptions {
  BakeOptions bake;      ///< its output may be a mesh or an image; --layer names a grid of a .vdb
  std::string to_units;  ///< mesh; empty: the input's
};

struct ImportOptions {
  std::vector<std::string> scans;  ///< the label image; or masks, a structure each
  std::string output;
  bool dry_run = false;
  std::vector<std::string> labels;   ///< values, ranges, names, globs; empty: all
  std::vector<std::string> regions;  ///< NAME=LABELS
  std::string names;
  std::string image;                 ///< gray values
  std::optional<double> skin;        ///< the body is where `image` is brighter
  bool hounsfield = false;           ///< `image` is a CT, from which stiffness comes
  std::string body;                  ///< mask of the body
  std::optional<int> min_island;     ///< [voxels]
  std::string islands;               ///< "merge" or "drop"; empty: merge
  std::vector<std::string> tissues;  ///< LABELS=TISSUE
  std::string tissue_file;           ///< lines of the same
  std::string codes;      ///< whose numbers the labels are: "freesurfer"; empty: nobody's
  bool strict = false;    ///< what no tissue fits is an error
  std::string materials;  ///< table of tissues; empty: the project's
  std::string to;         ///< a region or label that a way is looked for to; empty: none
  std::string voxel;
  ScanOptions reading;                ///< of all images
  std::vector<std::string> priority;  ///< where structures overlap: the first has the voxel

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
  std::string voxel;  ///< mesh: of the bake that is tried
  std::string layer;  ///< grid; empty: all of the file
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
  DeviceOptions device;        ///< of the stability budget
  std::optional<double> rate;  ///< [Hz] of it; none: 1000
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
  // Of a picture in space.
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
  DeviceOptions device;        ///< of the stability budget
  std::optional<double> rate;  ///< [Hz] of it; none: 1000
};

struct BenchOptions {
  std::string what;  ///< "contact", "stability" or "servo"
  std::vector<std::string> scenes;
  std::string renderer;  ///< empty: all
  // Of stability.
  bool full = false;  ///< where nothing else is said: all scenes, four devices, three rates
  std::vector<std::string> devices;  ///< empty: Falcon and Touch
  std::string curvature_svg;
  // Of contact.
  int repeats = 10;
  int paced = 2000;
  int cold = 30;
  std::string csv;
  std::string svg;
  std::vector<double> rates;  ///< stability and servo: [Hz]; empty: 1000, of servo 4000 too
  double seconds = 5.0;       ///< servo: of each
  std::optional<int>
      load;  ///< servo: busy threads; none: without, and then as many as there are cores
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
  std::string ladder;                 ///< "A,B,C": the same, after one another
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
