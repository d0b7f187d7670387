#pragma once

#include "site.h"

namespace hv::sim {

void AddTree(MeshBuilder& mesh, const Pose& at, Random& random);
void AddConifer(MeshBuilder& mesh, const Pose& at, Random& random);
void AddBush(MeshBuilder& mesh, const Pose& at, Random& random);
void AddStreetLamp(MeshBuilder& mesh, const Pose& at, Random& random);
void AddSign(MeshBuilder& mesh, const Pose& at, Random& random);
void AddBollard(MeshBuilder& mesh, const Pose& at, Random& random);
void AddBench(MeshBuilder& mesh, const Pose& at, Random& random);
void AddCar(MeshBuilder& mesh, const Pose& at, Random& random);
void AddBoulder(MeshBuilder& mesh, const Pose& at, Random& random);

/// A building of `floors` storeys whose ground-floor centre is `at`: recessed windows, slabs,
/// eaves, pipes and an entrance on its -y side.
void AddHouse(MeshBuilder& mesh, const Pose& at, double length, double depth, int floors,
              Random& random);

}  // namespace hv::sim
