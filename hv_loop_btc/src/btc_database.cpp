#include "hv_loop_btc/btc_database.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace hv::loop {
namespace {

constexpr std::uint32_t kEnd = 0xFFFFFFFFU;
constexpr std::size_t kFirstBuckets = 1U << 14U;
/// Hypotheses tried of one candidate, spread evenly over its matches.
constexpr std::size_t kHypotheses = 200;
/// Entries that are asked for with all triangles; for more, one in several does, down to one in
/// `kMostThinned`.
constexpr std::size_t kAskedWithAll = 130;
constexpr std::size_t kMostThinned = 4;
/// Triangles that a hypothesis is tried on first, and hypotheses that are then tried on all.
constexpr std::size_t kTrial = 60;
constexpr std::size_t kTriedOnAll = 20;
/// Relative poses of one entry that are followed up, and what tells them apart.
constexpr std::size_t kPosesPerEntry = 3;
constexpr double kDistinctRotation = 0.35;
constexpr double kDistinctTolerances = 3.0;
/// Fewest triangles that make a candidate, and fewest that agree on a pose.
constexpr std::uint32_t kFewestVotes = 3;
constexpr int kFewestInliers = 2;

std::uint64_t HashOf(const Eigen::Vector3i& bin) {
  const auto part = [](int value) { return static_cast<std::uint64_t>(value) & 0x1FFFFFU; };
  std::uint64_t hash = (part(bin.x()) << 42U) | (part(bin.y()) << 21U) | part(bin.z());
  hash ^= hash >> 31U;
  hash *= 0x9E3779B97F4A7C15ULL;
  return hash ^ (hash >> 29U);
}

std::uint16_t TagOf(std::uint64_t hash) { return static_cast<std::uint16_t>(hash >> 48U); }

using Triangle3d = Eigen::Matrix3d;  ///< a vertex a column

Triangle3d Corners(const BtcDescriptor& descriptor, std::size_t triangle) {
  Triangle3d corners;
  for (int k = 0; k < 3; ++k) {
    const std::uint16_t vertex =
        descriptor.triangles[triangle].vertices[static_cast<std::size_t>(k)];
    corners.col(k) = descriptor.keypoints[vertex].position.cast<double>();
  }
  return corners;
}

/// Rigid motion that carries the columns of `from` to those of `to`, least squares.
template <typename Points>
Pose Carry(const Points& from, const Points& to) {
  Pose pose = Pose::Identity();
  pose.matrix() = Eigen::umeyama(from, to, false);
  return pose;
}

/// Axes along the longest side, which lies between the first two vertices, and across the triangle.
Eigen::Matrix3d AxesOf(const Triangle3d& corners) {
  const Eigen::Vector3d side = (corners.col(1) - corners.col(0)).normalized();
  const Eigen::Vector3d normal = side.cross(corners.col(2) - corners.col(0)).normalized();
  Eigen::Matrix3d axes;
  axes << side, normal.cross(side), normal;
  return axes;
}

/// Rigid motion that carries one triangle to another that is nearly congruent: as good as least
/// squares for a first guess, at a tenth of its time.
Pose CarryTriangle(const Triangle3d& from, const Triangle3d& to) {
  const Eigen::Matrix3d rotation = AxesOf(to) * AxesOf(from).transpose();
  return MakePose(rotation, to.rowwise().mean() - rotation * from.rowwise().mean());
}

bool Agrees(const Pose& pose, const Triangle3d& from, const Triangle3d& to, double tolerance) {
  return ((pose * from) - to).colwise().squaredNorm().maxCoeff() < tolerance * tolerance;
}

/// The poses with most inliers that differ from each other.
std::vector<BtcCandidate> DistinctPoses(std::vector<BtcCandidate> hypotheses, double tolerance) {
  std::stable_sort(
      hypotheses.begin(), hypotheses.end(),
      [](const BtcCandidate& a, const BtcCandidate& b) { return a.inliers > b.inliers; });
  std::vector<BtcCandidate> distinct;
  for (const BtcCandidate& hypothesis : hypotheses) {
    const bool known = std::any_of(distinct.begin(), distinct.end(), [&](const BtcCandidate& d) {
      const Pose difference = d.T_entry_query.inverse() * hypothesis.T_entry_query;
      return difference.translation().norm() < kDistinctTolerances * tolerance &&
             RotationDistance(d.T_entry_query, hypothesis.T_entry_query) < kDistinctRotation;
    });
    if (!known) distinct.push_back(hypothesis);
    if (distinct.size() == kPosesPerEntry) break;
  }
  return distinct;
}

std::array<std::uint64_t, 3> BitsOf(const BtcDescriptor& descriptor, const BtcTriangle& triangle) {
  return {descriptor.keypoints[triangle.vertices[0]].bits,
          descriptor.keypoints[triangle.vertices[1]].bits,
          descriptor.keypoints[triangle.vertices[2]].bits};
}

/// Counts the inliers of the hypotheses on every `step`-th triangle and sorts by them.
void Rank(const std::vector<Triangle3d>& from, const std::vector<Triangle3d>& to, double tolerance,
          std::size_t step, std::vector<BtcCandidate>& hypotheses) {
  for (BtcCandidate& hypothesis : hypotheses) {
    hypothesis.inliers = 0;
    for (std::size_t j = 0; j < from.size(); j += step) {
      hypothesis.inliers += Agrees(hypothesis.T_entry_query, from[j], to[j], tolerance) ? 1 : 0;
    }
  }
  std::stable_sort(
      hypotheses.begin(), hypotheses.end(),
      [](const BtcCandidate& a, const BtcCandidate& b) { return a.inliers > b.inliers; });
}

/// The hypotheses that most triangles agree with, those that some agree with at all.
std::vector<BtcCandidate> MostAgreed(const std::vector<Triangle3d>& from,
                                     const std::vector<Triangle3d>& to, double tolerance,
                                     std::vector<BtcCandidate> hypotheses) {
  const std::size_t step = std::max<std::size_t>(1, from.size() / kTrial);
  if (step > 1 && hypotheses.size() > kTriedOnAll) {
    Rank(from, to, tolerance, step, hypotheses);
    hypotheses.resize(kTriedOnAll);
  }
  Rank(from, to, tolerance, 1, hypotheses);
  const auto few = std::find_if(hypotheses.begin(), hypotheses.end(), [](const BtcCandidate& one) {
    return one.inliers < kFewestInliers;
  });
  hypotheses.erase(few, hypotheses.end());
  return hypotheses;
}

/// Fits the pose to all vertices that agree with it.
void Refine(const std::vector<Triangle3d>& from, const std::vector<Triangle3d>& to,
            double tolerance, BtcCandidate& candidate) {
  Eigen::Matrix3Xd inlier_from(3, 3 * candidate.inliers);
  Eigen::Matrix3Xd inlier_to(3, 3 * candidate.inliers);
  int column = 0;
  for (std::size_t j = 0; j < from.size(); ++j) {
    if (!Agrees(candidate.T_entry_query, from[j], to[j], tolerance)) continue;
    inlier_from.middleCols<3>(column) = from[j];
    inlier_to.middleCols<3>(column) = to[j];
    column += 3;
  }
  candidate.T_entry_query = Carry(inlier_from, inlier_to);
}

}  // namespace

BtcDatabase::BtcDatabase(const BtcConfig& config)
    : config_(config), buckets_(kFirstBuckets, kEnd) {}

Eigen::Vector3i BtcDatabase::BinOf(const Eigen::Vector3f& sides) const {
  const float inverse = static_cast<float>(1.0 / config_.side_bin_m);
  return (sides * inverse).array().floor().cast<int>();
}

void BtcDatabase::Chain(std::uint32_t link, std::uint64_t hash) {
  std::uint32_t& head = buckets_[hash & (buckets_.size() - 1)];
  links_[link].next = head;
  links_[link].tag = TagOf(hash);
  head = link;
}

void BtcDatabase::Grow() {
  buckets_.assign(2 * buckets_.size(), kEnd);
  for (std::uint32_t i = 0; i < links_.size(); ++i) {
    const BtcDescriptor& entry = entries_[links_[i].entry];
    Chain(i, HashOf(BinOf(entry.Sides(entry.triangles[links_[i].triangle]))));
  }
}

std::size_t BtcDatabase::Add(BtcDescriptor descriptor) {
  const std::size_t number = entries_.size();
  entries_.push_back(std::move(descriptor));
  const BtcDescriptor& entry = entries_.back();
  for (std::size_t i = 0; i < entry.triangles.size(); ++i) {
    links_.push_back({static_cast<std::uint32_t>(number), kEnd, static_cast<std::uint16_t>(i), 0,
                      BitsOf(entry, entry.triangles[i])});
    Chain(static_cast<std::uint32_t>(links_.size() - 1),
          HashOf(BinOf(entry.Sides(entry.triangles[i]))));
  }
  while (links_.size() > buckets_.size()) Grow();
  return number;
}

bool BtcDatabase::Similar(const TriangleBits& query, const TriangleBits& stored) const {
  double similarity = 0.0;
  for (std::size_t k = 0; k < 3; ++k) similarity += BitSimilarity(query[k], stored[k]);
  return similarity > 3.0 * config_.min_similarity;
}

void BtcDatabase::MatchTriangle(const BtcDescriptor& query, std::uint16_t number,
                                const std::vector<char>& wanted,
                                std::vector<Match>& matches) const {
  const BtcTriangle& triangle = query.triangles[number];
  const Eigen::Vector3i bin = BinOf(query.Sides(triangle));
  const TriangleBits bits = BitsOf(query, triangle);
  for (int neighbor = 0; neighbor < 27; ++neighbor) {
    const Eigen::Vector3i step(neighbor % 3 - 1, neighbor / 3 % 3 - 1, neighbor / 9 - 1);
    const std::uint64_t hash = HashOf(bin + step);
    const std::uint16_t tag = TagOf(hash);
    for (std::uint32_t at = buckets_[hash & (buckets_.size() - 1)]; at != kEnd;
         at = links_[at].next) {
      const Link& link = links_[at];
      if (link.tag != tag || wanted[link.entry] == 0) continue;
      if (!Similar(bits, link.bits)) continue;
      matches.push_back({link.entry, number, link.triangle});
    }
  }
}

std::vector<std::vector<BtcDatabase::Match>> BtcDatabase::FindMatches(
    const BtcDescriptor& query, const std::vector<char>& wanted) const {
  const auto asked = static_cast<std::size_t>(std::count(wanted.begin(), wanted.end(), 1));
  const std::size_t step = std::clamp<std::size_t>(asked / kAskedWithAll, 1, kMostThinned);
  std::vector<Match> matches;
  for (std::size_t i = 0; i < query.triangles.size(); i += step) {
    MatchTriangle(query, static_cast<std::uint16_t>(i), wanted, matches);
  }
  std::vector<std::vector<Match>> by_entry(entries_.size());
  for (const Match& match : matches) by_entry[match.entry].push_back(match);
  return by_entry;
}

std::vector<BtcCandidate> BtcDatabase::Query(const BtcDescriptor& query, double vertex_tolerance_m,
                                             std::size_t limit, const Filter& filter) const {
  std::vector<char> wanted(entries_.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) wanted[i] = filter.entry(i) ? 1 : 0;
  const std::vector<std::vector<Match>> by_entry = FindMatches(query, wanted);
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < by_entry.size(); ++i) {
    if (by_entry[i].size() >= kFewestVotes) order.push_back(i);
  }
  const std::size_t kept = std::min(limit, order.size());
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(kept), order.end(),
                    [&](std::size_t a, std::size_t b) {
                      const std::size_t more = by_entry[a].size();
                      const std::size_t less = by_entry[b].size();
                      return more != less ? more > less : a < b;
                    });
  std::vector<BtcCandidate> candidates;
  for (std::size_t i = 0; i < kept; ++i) {
    const auto poses = Align(query, by_entry[order[i]], vertex_tolerance_m, filter);
    candidates.insert(candidates.end(), poses.begin(), poses.end());
  }
  std::stable_sort(
      candidates.begin(), candidates.end(),
      [](const BtcCandidate& a, const BtcCandidate& b) { return a.inliers > b.inliers; });
  return candidates;
}

std::vector<BtcCandidate> BtcDatabase::Align(const BtcDescriptor& query,
                                             const std::vector<Match>& matches, double tolerance,
                                             const Filter& filter) const {
  const std::size_t entry = matches.front().entry;
  std::vector<Triangle3d> from;
  std::vector<Triangle3d> to;
  for (const Match& match : matches) {
    from.push_back(Corners(query, match.query_triangle));
    to.push_back(Corners(entries_[entry], match.entry_triangle));
  }
  std::vector<BtcCandidate> hypotheses;
  const std::size_t step = std::max<std::size_t>(1, from.size() / kHypotheses);
  for (std::size_t i = 0; i < from.size(); i += step) {
    BtcCandidate hypothesis;
    hypothesis.entry = entry;
    hypothesis.votes = static_cast<int>(matches.size());
    hypothesis.T_entry_query = CarryTriangle(from[i], to[i]);
    if (filter.pose(entry, hypothesis.T_entry_query)) hypotheses.push_back(hypothesis);
  }
  std::vector<BtcCandidate> best =
      DistinctPoses(MostAgreed(from, to, tolerance, std::move(hypotheses)), tolerance);
  for (BtcCandidate& candidate : best) Refine(from, to, tolerance, candidate);
  return best;
}

std::size_t BtcDatabase::MemoryBytes() const {
  std::size_t bytes =
      buckets_.capacity() * sizeof(std::uint32_t) + links_.capacity() * sizeof(Link);
  for (const BtcDescriptor& entry : entries_) bytes += entry.MemoryBytes();
  return bytes;
}

}  // namespace hv::loop
