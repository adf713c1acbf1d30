#pragma once
/// .vdb streams with errors. OpenVDB's own io::File ignores the state of its streams, so that a
/// full disk or a file cut short goes unnoticed. Here every short read or write throws
/// std::ios_base::failure, and every length is checked (vdb_walk.h) before OpenVDB uses it.

#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/openvdb.h>

#include <iosfwd>
#include <string>
#include <vector>

namespace palpate::vdb {

class VdbArchive : public openvdb::io::Archive {
 public:
  /// `stream` must be seekable and have its exceptions on; the bytes are those of io::File.
  void writeTo(std::ostream& stream, const openvdb::GridCPtrVec& grids);

  /// One grid of a file: name, metadata and transform, and its tree once it has been read.
  struct Entry {
    openvdb::io::GridDescriptor descriptor;
    openvdb::GridBase::Ptr grid;
    bool has_tree = false;
    [[nodiscard]] std::string name() const;
  };

  /// Reads the list of grids. `stream` must be seekable and have its exceptions on.
  /// @throws exceptions of many types, all derived from std::exception, for a file that is not .vdb
  /// or is damaged.
  void open(std::istream& stream);
  [[nodiscard]] const std::vector<Entry>& entries() const noexcept { return entries_; }

  /// Reads the whole tree of an entry, also if the entry shares another entry's tree. @throws
  /// std::exception as open() does.
  openvdb::GridBase::Ptr readGridOf(std::istream& stream, const Entry& entry) const;

  /// Reads an entry's tree without the values of its leaves.
  static openvdb::GridBase::Ptr readTopologyOf(std::istream& stream, const Entry& entry);

 private:
  std::vector<Entry> entries_;
};

}  // namespace palpate::vdb
