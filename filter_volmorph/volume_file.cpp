#include "filter_volmorph/volume_file.h"

#include <openvdb/io/Archive.h>
#include <openvdb/io/Stream.h>
#include <openvdb/tools/Prune.h>
#include <openvdb/tree/LeafManager.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>
#include <vector>

#include "common/core/error.h"
#include "common/core/threads.h"
#include "filter_volmorph/file_seal.h"
#include "filter_volmorph/vdb_contents.h"
#include "filter_volmorph/volume_check.h"
#include "filter_volmorph/volume_grids.h"

namespace meshcomplete {
namespace {

namespace fs = std::filesystem;
using openvdb::GridBase;

constexpr int format_version = 1;
constexpr std::array<const char*, 4> grid_names = {"distance", "weight", "normal", "state"};
constexpr std::size_t leaves_per_range = 256;

// The file's metadata.
constexpr const char* format_name = "range_volume_format";
constexpr const char* ramp_name = "ramp";
constexpr const char* size_name = "voxel_size";
constexpr const char* origin_name = "origin";
constexpr const char* low_name = "box_low";
constexpr const char* high_name = "box_high";

/// A file whose reading or writing can be cancelled at any time.
class WatchedFile : public std::filebuf {
 public:
  /// `expected`: the bytes at which all is done, about.
  WatchedFile(const Progress& progress, double expected) : progress_(progress), expected_(expected) {}

 protected:
  std::streamsize xsputn(const char* bytes, std::streamsize count) override {
    watch(count);
    return std::filebuf::xsputn(bytes, count);
  }
  std::streamsize xsgetn(char* bytes, std::streamsize count) override {
    watch(count);
    return std::filebuf::xsgetn(bytes, count);
  }

 private:
  void watch(std::streamsize count) {
    done_ += double(count);
    progress_.update(done_ / expected_);
  }

  Progress progress_;
  double expected_;
  double done_ = 0;
};

/// OpenVDB writes files only by their names; into a stream that can be watched only by this.
struct WatchedArchive : openvdb::io::Archive {
  void write_to(std::ostream& file, const openvdb::GridCPtrVec& grids,
                const openvdb::MetaMap& metadata) const {
    write(file, grids, /*seekable=*/true, metadata);
  }
};

openvdb::math::Transform::Ptr transform_of(const VolumeFrame& frame) {
  const auto transform = openvdb::math::Transform::createLinearTransform(frame.voxel_size);
  transform->postTranslate({frame.origin.x(), frame.origin.y(), frame.origin.z()});
  return transform;
}

/// -ramp for the unseen voxels of a leaf; the others of the leaf have +ramp already.
void set_unseen(const openvdb::BoolTree::LeafNodeType& states, float ramp,
                openvdb::FloatTree::LeafNodeType& distances) {
  for (auto value = states.cbeginValueOff(); value; ++value)
    if (!value.getValue()) distances.setValueOff(value.pos(), -ramp);
}

/// The distances, with -ramp and +ramp where none are stored.
openvdb::FloatGrid::ConstPtr full_distances(const RangeVolume& volume, const Progress& progress) {
  const auto ramp = static_cast<float>(volume.frame().ramp);
  const openvdb::BoolTree& states = volume.grids().state->tree();
  const openvdb::FloatTree& distances = volume.grids().distance->tree();
  const auto tree = std::make_shared<openvdb::FloatTree>(states, ramp, openvdb::TopologyCopy());
  progress.update(0.3);
  auto uniform = states.cbeginValueOff();
  uniform.setMaxDepth(openvdb::BoolTree::ValueOffCIter::LEAF_DEPTH - 1);
  for (; uniform; ++uniform)
    if (!uniform.getValue()) tree->addTile(uniform.getLevel(), uniform.getCoord(), -ramp, false);
  auto stored = distances.cbeginValueOn();
  stored.setMaxDepth(openvdb::FloatTree::ValueOnCIter::LEAF_DEPTH - 1);
  for (; stored; ++stored) tree->sparseFill(stored.getBoundingBox(), stored.getValue(), true);
  for (auto leaf = distances.cbeginLeaf(); leaf; ++leaf) tree->touchLeaf(leaf->origin());
  progress.update(0.5);

  const openvdb::tree::LeafManager<openvdb::FloatTree> leaves(*tree);
  for_ranges(leaves.leafCount(), leaves_per_range, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      auto& leaf = leaves.leaf(i);
      if (const auto* known = states.probeConstLeaf(leaf.origin())) set_unseen(*known, ramp, leaf);
      if (const auto* known = distances.probeConstLeaf(leaf.origin()))
        for (auto value = known->cbeginValueOn(); value; ++value)
          leaf.setValueOn(value.pos(), value.getValue());
    }
    progress.advance(0.5 * double(end - begin) / double(leaves.leafCount()));
  });
  progress.update(1);
  return openvdb::FloatGrid::create(tree);
}

/// The grid with a name and a place; the tree is shared.
template <class Grid>
GridBase::ConstPtr named(const Grid& grid, const char* name, const VolumeFrame& frame) {
  openvdb::MetaMap metadata;
  metadata.insertMeta(GridBase::META_GRID_NAME, openvdb::StringMetadata(name));
  // What makes other programs draw its zero as a surface.
  if (std::string(name) == "distance")
    metadata.insertMeta(GridBase::META_GRID_CLASS,
                        openvdb::StringMetadata(GridBase::gridClassToString(openvdb::GRID_LEVEL_SET)));
  return grid.copyReplacingMetadataAndTransform(metadata, transform_of(frame));
}

openvdb::MetaMap metadata_of(const VolumeFrame& frame) {
  const auto vector = [](const auto& v) { return openvdb::math::Vec3(v.x(), v.y(), v.z()); };
  openvdb::MetaMap metadata;
  metadata.insertMeta(format_name, openvdb::Int32Metadata(format_version));
  metadata.insertMeta(ramp_name, openvdb::DoubleMetadata(frame.ramp));
  metadata.insertMeta(size_name, openvdb::DoubleMetadata(frame.voxel_size));
  metadata.insertMeta(origin_name, openvdb::Vec3DMetadata(vector(frame.origin)));
  metadata.insertMeta(low_name, openvdb::Vec3IMetadata(vector(frame.box.low)));
  metadata.insertMeta(high_name, openvdb::Vec3IMetadata(vector(frame.box.high)));
  return metadata;
}

void write_file(const RangeVolume& volume, const std::string& path, const Progress& progress) {
  const VolumeGrids& grids = volume.grids();
  const VolumeFrame& frame = volume.frame();
  const auto distance = full_distances(volume, progress.part(0, 0.2, "Preparing the volume's file"));
  const openvdb::GridCPtrVec all = {
      named(*distance, grid_names[0], frame), named(*grids.weight, grid_names[1], frame),
      named(*grids.normal, grid_names[2], frame), named(*grids.state, grid_names[3], frame)};
  WatchedFile buffer(progress.part(0.2, 0.9, "Writing the volume"), 0.5 * double(volume.memory()) + 1);
  if (!buffer.open(path, std::ios::out | std::ios::binary | std::ios::trunc))
    throw std::ios_base::failure("cannot open");
  std::ostream file(&buffer);
  file.exceptions(std::ios::failbit | std::ios::badbit);
  WatchedArchive().write_to(file, all, metadata_of(frame));
  if (!buffer.close()) throw std::ios_base::failure("cannot close");
  seal_file(path, progress.part(0.9, 1, "Writing the volume"));
}

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw CompletionError("opening the volume", "The file \"" + path + "\" " + why);
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "\"" : ", \"") + name + "\"";
  return text.empty() ? "none" : text;
}

/// Says what is wrong with a file that has no seal.
[[noreturn]] void refuse_unsealed(const std::string& path) {
  const std::optional<VdbContents> contents = vdb_contents(path);
  if (!contents) refuse(path, "is not a .vdb file, or its beginning is damaged.");
  const auto has = [](const std::vector<std::string>& names, const char* name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  if (has(contents->metadata, format_name))
    refuse(path, "is damaged: its end is missing or was changed. Save the volume again.");
  std::vector<std::string> missing;
  for (const char* name : grid_names)
    if (!has(contents->grids, name)) missing.emplace_back(name);
  refuse(path, "was not saved by \"Range Volume: Save\". Its grids: " + listed(contents->grids) +
                   ". Missing for a range volume: " +
                   (missing.empty() ? "the volume's ramp, box and seal" : listed(missing)) + ".");
}

struct ReadFile {
  openvdb::MetaMap::Ptr metadata;
  openvdb::GridPtrVec grids;
};

/// The content of a sealed file.
ReadFile read_file(const std::string& path, const Progress& progress) {
  WatchedFile buffer(progress, double(fs::file_size(path)));
  if (!buffer.open(path, std::ios::in | std::ios::binary)) throw std::ios_base::failure("cannot open");
  std::istream file(&buffer);
  // OpenVDB itself would read on behind the end.
  file.exceptions(std::ios::failbit | std::ios::badbit | std::ios::eofbit);
  openvdb::io::Stream stream(file, /*delayLoad=*/false);
  return {stream.getMetadata(), *stream.getGrids()};
}

template <class T>
T metadata_value(const openvdb::MetaMap& metadata, const char* name, const std::string& path) {
  const auto value = metadata.getMetadata<openvdb::TypedMetadata<T>>(name);
  if (!value) refuse(path, std::string("lacks the volume's \"") + name + "\".");
  return value->value();
}

VolumeFrame frame_of(const openvdb::MetaMap& metadata, const std::string& path) {
  const int version = metadata_value<std::int32_t>(metadata, format_name, path);
  if (version != format_version)
    refuse(path, "is of version " + std::to_string(version) + " of the format; this program reads version " +
                     std::to_string(format_version) + ".");
  const auto origin = metadata_value<openvdb::Vec3d>(metadata, origin_name, path);
  const auto low = metadata_value<openvdb::Vec3i>(metadata, low_name, path);
  const auto high = metadata_value<openvdb::Vec3i>(metadata, high_name, path);
  VolumeFrame frame;
  frame.origin = {origin.x(), origin.y(), origin.z()};
  frame.voxel_size = metadata_value<double>(metadata, size_name, path);
  frame.ramp = metadata_value<double>(metadata, ramp_name, path);
  frame.box = {{low.x(), low.y(), low.z()}, {high.x(), high.y(), high.z()}};
  if (const auto fault = frame_fault(frame)) refuse(path, "contradicts itself: " + *fault + ".");
  return frame;
}

/// The tree of the grid with the name.
template <class Grid>
typename Grid::Ptr grid_of(const openvdb::GridPtrVec& grids, const char* name, const VolumeFrame& frame,
                           const std::string& path) {
  std::vector<std::string> names;
  for (const GridBase::Ptr& grid : grids) {
    names.push_back(grid->getName());
    if (grid->getName() != name) continue;
    const auto typed = openvdb::gridPtrCast<Grid>(grid);
    if (!typed)
      refuse(path, std::string("has a grid \"") + name + "\" of another type, " + grid->type() + ".");
    if (grid->transform() != *transform_of(frame))
      refuse(path, std::string("contradicts itself: the grid \"") + name +
                       "\" lies elsewhere than its origin and voxel size say.");
    return Grid::create(typed->treePtr());
  }
  refuse(path, std::string("lacks the grid \"") + name + "\". Its grids: " + listed(names) + ".");
}

RangeVolume volume_of(const ReadFile& file, const std::string& path, const Progress& progress) {
  const VolumeFrame frame = frame_of(*file.metadata, path);
  const auto distance = grid_of<openvdb::FloatGrid>(file.grids, grid_names[0], frame, path);
  const auto weight = grid_of<openvdb::FloatGrid>(file.grids, grid_names[1], frame, path);
  const auto normal = grid_of<openvdb::Int32Grid>(file.grids, grid_names[2], frame, path);
  const auto state = grid_of<openvdb::BoolGrid>(file.grids, grid_names[3], frame, path);
  // -ramp and +ramp follow from the states again.
  openvdb::tools::pruneInactive(distance->tree());
  VolumeGrids grids{state, distance, weight, normal};
  const RangeVolume volume(frame, std::make_shared<const VolumeGrids>(std::move(grids)));
  if (const auto fault = volume_fault(volume, progress)) refuse(path, "contradicts itself: " + *fault + ".");
  return volume;
}

}  // namespace

void save_volume(const RangeVolume& volume, const std::string& path, const Progress& progress) {
  prepare_openvdb();
  const std::string part = path + ".part";
  const auto fail = [&] {
    std::error_code ignored;
    fs::remove(part, ignored);
  };
  try {
    write_file(volume, part, progress);
    fs::rename(part, path);
  } catch (const CompletionError&) {
    fail();
    throw;
  } catch (const std::exception&) {
    fail();
    throw CompletionError("saving the volume",
                          "The file \"" + path +
                              "\" cannot be written. Does its folder exist, may you write "
                              "there, and is there room on the disk?");
  }
}

RangeVolume open_volume(const std::string& path, const Progress& progress) {
  prepare_openvdb();
  std::error_code error;
  if (!fs::exists(path, error)) refuse(path, "does not exist.");
  if (!fs::is_regular_file(path, error)) refuse(path, "is not a file.");
  try {
    switch (check_seal(path, progress.part(0, 0.2, "Checking the file"))) {
      case FileSeal::whole:
        break;
      case FileSeal::damaged:
        refuse(path, "is damaged: its checksum is wrong. Save the volume again.");
      case FileSeal::absent:
        refuse_unsealed(path);
    }
    const ReadFile file = read_file(path, progress.part(0.2, 0.8, "Reading the volume"));
    return volume_of(file, path, progress.part(0.8, 1, "Checking the volume"));
  } catch (const CompletionError&) {
    throw;
  } catch (const std::bad_alloc&) {
    refuse(path, "needs more memory than there is.");
  } catch (const std::exception& failure) {
    refuse(path, std::string("cannot be read: ") + failure.what() + ".");
  }
}

}  // namespace meshcomplete
