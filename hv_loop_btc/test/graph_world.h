#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "hv_core/pose_graph_data.h"
#include "hv_core/se3.h"
#include "hv_core/so3.h"

namespace hv::loop {

/// Standard deviations of the edges of a made-up graph.
struct WorldNoise {
  double odometry_translation = 0.01;  // [m] a keyframe
  double odometry_rotation = 3e-4;     // [rad] a keyframe
  double loop_translation = 0.05;      // [m]
  double loop_rotation = 0.005;        // [rad]
  double yaw_bias = 0.0;               // [rad] a keyframe, which the edges do not know of
  double scale_bias = 0.0;             // relative, likewise
};

inline Matrix6d DiagonalInformation(double translation_sigma, double rotation_sigma) {
  Vector6d sigmas;
  sigmas << Eigen::Vector3d::Constant(translation_sigma), Eigen::Vector3d::Constant(rotation_sigma);
  return sigmas.cwiseAbs2().cwiseInverse().asDiagonal();
}

/// True poses, measured edges, and ways to add loops, true and false. Seeded.
class GraphWorld {
 public:
  GraphWorld(std::vector<Pose> truth, const WorldNoise& noise, unsigned seed)
      : truth_(std::move(truth)), noise_(noise), random_(seed) {
    for (std::size_t i = 1; i < truth_.size(); ++i) AddOdometry(i);
  }

  const std::vector<Pose>& truth() const { return truth_; }
  const std::vector<GraphEdge>& odometry() const { return odometry_; }

  GraphEdge TrueLoop(std::size_t i, std::size_t j) { return Loop(i, j, Pose::Identity()); }

  /// A loop as it would be if the surroundings of j were moved by T_map_wrong in the map: loops
  /// with the same T_map_wrong agree with each other.
  GraphEdge Loop(std::size_t i, std::size_t j, const Pose& T_map_wrong) {
    GraphEdge edge = Edge(EdgeKind::kLoop, i, j, noise_.loop_translation, noise_.loop_rotation);
    edge.T_from_to = truth_[i].inverse() * T_map_wrong * truth_[j] *
                     Noise(noise_.loop_translation, noise_.loop_rotation);
    return edge;
  }

  /// About `count` true loops, evenly over all revisits closer than `radius` [m].
  std::vector<GraphEdge> TrueLoops(std::size_t count, double radius = 4.0) {
    const std::vector<std::pair<std::size_t, std::size_t>> revisits = Revisits(radius);
    std::vector<GraphEdge> loops;
    const std::size_t available = std::min(count, revisits.size());
    for (std::size_t k = 0; k < available; ++k) {
      const auto [i, j] = revisits[k * revisits.size() / available];
      loops.push_back(TrueLoop(i, j));
    }
    return loops;
  }

  /// Loops between unrelated places, each claiming that they are less than 3 m apart.
  std::vector<GraphEdge> RandomFalseLoops(std::size_t count) {
    std::vector<GraphEdge> loops;
    while (loops.size() < count) {
      const std::size_t i = Index();
      const std::size_t j = Index();
      if (i + 50 > j || Distance(i, j) < 15.0) continue;
      loops.push_back(TrueLoop(i, j));
      loops.back().T_from_to = RandomNearPose();
    }
    return loops;
  }

  /// `count` loops of neighbouring keyframes that agree on one wrong place: a revisit shifted by
  /// `shift` [m] along the way, as in a corridor that looks the same all along.
  std::vector<GraphEdge> ShiftedGroup(std::size_t count, double shift) {
    const std::vector<std::pair<std::size_t, std::size_t>> revisits = Revisits(4.0);
    std::vector<GraphEdge> loops;
    while (loops.size() < count) {
      const auto [i, j] = revisits[random_() % revisits.size()];
      if (j + count >= truth_.size()) continue;
      const Eigen::Vector3d along = shift * truth_[j].linear().col(0);
      const Pose T_map_wrong = MakePose(Eigen::Matrix3d::Identity(), along);
      for (std::size_t k = 0; k < count; ++k) loops.push_back(Loop(i + k, j + k, T_map_wrong));
    }
    return loops;
  }

  /// As ShiftedGroup, but between unrelated places.
  std::vector<GraphEdge> AliasedGroup(std::size_t count) {
    while (true) {
      const std::size_t i = Index();
      const std::size_t j = Index();
      if (i + 50 > j || j + count >= truth_.size() || Distance(i, j) < 15.0) continue;
      const Pose T_map_wrong = truth_[i] * RandomNearPose() * truth_[j].inverse();
      std::vector<GraphEdge> loops;
      for (std::size_t k = 0; k < count; ++k) loops.push_back(Loop(i + k, j + k, T_map_wrong));
      return loops;
    }
  }

  /// Root mean square distance [m] of positions to the truth; the first pose is that of the truth.
  double RmsError(const std::vector<GraphVertex>& vertices) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const Eigen::Vector3d& position = vertices[i].T_map_imu.translation();
      sum += (position - truth_[i].translation()).squaredNorm();
    }
    return std::sqrt(sum / static_cast<double>(vertices.size()));
  }

  /// Pairs i < j of keyframes closer than `radius` [m] that are at least 50 keyframes apart.
  std::vector<std::pair<std::size_t, std::size_t>> Revisits(double radius) const {
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
    for (std::size_t j = 50; j < truth_.size(); ++j) {
      std::size_t nearest = 0;
      for (std::size_t i = 1; i + 50 <= j; ++i) {
        if (Distance(i, j) < Distance(nearest, j)) nearest = i;
      }
      if (Distance(nearest, j) < radius) pairs.emplace_back(nearest, j);
    }
    return pairs;
  }

 private:
  GraphEdge Edge(EdgeKind kind, std::size_t i, std::size_t j, double translation_sigma,
                 double rotation_sigma) const {
    GraphEdge edge;
    edge.kind = kind;
    edge.from = static_cast<std::uint32_t>(i);
    edge.to = static_cast<std::uint32_t>(j);
    edge.information = DiagonalInformation(translation_sigma, rotation_sigma);
    return edge;
  }

  void AddOdometry(std::size_t i) {
    Vector6d bias = Vector6d::Zero();
    const Pose step = truth_[i - 1].inverse() * truth_[i];
    bias.head<3>() = noise_.scale_bias * step.translation();
    bias[5] = noise_.yaw_bias;
    odometry_.push_back(
        Edge(EdgeKind::kOdometry, i - 1, i, noise_.odometry_translation, noise_.odometry_rotation));
    odometry_.back().T_from_to =
        step * Noise(noise_.odometry_translation, noise_.odometry_rotation) * se3::Exp(bias);
  }

  Pose Noise(double translation_sigma, double rotation_sigma) {
    std::normal_distribution<double> normal;
    Vector6d xi;
    for (int k = 0; k < 6; ++k) xi[k] = normal(random_);
    xi.head<3>() *= translation_sigma;
    xi.tail<3>() *= rotation_sigma;
    return se3::Exp(xi);
  }

  Pose RandomNearPose() {
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    const Eigen::Vector3d position(3.0 * unit(random_), 3.0 * unit(random_), 0.2 * unit(random_));
    return MakePose(
        RotationFromRpy(0.02 * unit(random_), 0.02 * unit(random_), 3.1 * unit(random_)), position);
  }

  std::size_t Index() { return random_() % truth_.size(); }

  double Distance(std::size_t i, std::size_t j) const {
    return (truth_[i].translation() - truth_[j].translation()).norm();
  }

  std::vector<Pose> truth_;
  WorldNoise noise_;
  std::mt19937 random_;
  std::vector<GraphEdge> odometry_;
};

/// A drive of `count` keyframes, 1 m apart, through a grid of streets with blocks of `block`
/// metres and `blocks` of them a side, over gentle hills. Streets are driven again and again.
inline std::vector<Pose> CityDrive(std::size_t count, int block, int blocks, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<Pose> truth;
  Eigen::Vector2i cell(blocks / 2, blocks / 2);
  Eigen::Vector2i heading(1, 0);
  double yaw = 0.0;
  while (truth.size() < count) {
    for (int k = 0; k < block && truth.size() < count; ++k) {
      const Eigen::Vector2d flat = (block * cell + k * heading).cast<double>();
      const double height = 3.0 * std::sin(flat.x() / 40.0) + 2.0 * std::cos(flat.y() / 30.0);
      const double wanted = std::atan2(heading.y(), heading.x());
      yaw += std::clamp(std::remainder(wanted - yaw, 2.0 * M_PI), -0.3, 0.3);
      truth.push_back(MakePose(RotationFromRpy(0.01, -0.05 * std::cos(flat.x() / 40.0), yaw),
                               {flat.x(), flat.y(), height}));
    }
    cell += heading;
    const Eigen::Vector2i left(-heading.y(), heading.x());
    std::vector<Eigen::Vector2i> choices;
    for (const Eigen::Vector2i& next : {heading, heading, left, Eigen::Vector2i(-left)}) {
      const Eigen::Vector2i target = cell + next;
      if (target.minCoeff() >= 0 && target.maxCoeff() <= blocks) choices.push_back(next);
    }
    heading = choices[random() % choices.size()];
  }
  return truth;
}

}  // namespace hv::loop
