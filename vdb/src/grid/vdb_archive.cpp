#include "grid/vdb_archive.h"

#include <istream>
#include <ostream>
#include <stdexcept>
#include <utility>

#include "grid/vdb_walk.h"
#include "palpate/vdb/openvdb_access.h"

namespace palpate::vdb {
namespace {

/// Checks every length in a tree before anything of it is read.
void checkTreeOf(std::istream& stream, const VdbArchive::Entry& entry, bool with_voxels) {
  VdbWalk(stream).checkTree(entry.descriptor.getGridPos(), entry.descriptor.gridType(),
                            entry.descriptor.saveFloatAsHalf(), with_voxels);
}

}  // namespace

std::string VdbArchive::Entry::name() const {
  return openvdb::io::GridDescriptor::nameAsString(descriptor.uniqueName());
}

void VdbArchive::writeTo(std::ostream& stream, const openvdb::GridCPtrVec& grids) {
  initializeOpenVdb();
  setCompression(openvdb::io::COMPRESS_BLOSC | openvdb::io::COMPRESS_ACTIVE_MASK);
  setInstancingEnabled(false);  // so that a reader can take each grid by itself
  write(stream, grids, /*seekable=*/true);
}

void VdbArchive::open(std::istream& stream) {
  initializeOpenVdb();
  VdbWalk(stream).checkHeads();
  readHeader(stream);
  setFormatVersion(stream);
  setLibraryVersion(stream);
  setDataCompression(stream);
  openvdb::MetaMap().readMeta(stream);
  const std::int32_t count = readGridCount(stream);
  for (std::int32_t i = 0; i < count; ++i) {
    Entry entry;
    entry.grid = entry.descriptor.read(stream);
    if (inputHasGridOffsets()) {
      entry.descriptor.seekToGrid(stream);
      readGridCompression(stream);
      entry.grid->readMeta(stream);
      entry.grid->readTransform(stream);
      entry.descriptor.seekToEnd(stream);
    } else {
      readGrid(entry.grid, entry.descriptor, stream);  // a stream can only be read in order
      entry.has_tree = true;
    }
    entries_.push_back(std::move(entry));
  }
}

openvdb::GridBase::Ptr VdbArchive::readGridOf(std::istream& stream, const Entry& entry) const {
  if (!entry.has_tree) {
    if (!entry.descriptor.isInstance()) checkTreeOf(stream, entry, /*with_voxels=*/true);
    entry.descriptor.seekToGrid(stream);
    readGrid(entry.grid, entry.descriptor, stream);
  }
  if (!entry.descriptor.isInstance()) return entry.grid;
  for (const Entry& parent : entries_) {
    if (parent.descriptor.uniqueName() != entry.descriptor.instanceParentName()) continue;
    if (parent.descriptor.isInstance()) break;
    entry.grid->setTree(readGridOf(stream, parent)->baseTreePtr());
    return entry.grid;
  }
  throw std::runtime_error("'" + entry.name() +
                           "' shares the voxels of a grid that is not in the file");
}

openvdb::GridBase::Ptr VdbArchive::readTopologyOf(std::istream& stream, const Entry& entry) {
  if (entry.has_tree || entry.descriptor.isInstance()) return entry.grid;
  checkTreeOf(stream, entry, /*with_voxels=*/false);
  entry.descriptor.seekToGrid(stream);
  readGridCompression(stream);
  entry.grid->readMeta(stream);
  entry.grid->readTransform(stream);
  entry.grid->readTopology(stream);
  return entry.grid;
}

}  // namespace palpate::vdb
