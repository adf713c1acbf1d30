// palpate_damage_sweep [MUTANTS] [SEED] [COMMAND] [FORMAT...]: damages files of every format in
// every way, MUTANTS times each, and gives each file to the command. The limits are 4 GB of address
// space and 20 s more than the sound file takes (a scene may be one of a whole head). Reports
// signals, hangs, undocumented exit codes, and runs that took more than 1 GB for an input of less
// than 10 MB, and keeps such inputs; exit 1 if there are any. The command runs in forks of this
// process, which have its libraries loaded already, with as many formats at a time as there are
// processors. With COMMAND, another build of palpate ("-": this one), that program is started for
// each file. FORMATs restrict the sweep to these.

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "folders/folders.h"
#include "fuzz/damage.h"
#include "fuzz/readers.h"
#include "fuzz/seeds.h"
#include "run_command.h"

namespace {

using palpate::fuzz::Damage;
using palpate::fuzz::Reader;
namespace fs = std::filesystem;

constexpr rlim_t kMemory = rlim_t{4} << 30U;
constexpr double kSeconds = 20.0;
constexpr double kMostSound = 300.0;  ///< [s] limit for a sound file
/// [s] A sound file that takes longer than this is damaged only in some of its turns; in the others
/// a quicker one replaces it: the scene of a whole head uses the same readers as a small one, and
/// takes a thousand times as long.
constexpr double kSlowSound = 0.5;
constexpr std::size_t kTurnsOfSlow = 50;
constexpr long kMostResident = 1L << 20U;  // [kB]

struct Run {
  int status = 0;
  bool timed_out = false;
  long resident = 0;     ///< [kB]
  double seconds = 0.0;  ///< wall-clock time
};

/// Becomes the command, and does not return. `program` empty: the command that is linked into this
/// program.
[[noreturn]] void become(const std::string& program, const std::vector<std::string>& arguments) {
  if (program.empty()) {
    const int code = palpate::tools::runCommand(arguments);
    std::fflush(nullptr);
    _exit(code);
  }
  std::vector<char*> argv = {const_cast<char*>(program.c_str())};
  for (const std::string& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));
  argv.push_back(nullptr);
  execv(program.c_str(), argv.data());
  _exit(127);
}

Run run(const std::string& program, const std::vector<std::string>& arguments, double seconds) {
  const pid_t process = fork();
  if (process == 0) {
    const int nowhere = open("/dev/null", O_RDWR);
    for (const int end : {0, 1, 2}) dup2(nowhere, end);
    const rlimit memory{kMemory, kMemory};
    setrlimit(RLIMIT_AS, &memory);
    const rlimit none{0, 0};
    setrlimit(RLIMIT_CORE, &none);
    become(program, arguments);
  }
  Run result;
  rusage usage{};
  const auto begin = std::chrono::steady_clock::now();
  const auto took = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  while (wait4(process, &result.status, WNOHANG, &usage) == 0) {
    if (!result.timed_out && took() > seconds) {
      result.timed_out = true;
      kill(process, SIGKILL);
    }
    poll(nullptr, 0, 1);
  }
  result.resident = usage.ru_maxrss;
  result.seconds = took();
  return result;
}

/// A command line that makes the command read all of a file of that kind.
std::vector<std::string> commandFor(const Reader& reader, const std::string& file,
                                    const std::string& image) {
  const std::string name = reader.name;
  if (name == "yaml") return {"check", file};
  if (name == "path")
    return {"touch", palpate::test::sourceFolder() + "/data/scenes/container.yaml", "--path", file};
  if (name == "labels") return {"info", image, "--names", file};
  if (name == "vdb" || name == "stl" || name == "obj" || name == "ply" || name == "vtk" ||
      name == "gltf" || name == "glb") {
    return {"check", file};
  }
  return {"query", file, "--at", "0,0,0"};
}

/// A fault of the run; "" if there is none.
std::string faultOf(const Run& run, std::size_t input) {
  if (run.timed_out) return "hangs";
  if (WIFSIGNALED(run.status)) return "signal " + std::to_string(WTERMSIG(run.status));
  const int code = WEXITSTATUS(run.status);
  if (code != 0 && code != 1 && code != 2 && code != 3) return "exit code " + std::to_string(code);
  if (run.resident > kMostResident && input < 10'000'000) {
    return std::to_string(run.resident / 1024) + " MB";
  }
  return {};
}

struct Totals {
  int runs = 0;
  int faults = 0;
};

struct Sweep {
  int mutants = 20;
  std::uint64_t seed = 1;
  std::string program;
  fs::path folder;
  std::string image;
};

/// Index of the sound file that is damaged in turn `i`; `sound` are their times.
std::size_t turnOf(std::size_t i, const std::vector<double>& sound) {
  const std::size_t first = i % sound.size();
  if ((i / sound.size()) % kTurnsOfSlow == 0) return first;
  for (std::size_t k = 0; k < sound.size(); ++k) {
    const std::size_t next = (first + k) % sound.size();
    if (sound[next] <= kSlowSound) return next;
  }
  return first;
}

/// Damages the files of one format, and prints its line.
Totals sweepFormat(const Sweep& sweep, const Reader& reader) {
  const std::vector<std::string> seeds = palpate::fuzz::seedsOf(reader.name);
  std::map<int, int> codes;
  long most = 0;
  double seconds = 0.0;
  Totals totals;
  // A separate folder, because a DICOM series is everything in one folder.
  const fs::path own = sweep.folder / reader.name;
  fs::create_directories(own);
  if (std::string(reader.name) == "dicom") {
    std::string second = seeds.front();
    second.replace(second.find("0\\0\\0"), 5, "0\\0\\1");
    std::ofstream(own / "second.dcm", std::ios::binary) << second;
  }
  const std::string file = own / (std::string("mutant") + reader.extension);
  const std::vector<std::string> command = commandFor(reader, file, sweep.image);
  std::vector<double> sound;  // [s]
  for (const std::string& whole : seeds) {
    std::ofstream(file, std::ios::binary) << whole;
    sound.push_back(run(sweep.program, command, kMostSound).seconds);
  }
  for (const Damage& damage : palpate::fuzz::damages()) {
    palpate::fuzz::Random random(sweep.seed);
    for (int i = 0; i < sweep.mutants; ++i) {
      const std::size_t from = turnOf(static_cast<std::size_t>(i), sound);
      std::string bytes = seeds[from];
      damage.apply(bytes, random);
      std::ofstream(file, std::ios::binary) << bytes;
      // Twice the time of the sound file, because the machine may be busier now.
      const Run result = run(sweep.program, command, 2.0 * sound[from] + kSeconds);
      ++totals.runs;
      seconds += result.seconds;
      most = std::max(most, result.resident);
      if (WIFEXITED(result.status)) ++codes[WEXITSTATUS(result.status)];
      const std::string fault = faultOf(result, bytes.size());
      if (fault.empty()) continue;
      ++totals.faults;
      const std::string kept = sweep.folder / (std::string(reader.name) + "_" + damage.name + "_" +
                                               std::to_string(i) + reader.extension);
      fs::copy_file(file, kept, fs::copy_options::overwrite_existing);
      std::printf("  %s: %s\n", kept.c_str(), fault.c_str());
    }
  }
  std::printf("%-10s %8d %8d %8d %8d %10ld %8.1f %8d\n", reader.name, totals.runs, codes[0],
              codes[1], codes[3], most / 1024, 1e3 * seconds / totals.runs, totals.faults);
  std::fflush(stdout);
  return totals;
}

/// Waits for one of the processes that each sweep a format; its findings come through `from`.
void await(int from, Totals& all) {
  Totals totals;
  int status = 0;
  (void)wait(&status);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0 &&
      read(from, &totals, sizeof totals) == static_cast<ssize_t>(sizeof totals)) {
    all.runs += totals.runs;
    all.faults += totals.faults;
  } else {
    std::printf("  the sweep of a format ended before its time\n");
    ++all.faults;
  }
}

}  // namespace

int main(int argc, char** argv) {
  Sweep sweep;
  sweep.mutants = argc > 1 ? std::atoi(argv[1]) : sweep.mutants;
  if (argc > 2) sweep.seed = static_cast<std::uint64_t>(std::atoll(argv[2]));
  if (argc > 3 && std::string(argv[3]) != "-") sweep.program = argv[3];
  std::vector<Reader> chosen;
  for (const Reader& reader : palpate::fuzz::readers()) {
    if (argc < 5 || std::count(argv + 4, argv + argc, std::string(reader.name)) > 0) {
      chosen.push_back(reader);
    }
  }
  if (sweep.mutants <= 0 || (argc > 4 && chosen.size() + 4 != static_cast<std::size_t>(argc))) {
    std::fprintf(stderr,
                 "usage: palpate_damage_sweep [MUTANTS, 1 or more] [SEED] [COMMAND] [FORMAT...]\n"
                 "formats:");
    for (const Reader& reader : palpate::fuzz::readers()) std::fprintf(stderr, " %s", reader.name);
    std::fprintf(stderr, "\n");
    return 2;
  }
  sweep.folder = fs::current_path() / "damage_sweep";
  fs::create_directories(sweep.folder);
  sweep.image = sweep.folder / "image.nii";
  std::ofstream(sweep.image, std::ios::binary) << palpate::fuzz::seedsOf("nifti").front();
  std::printf("%-10s %8s %8s %8s %8s %10s %8s %8s\n", "format", "runs", "exit 0", "exit 1",
              "exit 3", "most MB", "ms each", "faults");
  std::fflush(stdout);
  int ends[2] = {};
  if (pipe(ends) != 0) return 2;
  Totals all;
  unsigned running = 0;
  for (const Reader& reader : chosen) {
    if (running == std::max(1U, std::thread::hardware_concurrency())) {
      await(ends[0], all);
      --running;
    }
    const pid_t process = fork();
    if (process == 0) {
      const Totals totals = sweepFormat(sweep, reader);
      _exit(write(ends[1], &totals, sizeof totals) == static_cast<ssize_t>(sizeof totals) ? 0 : 1);
    }
    ++running;
  }
  for (; running > 0; --running) await(ends[0], all);
  std::printf("%d runs, %zu kinds of damage, %zu formats: %d faults\n", all.runs,
              palpate::fuzz::damages().size(), chosen.size(), all.faults);
  return all.faults == 0 ? 0 : 1;
}
