#include "keyframe_numbering.h"

#include <gtest/gtest.h>

namespace hv::loop {
namespace {

using Verdict = KeyframeNumbering::Verdict;

Keyframe Numbered(std::uint32_t id, std::uint32_t segment, double stamp) {
  Keyframe keyframe;
  keyframe.id = id;
  keyframe.segment = segment;
  keyframe.stamp = Time::FromSeconds(stamp);
  return keyframe;
}

TEST(KeyframeNumbering, GoesOnFromAContinuedMap) {
  KeyframeNumbering numbering({100, 2});
  Keyframe keyframe = Numbered(0, 0, 1.0);
  EXPECT_EQ(numbering.Renumber(keyframe), Verdict::kNext);
  EXPECT_EQ(keyframe.id, 100U);
  EXPECT_EQ(keyframe.segment, 2U);
  keyframe = Numbered(1, 1, 2.0);
  numbering.Renumber(keyframe);
  EXPECT_EQ(keyframe.id, 101U);
  EXPECT_EQ(keyframe.segment, 3U);
}

TEST(KeyframeNumbering, CountsKeyframesThatNeverCame) {
  KeyframeNumbering numbering({});
  for (const std::uint32_t id : {3U, 4U, 7U}) {
    Keyframe keyframe = Numbered(id, 0, id);
    EXPECT_EQ(numbering.Renumber(keyframe), Verdict::kNext);
  }
  EXPECT_EQ(numbering.missing(), 2U);
}

TEST(KeyframeNumbering, AnOdometryThatStartsAnewIsASessionOfItsOwn) {
  KeyframeNumbering numbering({});
  Keyframe keyframe = Numbered(5, 1, 10.0);
  numbering.Renumber(keyframe);
  keyframe = Numbered(0, 0, 20.0);
  EXPECT_EQ(numbering.Renumber(keyframe), Verdict::kRestarted);
  EXPECT_EQ(keyframe.id, 6U);
  EXPECT_EQ(keyframe.segment, 2U);
  keyframe = Numbered(1, 0, 21.0);
  EXPECT_EQ(numbering.Renumber(keyframe), Verdict::kNext);
  EXPECT_EQ(keyframe.id, 7U);
}

TEST(KeyframeNumbering, TheSameKeyframeAgainIsNoRestart) {
  KeyframeNumbering numbering({});
  Keyframe keyframe = Numbered(5, 1, 10.0);
  numbering.Renumber(keyframe);
  EXPECT_EQ(numbering.Renumber(keyframe), Verdict::kRepeated);
}

}  // namespace
}  // namespace hv::loop
