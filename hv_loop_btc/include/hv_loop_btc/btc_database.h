#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "hv_core/se3.h"
#include "hv_loop_btc/btc_descriptor.h"

namespace hv::loop {

/// A stored descriptor that resembles the one asked for.
struct BtcCandidate {
  std::size_t entry = 0;                  ///< number of the stored descriptor
  int votes = 0;                          ///< triangles that agree
  int inliers = 0;                        ///< of these, with one common relative pose
  Pose T_entry_query = Pose::Identity();  ///< that pose, as good as the keypoints
};

/// All descriptors of a map with a hash table over the sides of their triangles (methods section 2,
/// step 4-6). Grows by one descriptor at a time. Const methods may run concurrently.
class BtcDatabase {
 public:
  explicit BtcDatabase(const BtcConfig& config);

  /// Returns the number of the entry.
  std::size_t Add(BtcDescriptor descriptor);

  /// What may be asked for: which entries, and which relative poses T_entry_query of them.
  struct Filter {
    std::function<bool(std::size_t)> entry;
    std::function<bool(std::size_t, const Pose&)> pose;
  };

  /// The entries that share most triangles with `query`, at most `limit` of them, each with its
  /// distinct relative poses that the filter lets pass; poses with most inliers first.
  std::vector<BtcCandidate> Query(const BtcDescriptor& query, double vertex_tolerance_m,
                                  std::size_t limit, const Filter& filter) const;

  std::size_t size() const { return entries_.size(); }
  const BtcDescriptor& entry(std::size_t number) const { return entries_[number]; }
  std::size_t MemoryBytes() const;

 private:
  using TriangleBits = std::array<std::uint64_t, 3>;

  /// A triangle in the chain of its bucket.
  struct Link {
    std::uint32_t entry;
    std::uint32_t next;
    std::uint16_t triangle;
    std::uint16_t tag;  ///< further bits of the hash, to skip others in the same bucket
    TriangleBits bits;  ///< of the vertices: a copy, since what is compared most must lie together
  };
  struct Match {
    std::uint32_t entry;
    std::uint16_t query_triangle;
    std::uint16_t entry_triangle;
  };

  Eigen::Vector3i BinOf(const Eigen::Vector3f& sides) const;
  void Grow();
  void Chain(std::uint32_t link, std::uint64_t hash);
  std::vector<std::vector<Match>> FindMatches(const BtcDescriptor& query,
                                              const std::vector<char>& wanted) const;
  void MatchTriangle(const BtcDescriptor& query, std::uint16_t triangle,
                     const std::vector<char>& wanted, std::vector<Match>& matches) const;
  bool Similar(const TriangleBits& query, const TriangleBits& stored) const;
  std::vector<BtcCandidate> Align(const BtcDescriptor& query, const std::vector<Match>& matches,
                                  double tolerance, const Filter& filter) const;

  BtcConfig config_;
  std::vector<BtcDescriptor> entries_;
  std::vector<std::uint32_t> buckets_;
  std::vector<Link> links_;
};

}  // namespace hv::loop
