#pragma once

#include <vector>

#include "site.h"

namespace hv::sim {

void AddMound(MeshBuilder& mesh, const Pose& at, Random& random);
void AddBigMound(MeshBuilder& mesh, const Pose& at, Random& random);
void AddBrickPallet(MeshBuilder& mesh, const Pose& at, Random& random);
void AddPipeStack(MeshBuilder& mesh, const Pose& at, Random& random);
void AddCableDrum(MeshBuilder& mesh, const Pose& at, Random& random);
void AddBarrel(MeshBuilder& mesh, const Pose& at, Random& random);
void AddTrafficCone(MeshBuilder& mesh, const Pose& at, Random& random);
void AddTrestle(MeshBuilder& mesh, const Pose& at, Random& random);
void AddPlankPile(MeshBuilder& mesh, const Pose& at, Random& random);
void AddLadder(MeshBuilder& mesh, const Pose& at, Random& random);
void AddContainer(MeshBuilder& mesh, const Pose& at, Random& random);
void AddMixer(MeshBuilder& mesh, const Pose& at, Random& random);

/// Tube scaffold with planks along the x axis of `at`, 1 m deep.
void AddScaffold(MeshBuilder& mesh, const Pose& at, double length, int levels);

/// Posts with rails, 1.1 m high.
void AddRailing(MeshBuilder& mesh, const std::vector<Eigen::Vector3d>& points);

/// What lies about on a building site.
std::vector<Prop> SiteProps();

}  // namespace hv::sim
