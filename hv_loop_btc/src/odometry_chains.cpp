#include "odometry_chains.h"

namespace hv::loop {

OdometryChains::OdometryChains(std::size_t vertices, const std::vector<Measurement>& odometry)
    : nodes_(vertices) {
  std::vector<const Measurement*> edge_to(vertices, nullptr);
  for (const Measurement& edge : odometry) edge_to[edge.to] = &edge;
  for (std::size_t i = 0; i < vertices; ++i) {
    nodes_[i].first = i;
    if (edge_to[i] == nullptr) continue;
    const Node& before = nodes_[edge_to[i]->from];
    nodes_[i].first = before.first;
    nodes_[i].T_first_vertex = before.T_first_vertex * edge_to[i]->T_from_to;
    const Matrix6d adjoint = se3::Adjoint(nodes_[i].T_first_vertex);
    nodes_[i].covariance =
        before.covariance + adjoint * InverseOf(edge_to[i]->information) * adjoint.transpose();
  }
}

UncertainPose OdometryChains::Between(std::size_t a, std::size_t b) const {
  const Pose T_b_first = nodes_[b].T_first_vertex.inverse();
  const Matrix6d adjoint = se3::Adjoint(T_b_first);
  const double sign = a < b ? 1.0 : -1.0;
  const Matrix6d between = sign * (nodes_[b].covariance - nodes_[a].covariance);
  return {(T_b_first * nodes_[a].T_first_vertex).inverse(),
          adjoint * between * adjoint.transpose()};
}

}  // namespace hv::loop
