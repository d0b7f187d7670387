#include "hv_replay/parameter_page.h"

#include "hv_core/config.h"
#include "hv_explore_sac/train/train_config.h"
#include "hv_replay/slam_config.h"

namespace hv::replay {
namespace {

constexpr const char* kIntroduction =
    R"(# Parameters

Every key of a configuration file, as printed by `hv_parameters`; those of a
[training](#training) come last. A file names only what differs from the defaults:

```yaml
input:
  points_topic: /points_raw
points:
  max_range_m: 80.0
odometry:
  extrinsic:
    translation_m: [0.0, 0.0, 0.1]
```

An unknown key is an error that names the nearest known one. As ROS parameters of `hv_lio_node` the
same keys are written with slashes, for example `~odometry/map/voxel_size_m`; they override the file
named by `~config_file`. The effective configuration is saved as `config.yaml` beside the results of
`hv_slam` and printed by the node at its start.

)";

constexpr const char* kTraining = R"(
## Training

`hv_explore_train` reads a file of its own, such as `config/training/exploration.yaml`; the sections
`exploration`, `planner` and `guard` are those of `hv_explore_eval --config` too.

)";

}  // namespace

std::string ParameterPage() {
  return kIntroduction + ParameterTable<SlamConfig>() + kTraining +
         ParameterTable<explore::TrainConfig>();
}

}  // namespace hv::replay
