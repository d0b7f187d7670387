#include "hv_loop_btc/btc_database.h"

#include <gtest/gtest.h>

#include "hv_loop_btc/plane_overlap.h"
#include "town.h"

namespace hv::loop {
namespace {

BtcDatabase::Filter Everything() {
  return {[](std::size_t) { return true; }, [](std::size_t, const Pose&) { return true; }};
}

/// Towns of other seeds, and one known place among them.
struct Library {
  explicit Library(int others) : database(BtcConfig()) {
    for (int i = 0; i < others; ++i) {
      const Town other(100 + static_cast<unsigned>(i));
      database.Add(Describe(other, SensorPose(0.0, 0.0, 0.1 * i)));
      if (i == others / 2) place = database.Add(Describe(town, SensorPose(0.0, 0.0, 0.0)));
    }
  }

  BtcDescriptor Describe(const Town& where, const Pose& pose) {
    return extractor.Extract(where.SubmapAt(next++, pose, random));
  }

  Town town{5};
  std::mt19937 random{4};
  BtcExtractor extractor{BtcConfig()};
  BtcDatabase database;
  std::size_t place = 0;
  std::uint32_t next = 0;
};

TEST(BtcDatabaseTest, FindsThePlaceAmongOthersFromAnyHeading) {
  Library library(60);
  for (const double yaw : {0.0, 0.7, 2.0, M_PI, -1.2}) {
    const Pose pose = SensorPose(0.6, -0.4, yaw, 0.03, -0.02);
    const BtcDescriptor query = library.Describe(library.town, pose);
    const auto found = library.database.Query(query, 0.5, 10, Everything());
    ASSERT_FALSE(found.empty()) << yaw;
    EXPECT_EQ(found[0].entry, library.place) << yaw;
    const Pose truth = SensorPose(0.0, 0.0, 0.0).inverse() * pose;
    EXPECT_LT((found[0].T_entry_query.translation() - truth.translation()).norm(), 0.5) << yaw;
    EXPECT_LT(RotationDistance(found[0].T_entry_query, truth), 0.06) << yaw;
  }
}

TEST(BtcDatabaseTest, PlanesOverlapAtTheRightPoseOnly) {
  Library library(4);
  const Pose pose = SensorPose(0.6, -0.4, 2.0);
  const BtcDescriptor query = library.Describe(library.town, pose);
  const PlaneIndex index(library.database.entry(library.place).planes, 0.5);
  const Pose truth = SensorPose(0.0, 0.0, 0.0).inverse() * pose;
  EXPECT_GT(index.Overlap(query.planes, truth, 0.25), 0.7);
  const Pose wrong = truth * MakePose(RotationFromRpy(0.0, 0.0, 0.8), {3.0, 0.0, 0.6});
  EXPECT_LT(index.Overlap(query.planes, wrong, 0.25), 0.2);
  EXPECT_EQ(index.Overlap({}, truth, 0.25), 0.0);
}

TEST(BtcDatabaseTest, TheFilterLeavesOutEntriesAndPoses) {
  Library library(4);
  const BtcDescriptor query = library.Describe(library.town, SensorPose(0.6, -0.4, 2.0));
  BtcDatabase::Filter others = Everything();
  others.entry = [&](std::size_t entry) { return entry != library.place; };
  for (const BtcCandidate& found : library.database.Query(query, 0.5, 10, others)) {
    EXPECT_NE(found.entry, library.place);
  }
  BtcDatabase::Filter turned = Everything();
  turned.pose = [](std::size_t, const Pose& pose) { return pose.linear()(0, 0) > 0.9; };
  for (const BtcCandidate& found : library.database.Query(query, 0.5, 10, turned)) {
    EXPECT_GT(found.T_entry_query.linear()(0, 0), 0.85);
  }
}

TEST(BtcDatabaseTest, AnEmptyDescriptorFindsNothing) {
  Library library(3);
  EXPECT_TRUE(library.database.Query(BtcDescriptor(), 0.5, 10, Everything()).empty());
  EXPECT_TRUE(
      BtcDatabase(BtcConfig()).Query(library.database.entry(0), 0.5, 10, Everything()).empty());
}

}  // namespace
}  // namespace hv::loop
