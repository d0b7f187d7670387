#pragma once

#include <memory>

#include "hv_explore_sac/train/ranks.h"

/// The processes that mpirun started, or this one alone when there is no MPI or no mpirun. MPI ends
/// with the object's life; make it once.
std::unique_ptr<hv::explore::Ranks> MakeRanks(int* argc, char*** argv);
