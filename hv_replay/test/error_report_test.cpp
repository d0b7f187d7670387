#include "hv_replay/error_report.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace hv::replay {
namespace {

TrajectoryError SmallError() {
  Trajectory reference, estimate;
  for (int i = 0; i < 30; ++i) {
    const Time stamp = Time::FromSeconds(100.0 + 0.1 * i);
    const Pose pose = MakePose(RotationFromRpy(0, 0, 0), Eigen::Vector3d(0.1 * i, 0, 0));
    reference.Append(stamp, pose);
    estimate.Append(stamp, MakePose(RotationFromRpy(0, 0, 0), Eigen::Vector3d(0, 0, 0.25)) * pose);
  }
  TrajectoryErrorOptions options;
  options.alignment = Alignment::kNone;
  return CompareTrajectories(reference, estimate, options);
}

TEST(ErrorTable, HoldsTheFiguresWithoutColourCodesInAPipe) {
  const std::string table = ErrorTable(SmallError(), Alignment::kNone, false);
  EXPECT_NE(table.find("matched 30 poses"), std::string::npos) << table;
  EXPECT_NE(table.find("APE [m]                 0.2500    0.2500    0.2500    0.2500    0.0000"),
            std::string::npos)
      << table;
  EXPECT_NE(table.find("RPE 10 m [m]          path too short"), std::string::npos) << table;
  EXPECT_EQ(table.find('\033'), std::string::npos);
  EXPECT_NE(ErrorTable(SmallError(), Alignment::kNone, true).find('\033'), std::string::npos);
}

TEST(ErrorJson, HoldsTheFigures) {
  const std::string json = ErrorJson(SmallError(), Alignment::kNone).ToString();
  EXPECT_NE(json.find("\"alignment\": \"none\", \"matched\": 30"), std::string::npos) << json;
  EXPECT_NE(json.find("\"vertical_m\": {\"count\": 30, \"max\": 0.25"), std::string::npos) << json;
}

TEST(Json, EscapesTextAndNullsWhatIsNotFinite) {
  JsonObject json;
  json.Add("a\"b", "line\nback\\slash").Add("x", std::nan("")).Add("y", 0.1).Add("z", true);
  json.Add("list", std::vector<double>{1.0, std::numeric_limits<double>::infinity()});
  json.Add("names", std::vector<std::string>{"p", "q"}).Add("empty", JsonObject());
  EXPECT_EQ(json.ToString(),
            "{\"a\\\"b\": \"line\\u000aback\\\\slash\", \"x\": null, \"y\": 0.1, \"z\": true, "
            "\"list\": [1, null], \"names\": [\"p\", \"q\"], \"empty\": {}}");
}

}  // namespace
}  // namespace hv::replay
