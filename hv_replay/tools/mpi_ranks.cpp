#include "mpi_ranks.h"

#ifdef HV_HAVE_MPI
#include <cstdlib>

#include <mpi.h>

namespace {

/// Alone, MPI would start a helper of its own. What mpirun of Open MPI and of others leaves behind.
bool StartedByMpirun() {
  return std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr || std::getenv("PMI_SIZE") != nullptr;
}

class MpiRanks : public hv::explore::Ranks {
 public:
  MpiRanks(int* argc, char*** argv) {
    MPI_Init(argc, argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
  }
  ~MpiRanks() override { MPI_Finalize(); }
  MpiRanks(const MpiRanks&) = delete;
  MpiRanks& operator=(const MpiRanks&) = delete;

  int rank() const override { return rank_; }
  int size() const override { return size_; }
  /// Summed on one rank and sent to all, so that all get the same bits.
  void Sum(float* numbers, std::size_t count) override {
    const int length = static_cast<int>(count);
    MPI_Reduce(rank_ == 0 ? MPI_IN_PLACE : numbers, numbers, length, MPI_FLOAT, MPI_SUM, 0,
               MPI_COMM_WORLD);
    MPI_Bcast(numbers, length, MPI_FLOAT, 0, MPI_COMM_WORLD);
  }

 private:
  int rank_ = 0;
  int size_ = 1;
};

}  // namespace

std::unique_ptr<hv::explore::Ranks> MakeRanks(int* argc, char*** argv) {
  if (!StartedByMpirun()) return std::make_unique<hv::explore::Ranks>();
  return std::make_unique<MpiRanks>(argc, argv);
}
#else
std::unique_ptr<hv::explore::Ranks> MakeRanks(int* argc, char*** argv) {
  static_cast<void>(argc);
  static_cast<void>(argv);
  return std::make_unique<hv::explore::Ranks>();
}
#endif
