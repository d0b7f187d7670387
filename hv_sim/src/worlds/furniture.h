#pragma once

#include <vector>

#include "site.h"

namespace hv::sim {

void AddDesk(MeshBuilder& mesh, const Pose& at, Random& random);
void AddTable(MeshBuilder& mesh, const Pose& at, Random& random);
void AddChair(MeshBuilder& mesh, const Pose& at, Random& random);
void AddShelf(MeshBuilder& mesh, const Pose& at, Random& random);
void AddCabinet(MeshBuilder& mesh, const Pose& at, Random& random);
void AddPlant(MeshBuilder& mesh, const Pose& at, Random& random);
void AddBin(MeshBuilder& mesh, const Pose& at, Random& random);
void AddCarton(MeshBuilder& mesh, const Pose& at, Random& random);
void AddCartonStack(MeshBuilder& mesh, const Pose& at, Random& random);
void AddCoatStand(MeshBuilder& mesh, const Pose& at, Random& random);
void AddRadiator(MeshBuilder& mesh, const Pose& at, Random& random);
void AddExtinguisher(MeshBuilder& mesh, const Pose& at, Random& random);

/// What stands along the walls of an office, and what stands anywhere in it.
std::vector<Prop> WallFurniture();
std::vector<Prop> LooseFurniture();

/// Shallow things along the walls of a corridor.
std::vector<Prop> CorridorFurniture();

}  // namespace hv::sim
