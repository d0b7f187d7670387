#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "hv_core/trajectory.h"

namespace hv::replay {

/// How the estimate is laid over the reference before errors are taken, always without scale.
enum class Alignment {
  kSe3,   ///< rotation and translation (Umeyama 1991); needs 3 matched poses
  kYaw,   ///< rotation about z and translation; needs 2 matched poses
  kNone,  ///< frames are taken to be the same
};

/// "se3", "yaw" or "none". Throws InputError otherwise.
Alignment ParseAlignment(const std::string& name);
std::string ToString(Alignment alignment);

struct TrajectoryErrorOptions {
  Alignment alignment = Alignment::kSe3;
  double max_gap_s = 0.5;                       ///< poses are not interpolated across longer gaps
  std::vector<double> rpe_lengths_m = {1, 10};  ///< path lengths of the relative error
};

struct Statistics {
  std::size_t count = 0;
  double max = 0.0;
  double mean = 0.0;
  double median = 0.0;
  double rmse = 0.0;
  double std = 0.0;  ///< about the mean, of the population
};

/// Statistics of magnitudes; all zero when `values` is empty.
Statistics Summarize(std::vector<double> values);

/// One instant at which both trajectories have a pose.
struct MatchedPose {
  Time stamp;
  Pose reference;
  Pose estimate;                   ///< after alignment
  double translation_error = 0.0;  ///< [m]
  double rotation_error = 0.0;     ///< [deg]
};

/// Drift over stretches of the reference of one path length.
struct RelativeError {
  double length_m = 0.0;
  Statistics translation;  ///< [m]
  Statistics rotation;     ///< [deg]
};

struct TrajectoryError {
  std::size_t reference_poses = 0;
  std::size_t estimate_poses = 0;
  double duration_s = 0.0;                       ///< from the first to the last matched pose
  double path_length_m = 0.0;                    ///< of the reference over the matched poses
  Pose T_reference_estimate = Pose::Identity();  ///< the alignment
  Statistics translation;                        ///< absolute pose error [m]
  Statistics horizontal;                         ///< its part in the x-y plane of the reference [m]
  Statistics vertical;                           ///< its part along z of the reference [m]
  Statistics rotation;                           ///< [deg]
  Eigen::Vector3d axis_rmse = Eigen::Vector3d::Zero();  ///< along x, y, z of the reference [m]
  std::vector<RelativeError> relative;
  std::vector<MatchedPose> matched;
};

/// Compares poses of the same frame by stamp: the denser trajectory is interpolated at the stamps
/// of the other (the reference, when they are about equally dense). Throws InputError when too few
/// poses match for the alignment, saying which times the two cover.
TrajectoryError CompareTrajectories(const Trajectory& reference, const Trajectory& estimate,
                                    const TrajectoryErrorOptions& options);

}  // namespace hv::replay
