#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "cache_folder.h"
#include "input_kind.h"
#include "loaded_scene.h"
#include "pack/bundle.h"
#include "pack/contents.h"
#include "pack/pack_scene.h"
#include "pack/packed_scene.h"
#include "palpate/vdb/kept_grids.h"
#include "palpate/vdb/text.h"
#include "palpate/version.h"
#include "text.h"

namespace palpate::tools {
namespace {

namespace fs = std::filesystem;

Error packError(std::string code, std::string message, std::string hint, std::string file) {
  return Error(ErrorKind::kOperation,
               {std::move(code), std::move(message), std::move(hint), std::move(file)});
}

/// A new folder beside the target; the destructor removes it unless it was put in place.
class NewFolder {
 public:
  NewFolder(std::string wanted, bool force) : wanted_(std::move(wanted)) {
    while (wanted_.size() > 1 && wanted_.back() == '/') wanted_.pop_back();
    std::error_code failed;
    if (fs::exists(fs::symlink_status(wanted_, failed))) {
      if (!force) {
        throw packError("file.exists", "it exists already", "--force replaces a bundle", wanted_);
      }
      if (!isBundle(wanted_) || fs::is_symlink(fs::symlink_status(wanted_, failed))) {
        throw packError("file.exists", "the folder exists and is not a bundle",
                        "name another folder: only bundles are replaced", wanted_);
      }
      if (const auto foreign = foreignIn(wanted_)) {
        throw packError("file.exists",
                        "the bundle there holds '" + *foreign +
                            "', which pack did not write and which would be lost",
                        "move that out, or name another folder", wanted_);
      }
    }
    path_ = wanted_ + ".XXXXXX";
    if (mkdtemp(path_.data()) == nullptr) {
      const std::string why = strerror(errno);
      path_.clear();
      throw packError("file.write", "no folder can be made there: " + why, "", wanted_);
    }
    const mode_t mask = umask(0);
    umask(mask);
    static_cast<void>(!chmod(path_.c_str(), 0777U & ~mask));
  }
  ~NewFolder() {
    std::error_code ignored;
    if (!path_.empty()) fs::remove_all(path_, ignored);
  }
  NewFolder(const NewFolder&) = delete;
  NewFolder& operator=(const NewFolder&) = delete;

  [[nodiscard]] fs::path path() const { return path_; }
  [[nodiscard]] const std::string& wanted() const noexcept { return wanted_; }

  void putInPlace() {
    std::error_code failed;
    std::string old;
    if (fs::exists(wanted_, failed)) {
      old = path_ + ".old";
      fs::rename(wanted_, old, failed);
    }
    if (!failed) fs::rename(path_, wanted_, failed);
    if (failed) {
      std::error_code ignored;
      if (!old.empty()) fs::rename(old, wanted_, ignored);
      throw packError("file.write", "it cannot be put in place: " + failed.message(), "", wanted_);
    }
    path_.clear();
    if (!old.empty()) fs::remove_all(old, failed);
  }

 private:
  std::string wanted_;
  std::string path_;
};

void write(const fs::path& file, const std::string& text) {
  std::ofstream out(file, std::ios::binary);
  out << text;
  out.close();
  if (!out) throw packError("file.write", "writing failed", "", file.string());
}

/// The files of a scene, copied or replaced by stand-ins, under names within the bundle.
class Files {
 public:
  Files(const LoadedScene& scene, const std::string& scene_file, const Node& root, fs::path bundle)
      : scene_(scene),
        from_(fs::path(scene_file).parent_path()),
        root_(root),
        bundle_(std::move(bundle)) {}

  std::string name(Named what, const std::string& text, const std::string& image) {
    fs::path file = from_ / text;
    if (!file.has_filename()) file = file.parent_path();  // a folder may end with a slash
    if (what == Named::kFile) {
      std::string& known = copied_[file.lexically_normal().string()];
      if (known.empty()) known = copyFile(file);
      return known;
    }
    std::string& known = scans_[{image, file.lexically_normal().string()}];
    if (known.empty()) {
      known = isReadByMaterials(root_, image) ? copyScan(file, image)
                                              : standIn(file, image, what == Named::kScan);
    }
    return known;
  }

  [[nodiscard]] const Json& json() const noexcept { return json_; }
  [[nodiscard]] const std::string& text() const noexcept { return text_; }

 private:
  void tell(const char* role, const fs::path& file, const std::string& now) {
    json_.push_back({{"is", role},
                     {"name", file.filename().string()},
                     {"in_bundle", now.empty() ? Json() : Json(now)},
                     {"bytes", fs::file_size(file)},
                     {"hash", hashOf(file)}});
  }

  /// Copies a file into a folder of the bundle; under another name if its name is taken.
  std::string copy(const fs::path& file, const std::string& folder, const char* role) {
    const fs::path to = bundle_ / kBundleFiles / folder;
    fs::create_directories(to);
    fs::path name = file.filename();
    for (int n = 2; fs::exists(to / name); ++n) {
      name = std::to_string(n) + "_" + file.filename().string();
    }
    std::error_code failed;
    fs::copy_file(file, to / name, failed);
    if (failed) {
      throw packError("pack.copy", "it cannot be copied into the bundle: " + failed.message(), "",
                      file.string());
    }
    std::string now = (fs::path(kBundleFiles) / folder / name).lexically_normal().string();
    tell(role, file, now);
    return now;
  }

  /// Copies a mesh. Files that it names keep their places relative to it, in a folder of their own.
  std::string copyFile(const fs::path& file) {
    const std::vector<std::string> all = vdb::meshFiles(file.string());
    if (all.empty()) {
      throw inputError("pack.unreadable", "not all files that it names are there",
                       "export the mesh again, as GLB in one file for one", file.string());
    }
    if (all.size() == 1) return copy(file, "", "file");
    const std::string folder = "mesh_" + std::to_string(++mesh_folders_);
    const fs::path beside = file.parent_path().empty() ? "." : file.parent_path();
    for (std::size_t i = 1; i < all.size(); ++i) {
      const fs::path name =
          fs::path(all[i]).lexically_normal().lexically_relative(beside.lexically_normal());
      if (name.empty() || *name.begin() == "..") {
        throw inputError("pack.layout", "this mesh names a file in another folder than its own",
                         "put them into one folder, or export it as GLB", all[i]);
      }
      static_cast<void>(
          copy(all[i], (fs::path(folder) / name.parent_path()).string(), "buffer of a mesh"));
    }
    return copy(file, folder, "file");
  }

  [[nodiscard]] const SceneImage& imageOf(const std::string& name) const {
    for (const SceneImage& image : scene_.images()) {
      if (image.name == name) return image;
    }
    throw inputError("pack.image", "there is no image '" + name + "'");
  }

  /// Copies all files of a scan together under their own names, because headers refer to files by
  /// name.
  std::string copyScan(const fs::path& file, const std::string& name) {
    const SceneImage& image = imageOf(name);
    const std::string folder = "scan_" + std::to_string(scan_folders_.size() + 1);
    const auto [known, is_new] = scan_folders_.try_emplace(name, folder);
    const bool is_folder = fs::is_directory(file);
    if (is_new) {
      std::set<std::string> taken;
      for (const std::string& each : vdb::imageFiles(image.file, image.options)) {
        const fs::path one(each);
        const bool is_beside = fs::equivalent(one.parent_path().empty() ? "." : one.parent_path(),
                                              is_folder                    ? file
                                              : file.parent_path().empty() ? fs::path(".")
                                                                           : file.parent_path());
        if (!is_beside || !taken.insert(one.filename().string()).second) {
          throw inputError("pack.layout",
                           "a material reads this scan, whose files lie in several folders",
                           "put them into one folder", each);
        }
        static_cast<void>(copy(one, known->second, "scan, which a material reads"));
      }
      text_ += "  " + file.filename().string() + ": copied, as a material reads it\n";
    }
    const fs::path at = fs::path(kBundleFiles) / known->second;
    return is_folder ? at.string() : (at / file.filename()).string();
  }

  std::string standIn(const fs::path& file, const std::string& name, bool is_first) {
    const SceneImage& image = imageOf(name);
    std::string& known = stand_ins_[name];
    if (known.empty()) {
      fs::create_directories(bundle_ / kBundleFiles);
      known =
          (fs::path(kBundleFiles) / ("scan_" + std::to_string(stand_ins_.size()) + ".scan.yaml"))
              .string();
      write(bundle_ / known, vdb::scanStandIn(image.file, image.options));
      for (const std::string& each : vdb::imageFiles(image.file, image.options)) {
        tell("scan", each, "");
      }
    }
    if (is_first) text_ += "  " + file.filename().string() + ": not in it; its layers' grids are\n";
    return known;
  }

  const LoadedScene& scene_;
  fs::path from_;
  const Node& root_;
  const fs::path bundle_;
  std::map<std::string, std::string> copied_;
  int mesh_folders_ = 0;
  std::map<std::pair<std::string, std::string>, std::string> scans_;
  std::map<std::string, std::string> scan_folders_;
  std::map<std::string, std::string> stand_ins_;
  Json json_ = Json::array();
  std::string text_;
};

std::size_t gridsIn(const fs::path& folder) {
  std::size_t count = 0;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".vdb") ++count;
  }
  return count;
}

/// Opens the bundle as a user elsewhere would: the scene must find every grid in it.
void check(const fs::path& bundle) {
  Console silent(true);  // these notes were printed before
  keepNothing();
  const LoadedScene scene((bundle / kBundleScene).string(), silent);
  static_cast<void>(scene.compile(Purpose::kShow));
  std::size_t found = 0;
  for (const vdb::GridRecord& grid : scene.grids()) found += vdb::wasKept(grid.info) ? 1U : 0U;
  if (found >= gridsIn(bundle / kBundleGrids)) return;
  throw packError("pack.check", "the scene of the bundle does not find all of its grids",
                  "a file of the scene may have changed meanwhile: try again", bundle.string());
}

}  // namespace

Report run(const PackOptions& options, const GeneralOptions& general, Console& console) try {
  if (inputKind(options.scene) != InputKind::kScene) {
    throw Error(ErrorKind::kUsage,
                {"usage.pack", "only scenes can be packed",
                 "palpate touch --write-scene makes a scene of it", options.scene});
  }
  if (!bundleGridsOf(options.scene).empty()) {
    throw inputError("pack.bundle", "this is in a bundle already", "copy its folder",
                     options.scene);
  }
  NewFolder folder(options.output, general.force);
  const fs::path bundle = folder.path();
  const fs::path grids = bundle / kBundleGrids;
  fs::create_directory(grids);

  fillBundle(grids.string());
  LoadedScene loaded(options.scene, console);
  fillBundle({});
  // Asks for the layers' boxes before the layers are made, which puts the boxes into the bundle:
  // scenes ask for them to leave out layers.
  for (const LayerDescription& layer : loaded.description().layers) {
    if (layer.inside) static_cast<void>(layer.inside->bounds(console.progress()));
  }
  static_cast<void>(loaded.compile(Purpose::kShow));
  const auto document = readDocument(options.scene);
  Files files(loaded, options.scene, document->root, bundle);
  write(bundle / kBundleScene,
        packedText(*document, [&](Named what, const std::string& name, const std::string& image) {
          return files.name(what, name, image);
        }));
  Report report;
  report.json = {{"schema", "palpate.pack/1"},
                 {"made_by", "palpate " PALPATE_VERSION_STRING},
                 {"scene", fs::path(options.scene).filename().string()},
                 {"scene_hash", hashOf(options.scene)},
                 {"files", files.json()},
                 {"grids", loaded.gridsJson()},
                 {"contents", contentsOf(bundle)}};
  write(bundle / kBundleAbout,
        report.json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
  check(bundle);
  checkStop();
  std::uintmax_t bytes = 0;
  for (const auto& entry : fs::recursive_directory_iterator(bundle)) {
    if (entry.is_regular_file()) bytes += entry.file_size();
  }
  const std::size_t count = gridsIn(grids);
  folder.putInPlace();
  report.json["output"] = folder.wanted();
  report.json["bytes"] = bytes;
  report.text = files.text() + "Wrote " + folder.wanted() + ": " + std::to_string(count) +
                (count == 1 ? " grid" : " grids") + ", " + formatBytes(bytes) + "\n";
  return report;
} catch (const fs::filesystem_error& failed) {
  throw packError("file.write", "the bundle cannot be written: " + failed.code().message(), "",
                  failed.path1().string());
}

}  // namespace palpate::tools
