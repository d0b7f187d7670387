// The entry of libFuzzer. The environment variable HV_FUZZ_READER says which reader is tried; seeds
// of that reader are written to the folder in HV_FUZZ_SEEDS.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <iostream>

#include "hv_core/error.h"
#include "hv_core/file_io.h"
#include "readers.h"

namespace {

hv::fuzz::Reader chosen;

/// A configuration is told every problem at once, one on a line.
bool chosen_is_config = false;

/// What a message must not hold, whatever bytes it quotes.
bool IsStray(char c) { return c >= 0 && c < ' ' && !(c == '\n' && chosen_is_config); }

void PrintNames(const hv::fuzz::Readers& readers) {
  for (const auto& [name, reader] : readers) std::cout << name << "\n";
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* /*argc*/, char*** /*argv*/) {
  hv::fuzz::Readers readers = hv::fuzz::FileReaders();
  readers.merge(hv::fuzz::MessageReaders());
  const char* name = std::getenv("HV_FUZZ_READER");
  if (name == nullptr || readers.count(name) == 0) {
    PrintNames(readers);
    std::exit(name == nullptr ? 0 : 1);
  }
  chosen = readers[name];
  chosen_is_config = std::string(name) == "config";
  const auto seeds = hv::fuzz::Seeds();
  const auto seed = seeds.find(name);
  const char* folder = std::getenv("HV_FUZZ_SEEDS");
  if (folder != nullptr && seed != seeds.end()) {
    hv::WriteFile(std::string(folder) + "/seed", {seed->second});
  }
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    chosen(std::string(reinterpret_cast<const char*>(data), size));
  } catch (const hv::InputError& error) {
    const std::string text = error.what();
    if (std::any_of(text.begin(), text.end(), IsStray)) std::abort();
  }
  return 0;
}
