#include "parameters.h"

#include "hv_ros/parameters.h"

namespace hv::sim {

void SimulationNodeConfig::Describe(ConfigVisitor& visitor) {
  simulation.Describe(visitor);
  visitor.Field("rate", rate, "simulated seconds per second; 0: as fast as possible");
  visitor.Field("threads", threads, "threads that cast rays");
  visitor.Field("publish_static_tf", publish_static_tf, "publish where the sensors sit");
  visitor.Field("publish_truth_tf", publish_truth_tf,
                "publish world -> base, while nobody else places the base");
  visitor.Field("world_frame", world_frame, "frame of the truth");
  visitor.Field("base_frame", base_frame, "frame of the robot, on the floor");
  visitor.Field("imu_frame", imu_frame, "frame of the IMU");
  visitor.Field("lidar_frame", lidar_frame, "frame of the LiDAR");
  visitor.Field("camera_frame", camera_frame, "frame of the camera, x along its view");
  visitor.Field("optical_frame", optical_frame, "frame of the depth images, z along the view");
}

void SimulationNodeConfig::Validate(ConfigProblems& problems) const {
  simulation.Validate(problems);
  problems.Require(rate >= 0.0 && rate <= 1000.0, "rate", "must be in [0, 1000]");
  problems.Require(threads >= 1, "threads", "must be at least 1");
}

SimulationNodeConfig ReadParameters(const ros::NodeHandle& private_nh) {
  const PrivateParameters source(private_nh);
  SimulationNodeConfig config;
  source.Read(config);
  return config;
}

}  // namespace hv::sim
