#pragma once
/// A .vdb file that is open for reading: its grids, with one kind of error for damage.

#include <exception>
#include <ios>
#include <istream>
#include <new>
#include <string>

#include "grid/stop_file.h"
#include "grid/vdb_archive.h"
#include "palpate/core/error.h"
#include "palpate/vdb/io.h"

namespace palpate::vdb {

/// Runs `read`, and turns any exception that OpenVDB throws for a damaged file into one kind of
/// error.
template <typename Read>
auto readingFrom(const std::string& path, const Read& read) {
  const char* const hint = "the file may be damaged or cut short; copy or write it again";
  const std::string what = "not a .vdb file that can be read: ";
  try {
    return read();
  } catch (const Error&) {
    throw;
  } catch (const std::ios_base::failure&) {
    throw inputError("vdb.unreadable", what + "it ends early", hint, path);
  } catch (const std::bad_alloc&) {
    throw inputError("vdb.unreadable", what + "it asks for more memory than there is", hint, path);
  } catch (const std::exception& error) {
    throw inputError("vdb.unreadable", what + error.what(), hint, path);
  }
}

class VdbFile {
 public:
  /// @throws Error (kInput, vdb.missing or vdb.unreadable).
  explicit VdbFile(std::string path);

  [[nodiscard]] const std::vector<VdbArchive::Entry>& entries() const noexcept {
    return archive_.entries();
  }
  /// The grid called `name`, or the only one if `name` is empty. @throws Error (kInput,
  /// vdb.no_grid, vdb.which_grid).
  [[nodiscard]] const VdbArchive::Entry& choose(const std::string& name) const;
  /// Reads the grid with all its voxels. @throws Error (kInput, vdb.unreadable).
  [[nodiscard]] openvdb::GridBase::Ptr read(const VdbArchive::Entry& entry);
  /// [bytes] The memory that the grid will take when it is read. Reads no voxels. @throws Error
  /// (kInput, vdb.unreadable).
  [[nodiscard]] std::uint64_t memoryOf(const VdbArchive::Entry& entry);
  /// One entry of listVdb(); reads no voxels. @throws Error (kInput, vdb.unreadable).
  [[nodiscard]] VdbGridSummary summaryOf(const VdbArchive::Entry& entry);

 private:
  std::string path_;
  StopBuffer buffer_;
  std::istream stream_{&buffer_};
  VdbArchive archive_;
};

/// "FloatGrid", ...
[[nodiscard]] std::string typeOf(const openvdb::GridBase& grid);
/// "level set", "fog volume", "staggered", "unknown".
[[nodiscard]] std::string classOf(const openvdb::GridBase& grid);
/// The grid's own length unit, or else `unit_if_missing`. @throws Error (kInput, vdb.no_unit) if
/// there is neither.
[[nodiscard]] std::string unitOf(const openvdb::GridBase& grid, const std::string& unit_if_missing,
                                 const std::string& path);

/// The level set that readVdb() returns for a grid. May change the grid's metadata.
/// @throws Error (kInput, vdb.*) with the reason if the grid cannot be used.
[[nodiscard]] LevelSet acceptLevelSet(const openvdb::GridBase::Ptr& base,
                                      const std::string& unit_if_missing,
                                      UnknownClass unknown_class, const std::string& path);

}  // namespace palpate::vdb
