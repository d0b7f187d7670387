#include "hv_replay/loop_table.h"

#include <cstdio>

namespace hv::replay {

std::string LoopColumns() {
  return "query_stamp,match_stamp,query,match,x,y,z,qx,qy,qz,qw,votes,inliers,plane_overlap,"
         "fitness,overlap,seen_through,score,accepted,reason";
}

std::string LoopRow(const loop::LoopCandidate& loop) {
  const Eigen::Vector3d t = loop.T_match_query.translation();
  const Eigen::Quaterniond q(loop.T_match_query.linear());
  char numbers[400];
  std::snprintf(numbers, sizeof(numbers),
                ",%u,%u,%.6f,%.6f,%.6f,%.8f,%.8f,%.8f,%.8f,%d,%d,%.4f,%.4f,%.4f,%.4f,%.4f,%d,",
                loop.query, loop.match, t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w(), loop.votes,
                loop.inliers, loop.plane_overlap, loop.fitness, loop.overlap, loop.seen_through,
                loop.score(), loop.accepted ? 1 : 0);
  return ToString(loop.query_stamp) + "," + ToString(loop.match_stamp) + numbers + loop.reason;
}

}  // namespace hv::replay
