#include "filter_volmorph/volume_file.h"

#include <gtest/gtest.h>
#include <openvdb/io/File.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>

#include "common/core/error.h"
#include "filter_volmorph/file_seal.h"
#include "tests/support/cancelling.h"
#include "tests/volmorph/dense_operators.h"

namespace meshcomplete {
namespace {

namespace fs = std::filesystem;
const Progress silent;

/// A folder of its own for each test.
class VolumeFile : public testing::Test {
 protected:
  VolumeFile()
      : folder_(fs::temp_directory_path() /
                ("volume_file_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) +
                 std::to_string(::getpid()))) {
    fs::create_directories(folder_);
  }
  ~VolumeFile() override { fs::remove_all(folder_); }

  std::string path(const char* name = "volume.vdb") const { return (folder_ / name).string(); }

  fs::path folder_;
};

std::string read_bytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write_bytes(const std::string& path, const std::string& bytes) {
  fs::remove(path);  // a new file: some file systems flush one that is cut and written again
  std::ofstream(path, std::ios::binary | std::ios::trunc).write(bytes.data(), std::streamsize(bytes.size()));
}

/// What opening says; empty when it opens.
std::string error_of(const std::string& path) {
  try {
    open_volume(path, silent);
  } catch (const CompletionError& error) {
    return error.what();
  }
  return "";
}

void expect_says(const std::string& path, const std::string& part) {
  EXPECT_NE(error_of(path).find(part), std::string::npos) << error_of(path);
}

RangeVolume small_volume() {
  DenseVolume dense = random_volume({{-11, -3, 5}, {9, 17, 22}}, 1);
  dense.frame.origin = {0.1, -20, 1e6 / 3};
  dense.frame.voxel_size = 0.3;
  return dense.volume();
}

void expect_same_after_opening(const RangeVolume& volume, const std::string& path) {
  save_volume(volume, path, silent);
  const RangeVolume opened = open_volume(path, silent);
  const VolumeFrame &a = volume.frame(), &b = opened.frame();
  EXPECT_EQ(a.origin, b.origin);
  EXPECT_EQ(a.voxel_size, b.voxel_size);
  EXPECT_EQ(a.ramp, b.ramp);
  EXPECT_EQ(a.box.low, b.box.low);
  EXPECT_EQ(a.box.high, b.box.high);
  EXPECT_EQ(count_differences(DenseVolume(volume), DenseVolume(opened)), 0u);
  EXPECT_EQ(volume.counts().seen, opened.counts().seen);
  EXPECT_EQ(volume.counts().unseen, opened.counts().unseen);
  EXPECT_EQ(volume.counts().empty, opened.counts().empty);
  EXPECT_LE(opened.memory(), volume.memory() + 1000);
  for (const auto& entry : fs::directory_iterator(fs::path(path).parent_path()))
    EXPECT_EQ(entry.path(), path) << "left behind";
}

TEST_F(VolumeFile, gives_back_every_bit) {
  expect_same_after_opening(small_volume(), path());
  expect_same_after_opening(with_filler_distances(small_volume()), path());
  expect_same_after_opening(sphere_volume(70), path());
  expect_same_after_opening(uniform_seen_volume(), path());
  for (std::uint32_t seed = 0; seed < 6; ++seed)
    expect_same_after_opening(patchy_volume({{-140, -8, -9}, {150, 20, 15}}, seed), path());
  VolumeFrame frame;
  frame.box = {{3, 3, 3}, {3, 3, 3}};
  expect_same_after_opening(VolumeBuilder(frame).finish(), path());
}

TEST_F(VolumeFile, is_a_proper_field_for_other_programs) {
  const RangeVolume volume = patchy_volume({{-140, -8, -9}, {150, 20, 15}}, 3);
  const RangeVolume placed = [&] {
    VolumeFrame frame = volume.frame();
    frame.origin = {5, 6, 7};
    frame.voxel_size = 0.5;
    return RangeVolume(frame, std::make_shared<const VolumeGrids>(volume.grids()));
  }();
  save_volume(placed, path(), silent);
  openvdb::io::File file(path());
  file.open(/*delayLoad=*/false);
  const auto distance = openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid("distance"));
  const auto state = openvdb::gridPtrCast<openvdb::BoolGrid>(file.readGrid("state"));
  ASSERT_TRUE(distance && state && file.hasGrid("weight") && file.hasGrid("normal"));
  EXPECT_EQ(distance->background(), 4);
  EXPECT_EQ(distance->transform().indexToWorld(openvdb::Coord(2, 0, -4)), openvdb::Vec3d(6, 6, 5));
  EXPECT_EQ(distance->voxelSize(), openvdb::Vec3d(0.5));
  EXPECT_EQ(distance->getGridClass(), openvdb::GRID_LEVEL_SET);
  std::uint64_t inside = 0;
  DenseVolume(volume).for_each([&](const VoxelIndex& at, const Voxel& voxel) {
    ASSERT_EQ(distance->tree().getValue(to_coord(at)), voxel.distance) << at.transpose();
    if (voxel.state == VoxelState::unseen) ++inside;
  });
  EXPECT_GT(inside, 0u);
  EXPECT_EQ(distance->tree().getValue(openvdb::Coord(1000, 0, 0)), 4) << "empty outside the box";
  file.close();
}

TEST_F(VolumeFile, replaces_an_older_file_only_when_all_is_written) {
  const RangeVolume volume = sphere_volume(60);
  write_bytes(path(), "older");
  test::expect_cancels_at_any_step([&](const Progress& progress) {
    try {
      save_volume(volume, path(), progress);
    } catch (const Cancelled&) {
      EXPECT_EQ(read_bytes(path()), "older");
      EXPECT_FALSE(fs::exists(path() + ".part"));
      throw;
    }
  });
  EXPECT_EQ(error_of(path()), "");
  test::expect_cancels_at_any_step([&](const Progress& progress) { open_volume(path(), progress); });
}

TEST_F(VolumeFile, says_when_it_cannot_be_written) {
  const RangeVolume volume = small_volume();
  EXPECT_THROW(save_volume(volume, path("no/such/folder.vdb"), silent), CompletionError);
  fs::create_directories(path("folder.vdb") + "/full");
  EXPECT_THROW(save_volume(volume, path("folder.vdb"), silent), CompletionError);
  EXPECT_FALSE(fs::exists(path("folder.vdb.part")));
  if (fs::exists("/dev/full")) {
    fs::create_symlink("/dev/full", path("full.vdb.part"));
    EXPECT_THROW(save_volume(volume, path("full.vdb"), silent), CompletionError);
  }
}

TEST_F(VolumeFile, says_when_there_is_none) {
  expect_says(path("nothing.vdb"), "does not exist");
  expect_says(folder_.string(), "is not a file");
  write_bytes(path(), "");
  expect_says(path(), "is not a .vdb file");
  write_bytes(path(), "ply\nformat ascii 1.0\n");
  expect_says(path(), "is not a .vdb file");
}

TEST_F(VolumeFile, refuses_one_that_was_cut_off_anywhere) {
  save_volume(small_volume(), path(), silent);
  const std::string bytes = read_bytes(path());
  ASSERT_GT(bytes.size(), 5000u);
  for (std::size_t length = 0; length < bytes.size(); length += length < 1000 ? 1 : 211) {
    write_bytes(path("cut.vdb"), bytes.substr(0, length));
    ASSERT_NE(error_of(path("cut.vdb")), "") << length << " bytes";
  }
  write_bytes(path("cut.vdb"), bytes.substr(0, bytes.size() - 1));
  expect_says(path("cut.vdb"), "is damaged");
  write_bytes(path("cut.vdb"), bytes + "x");
  expect_says(path("cut.vdb"), "is damaged");
}

TEST_F(VolumeFile, refuses_one_with_any_byte_changed) {
  save_volume(small_volume(), path(), silent);
  const std::string bytes = read_bytes(path());
  for (std::size_t i = 0; i < bytes.size(); i += (i < 1000 || i + 100 > bytes.size()) ? 1 : 211) {
    std::string changed = bytes;
    changed[i] = static_cast<char>(changed[i] ^ (i % 2 == 0 ? 0xff : 0x01));
    write_bytes(path("changed.vdb"), changed);
    ASSERT_NE(error_of(path("changed.vdb")), "") << "byte " << i;
    // The same without the seal, as a foreign file: its head is not believed either.
    write_bytes(path("changed.vdb"), changed.substr(0, bytes.size() - 24));
    ASSERT_NE(error_of(path("changed.vdb")), "") << "byte " << i;
  }
}

TEST_F(VolumeFile, says_which_grids_a_foreign_one_has) {
  prepare_openvdb();
  const auto density = openvdb::FloatGrid::create(0), heat = openvdb::FloatGrid::create(0);
  density->setName("density");
  heat->setName("distance");
  density->tree().setValueOn({1, 2, 3}, 5);
  openvdb::io::File(path()).write(openvdb::GridPtrVec{density, heat});
  expect_says(path(), "Its grids: \"density\", \"distance\"");
  expect_says(path(), "Missing for a range volume: \"weight\", \"normal\", \"state\"");
}

/// Saves a volume, changes what the file holds through OpenVDB, and seals it again.
void alter(const std::string& path,
           const std::function<void(openvdb::GridPtrVec& grids, openvdb::MetaMap& metadata)>& change) {
  save_volume(small_volume(), path, silent);
  openvdb::io::File file(path);
  file.open(/*delayLoad=*/false);
  openvdb::GridPtrVec grids = *file.getGrids();
  openvdb::MetaMap metadata = *file.getMetadata();
  file.close();
  change(grids, metadata);
  openvdb::io::File(path).write(grids, metadata);
  seal_file(path, silent);
}

template <class Metadata, class Value>
void expect_refused(const std::string& path, const char* name, const Value& value, const std::string& says) {
  alter(path, [&](openvdb::GridPtrVec&, openvdb::MetaMap& metadata) {
    metadata.removeMeta(name);
    metadata.insertMeta(name, Metadata(value));
  });
  expect_says(path, says);
}

TEST_F(VolumeFile, is_still_good_when_written_by_openvdb_and_sealed) {
  alter(path(), [](openvdb::GridPtrVec&, openvdb::MetaMap&) {});
  ASSERT_EQ(error_of(path()), "");
  EXPECT_EQ(count_differences(DenseVolume(open_volume(path(), silent)), DenseVolume(small_volume())), 0u);
}

TEST_F(VolumeFile, refuses_wrong_metadata) {
  using namespace openvdb;
  expect_refused<Int32Metadata>(path(), "range_volume_format", 2, "is of version 2");
  expect_refused<StringMetadata>(path(), "range_volume_format", "1",
                                 "lacks the volume's \"range_volume_format\"");
  expect_refused<DoubleMetadata>(path(), "voxel_size", -1., "voxel size is not a number greater than 0");
  expect_refused<DoubleMetadata>(path(), "voxel_size", 0.4, "lies elsewhere");
  expect_refused<DoubleMetadata>(path(), "ramp", 0., "ramp is not a number greater than 0");
  expect_refused<Vec3DMetadata>(path(), "origin", Vec3d(0, NAN, 0), "origin is not a point");
  expect_refused<Vec3IMetadata>(path(), "box_low", Vec3i(100, 0, 0), "box has no voxels");
  expect_refused<Vec3IMetadata>(path(), "box_high", Vec3i(1 << 29, 50, 50), "box is too large");
  expect_refused<Vec3IMetadata>(path(), "box_high", Vec3i(5, 17, 22), "voxels outside its box");
  alter(path(), [](GridPtrVec&, MetaMap& metadata) { metadata.removeMeta("ramp"); });
  expect_says(path(), "lacks the volume's \"ramp\"");
}

TEST_F(VolumeFile, refuses_grids_that_contradict_each_other) {
  using namespace openvdb;
  const auto change = [&](const char* name, const std::function<void(GridBase::Ptr&)>& how) {
    alter(path(), [&](GridPtrVec& grids, MetaMap&) {
      for (GridBase::Ptr& grid : grids)
        if (grid->getName() == name) how(grid);
    });
  };
  const Coord unseen = [] {
    Coord found;
    DenseVolume(small_volume()).for_each([&](const VoxelIndex& at, const Voxel& voxel) {
      if (voxel.state == VoxelState::unseen) found = to_coord(at);
    });
    return found;
  }();
  change("weight", [&](GridBase::Ptr& grid) { gridPtrCast<FloatGrid>(grid)->tree().setValueOn(unseen, 1); });
  expect_says(path(), "weights or normals at voxels that are not seen");
  change("state",
         [&](GridBase::Ptr& grid) { gridPtrCast<BoolGrid>(grid)->tree().setValueOn(unseen, false); });
  expect_says(path(), "seen voxels without a distance");
  change("state", [&](GridBase::Ptr& grid) {
    gridPtrCast<BoolGrid>(grid)->tree().setValueOff({50, 0, 0}, false);
  });
  expect_says(path(), "voxels outside its box");
  change("distance",
         [&](GridBase::Ptr& grid) { gridPtrCast<FloatGrid>(grid)->tree().setValueOn(unseen, NAN); });
  expect_says(path(), "distances that are not finite");
  change("weight", [](GridBase::Ptr& grid) {
    const auto tree = gridPtrCast<FloatGrid>(grid)->treePtr();
    tree->setValueOnly(tree->cbeginValueOn().getCoord(), -1);
  });
  expect_says(path(), "weights below 0");
  change("normal", [](GridBase::Ptr& grid) {
    const auto tree = gridPtrCast<Int32Grid>(grid)->treePtr();
    tree->setValueOnly(tree->cbeginValueOn().getCoord(), 0);
  });
  expect_says(path(), "normals of length 0");
  change("normal", [](GridBase::Ptr& grid) {
    grid = FloatGrid::create();
    grid->setName("normal");
  });
  expect_says(path(), "a grid \"normal\" of another type");
  change("state", [](GridBase::Ptr& grid) { grid->setName("states"); });
  expect_says(path(), "lacks the grid \"state\"");
}

}  // namespace
}  // namespace meshcomplete
